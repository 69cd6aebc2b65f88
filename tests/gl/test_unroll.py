"""Unrolled loops: the same numbers as the loops themselves, and refusals that name the line."""

import numpy as np
import pytest

import aolab
from aolab import ShaderError
from aolab.gl import unroll
from aolab.gl.source import assemble


@pytest.fixture(autouse=True)
def on(monkeypatch):
    """The default, which tests/conftest.py switches off."""
    monkeypatch.delenv(unroll.VARIABLE, raising=False)


def text(loop: str, **constants) -> str:
    return assemble(f"const int count;\n{loop}\n", {"count": 3, **constants}).text


def test_each_turn_is_a_copy_with_its_index():
    made = text("#pragma unroll\nfor (int i = 0; i < count; ++i) {\n    f(i);\n}")
    assert [line for line in made.splitlines() if line.startswith("{")] == [f"{{ const int i = {i};" for i in range(3)]
    assert made.count("f(i);") == 3
    assert "for" not in made


def test_bounds_are_numbers_or_constants_of_the_shader():
    made = text("const int REACH = 2;\n#pragma unroll\nfor (int k = -REACH; k <= REACH; ++k) {\n    f(k);\n}")
    assert [int(line.split("= ")[1][:-1]) for line in made.splitlines() if line.startswith("{")] == [-2, -1, 0, 1, 2]


def test_loops_within_loops():
    inner = "#pragma unroll\nfor (int j = 0; j < 2; ++j) {\n    f(i, j);\n}"
    made = text(f"#pragma unroll\nfor (int i = 0; i < count; ++i) {{\n    if (a) {{\n        g();\n    }}\n{inner}\n}}")
    assert made.count("f(i, j);") == 6
    assert made.count("g();") == 3


def test_a_long_loop_stays_a_loop():
    made = text("#pragma unroll\nfor (int i = 0; i < count; ++i) {\n    f(i);\n}", count=unroll.MOST_COPIES + 1)
    assert "for (int i = 0; i < count; ++i) {" in made


@pytest.mark.parametrize(("steps", "copies"), [(unroll.MOST_TAPS // 16, 16), (unroll.MOST_TAPS // 16 + 1, 0)])
def test_a_loop_over_directions_stays_a_loop_if_its_directions_have_many_steps(steps, copies):
    loop = "#pragma unroll\nfor (int i = 0; i < directions; ++i) {\n    f(i);\n}"
    made = assemble(f"const int directions;\nconst int steps;\n{loop}\n", {"directions": 16, "steps": steps}).text
    assert made.count("{ const int i = ") == copies


def test_many_taps_compile():
    """Unrolled, 256 taps took Mesa minutes."""
    frame = aolab.render("boxes", "ssao", size=(16, 9), directions=16, steps=16)
    assert np.isfinite(frame["visibility"][frame.mask]).all()


def test_a_pragma_switches_it_off():
    loop = "#pragma unroll\nfor (int i = 0; i < count; ++i) {\n    f(i);\n}"
    assert "for" in text(f"#pragma unroll off  // too long\n{loop}")


def test_lines_keep_their_places():
    source = assemble(
        "const int count;\n#pragma unroll\nfor (int i = 0; i < count; ++i) {\n    f(i);\n}\n", {"count": 3}
    )
    places = dict(zip(source.text.splitlines(), source.lines, strict=True))
    assert places["    f(i);"] == ("<inline>", 4)
    assert places["{ const int i = 2;"] == ("<inline>", 3)


def test_a_limit_that_is_no_number_is_refused(monkeypatch):
    monkeypatch.setenv(unroll.VARIABLE, "many")
    with pytest.raises(ShaderError, match="AOLAB_UNROLL = 'many' in the environment is not a whole number from 0 on"):
        text("")


@pytest.mark.parametrize(
    ("loop", "message"),
    [
        ("#pragma unroll\nwhile (true) {\n}", r"<inline>:2: #pragma unroll stands before for .*, not before: while"),
        ("#pragma unroll\nfor (int i = 0; i < lights; ++i) {\n}", r"<inline>:2: .*not before: for .*lights"),
        ("#pragma unroll", r"<inline>:2: .*not before: $"),
        ("#pragma unroll\nfor (int i = 0; i < 3; ++i) {\n    if (a) break;\n}", r"<inline>:4: .*not left by: if"),
        ("#pragma unroll\nfor (int i = 0; i < 3; ++i) {\n    continue;\n}", r"<inline>:4: .*not left by: continue"),
        ("#pragma unroll\nfor (int i = 0; i < 3; ++i) {\n    f(i); }", r"<inline>:4: write the closing brace"),
        ("#pragma unroll\nfor (int i = 0; i < 3; ++i) {\n    f(i);", r"<inline>:2: .* has no closing brace"),
    ],
)
def test_other_loops_are_refused_by_line(loop, message):
    with pytest.raises(ShaderError, match=message):
        text(loop)


@pytest.mark.parametrize(
    ("module", "options"),
    [
        ("ssao", {}),
        ("ssao", {"filter": "bilateral"}),
        ("ssdo", {"bounces": 1}),
        ("s3ho", {"indirect": True}),
        ("ssbn", {}),
    ],
)
def test_a_frame_has_the_numbers_of_the_plain_loops(boxes, monkeypatch, module, options):
    """The check of the fast shaders. Measured: a difference of 0.001 at most, of half floats."""
    fast = aolab.Lab((64, 48)).render(boxes, module, radius=1.0, **options)
    monkeypatch.setenv(unroll.VARIABLE, "0")
    plain = aolab.Lab((64, 48)).render(boxes, module, radius=1.0, **options)
    for name in set(plain.buffers) - {"image"}:
        scale = np.abs(plain[name][np.isfinite(plain[name])]).max() + 1e-6
        assert np.nanmax(np.abs(fast[name][plain.mask] - plain[name][plain.mask])) <= 3e-3 * scale, name
