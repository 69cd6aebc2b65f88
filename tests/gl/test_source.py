"""Shader sources: includes, constants, and where an error is."""

import pytest

from aolab import paths
from aolab.errors import ShaderError
from aolab.gl.report import told
from aolab.gl.source import assemble


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A glsl/ folder of its own; call it to write a file there."""
    monkeypatch.setattr(paths, "glsl", lambda: tmp_path)

    def write(name: str, text: str) -> None:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    return write


def code(source) -> list[str]:
    return source.text.splitlines()[1:]  # the first line is the version


# --- includes


def test_includes_are_nested_and_once_only(folder):
    folder("main.frag", '#include "lib/a.glsl"\n#include "lib/b.glsl"\nmain\n')
    folder("lib/a.glsl", '#include "lib/b.glsl"\na\n')
    folder("lib/b.glsl", "b\n")
    source = assemble("main.frag")
    assert code(source) == ["b", "a", "main"]
    assert source.text.startswith("#version 330 core\n")
    assert {path.name for path in source.files} == {"main.frag", "a.glsl", "b.glsl"}
    assert source.lines[1:] == [("glsl/lib/b.glsl", 1), ("glsl/lib/a.glsl", 2), ("glsl/main.frag", 3)]


def test_text_is_a_shader_too_and_may_include(folder):
    folder("lib/a.glsl", "a\n")
    source = assemble('#include "lib/a.glsl"\nmain\n')
    assert code(source) == ["a", "main"]
    assert source.lines[1:] == [("glsl/lib/a.glsl", 1), ("<inline>", 2)]


def test_an_alias_stands_for_a_file(folder):
    folder("main.frag", '#include "occluders.glsl"\nmain\n')
    folder("occluders/depth.glsl", "depth\n")
    assert code(assemble("main.frag", aliases={"occluders.glsl": "occluders/depth.glsl"})) == ["depth", "main"]


def test_a_cycle_is_told_with_its_chain(folder):
    folder("main.frag", '#include "a.glsl"\n')
    folder("a.glsl", '\n#include "b.glsl"\n')
    folder("b.glsl", '#include "c.glsl"\n')
    folder("c.glsl", '#include "a.glsl"\n')
    with pytest.raises(ShaderError, match=r"glsl/c\.glsl:1: include cycle: a\.glsl -> b\.glsl -> c\.glsl -> a\.glsl"):
        assemble("main.frag")


@pytest.mark.parametrize("spelling", ["main.frag", "./main.frag", "lib/../main.frag"])
def test_a_cycle_is_found_under_any_spelling(folder, spelling):
    folder("main.frag", f'#include "{spelling}"\n')
    folder("lib/a.glsl", "")
    with pytest.raises(ShaderError, match=r"glsl/main\.frag:1: include cycle: .*main\.frag"):
        assemble("main.frag")


def test_a_missing_file_is_told_with_the_nearest(folder):
    folder("main.frag", '\n\n#include "lib/smapling.glsl"\n')
    folder("lib/sampling.glsl", "")
    with pytest.raises(
        ShaderError, match=r"glsl/main\.frag:3: no file 'glsl/lib/smapling\.glsl'; did you mean 'lib/sampling\.glsl'"
    ):
        assemble("main.frag")
    with pytest.raises(ShaderError, match=r"shader 'mian\.frag': no file 'glsl/mian\.frag'; did you mean 'main\.frag'"):
        assemble("mian.frag")


@pytest.mark.parametrize("name", ["../secret.glsl", "lib/../../secret.glsl", "ABSOLUTE"])
def test_includes_do_not_leave_the_folder(folder, tmp_path, name):
    outside = tmp_path.parent / "secret.glsl"
    outside.write_text("secret\n")
    folder("main.frag", f'#include "{str(outside) if name == "ABSOLUTE" else name}"\n')
    with pytest.raises(ShaderError, match=r"glsl/main\.frag:1: no file"):
        assemble("main.frag")
    outside.unlink()


def test_a_link_out_of_the_folder_is_not_followed(folder, tmp_path):
    outside = tmp_path.parent / "linked.glsl"
    outside.write_text("secret\n")
    (tmp_path / "link.glsl").symlink_to(outside)
    folder("main.frag", '#include "link.glsl"\n')
    with pytest.raises(ShaderError, match=r"no file 'glsl/link\.glsl'"):
        assemble("main.frag")
    outside.unlink()


def test_the_system_form_of_include_is_refused(folder):
    folder("main.frag", "#include <lib/a.glsl>\n")
    with pytest.raises(
        ShaderError, match=r'glsl/main\.frag:1: write #include "FILE", a path under glsl/, not: #include <'
    ):
        assemble("main.frag")


def test_a_version_of_its_own_is_refused(folder):
    folder("main.frag", "// head\n  #version 450\n")
    with pytest.raises(ShaderError, match=r"glsl/main\.frag:2: leave out #version; aolab writes '#version 330 core'"):
        assemble("main.frag")


# --- constants


def test_constants_fill_their_holes_in_their_types(folder):
    folder(
        "main.frag", "const int n;  // how many\nconst float x;\nconst bool on;\nconst uint u;\nconst float whole;\n"
    )
    source = assemble("main.frag", {"n": 3, "x": 0.1, "on": True, "u": 7, "whole": 2, "unused": 1})
    assert code(source) == [
        "const int n = 3;  // how many",
        "const float x = 0.1;",
        "const bool on = true;",
        "const uint u = 7u;",
        "const float whole = 2.0;",
    ]
    assert source.constants == {"n", "x", "on", "u", "whole"}


def test_a_constant_with_a_value_is_left_alone(folder):
    folder("main.frag", "const int REACH = 4;\n")
    assert code(assemble("main.frag")) == ["const int REACH = 4;"]


def test_a_constant_that_nothing_gives_is_refused_with_the_nearest(folder):
    folder("main.frag", "\nconst int direction;\n")
    with pytest.raises(
        ShaderError, match=r"glsl/main\.frag:2: constant 'direction' is not given; did you mean 'directions'\?"
    ):
        assemble("main.frag", {"directions": 8, "steps": 2})


def test_a_constant_of_the_wrong_type_is_refused(folder):
    folder("main.frag", "const int n;\n")
    with pytest.raises(ShaderError, match=r"glsl/main\.frag:1: constant 'n' is int, but was given 2\.5"):
        assemble("main.frag", {"n": 2.5})


@pytest.mark.parametrize("value", [float("inf"), float("nan")])
@pytest.mark.parametrize("kind", ["int", "float"])
def test_a_constant_that_glsl_cannot_write_is_refused(folder, kind, value):
    folder("main.frag", f"const {kind} x;\n")
    with pytest.raises(ShaderError, match=rf"glsl/main\.frag:1: constant 'x' is {kind}, but was given {value}"):
        assemble("main.frag", {"x": value})


# --- conditions


@pytest.mark.parametrize("line", ["#if FAST", "#elif FAST > 1", "  #  if defined(SLOW) && FAST", "#if !FAST // why"])
def test_a_condition_on_an_unknown_name_is_refused(folder, line):
    folder("main.frag", f"#define FASTER 1\n#ifdef SLOW\n{line}\n#endif\n")
    with pytest.raises(ShaderError, match=r"glsl/main\.frag:3: 'FAST' is not defined; did you mean 'FASTER'"):
        assemble("main.frag")


@pytest.mark.parametrize(
    "line", ["#if FAST", "#if defined(ANY) || defined OTHER", "#if GL_ES", "#if __VERSION__ >= 330"]
)
def test_conditions_on_known_names_pass(folder, line):
    folder("main.frag", f"#define FAST 1\n{line}\n#endif\n")
    assert line in assemble("main.frag").text


# --- errors of the compiler, in every driver's words

MESSAGES = {
    "Mesa": "0:4(12): error: `x' undeclared",
    "Apple and AMD": "ERROR: 0:4: 'x' : undeclared identifier",
    "NVIDIA": '0(4) : error C1503: undefined variable "x"',
    "Intel on Windows": "ERROR: 0:4: 'x' : undeclared identifier",
}


@pytest.mark.parametrize("driver", MESSAGES)
def test_a_drivers_message_is_told_in_our_files_and_lines(folder, driver):
    folder("main.frag", '// head\n#include "lib/a.glsl"\nvoid main() {}\n')
    folder("lib/a.glsl", "// a\n\nfloat y = x;\n")
    # line 1 is the version, 2 the head, 3 to 5 lib/a.glsl
    message = MESSAGES[driver].replace("4", "5", 1)
    located = told(message, assemble("main.frag"), {})
    assert located.startswith("glsl/lib/a.glsl:3: ")
    assert "x" in located.splitlines()[0].partition(":3: ")[2]
    assert located.splitlines()[1] == "    float y = x;"
    assert "ERROR: 0" not in located


def test_lines_that_are_none_of_ours_stay_as_they_are(folder):
    folder("main.frag", "void main() {}\n")
    source = assemble("main.frag")
    for message in ("0:99(1): error: beyond", "error: linking failed", "0(0) : warning"):
        assert told(message, source, {}) == message


def test_several_messages_are_each_located(folder):
    folder("main.frag", "a\nb\n")
    located = told("0:2(1): error: one\n\n0:3(1): error: two\n", assemble("main.frag"), {})
    assert located == "glsl/main.frag:1: error: one\n    a\nglsl/main.frag:2: error: two\n    b"
