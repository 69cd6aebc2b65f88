"""Programs: compiler errors name our lines; edits are picked up; the last good program stays."""

import os
import sys

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Lab, Module, ShaderError
from aolab.gl.bindings import Bindings
from aolab.gl.program import Programs
from aolab.gl.texture import Pool, read
from aolab.modules.passes import Pass
from aolab.pipeline.pass_runner import PassRunner


def write(path, text: str) -> None:
    """Write as an editor does, with a time stamp that differs from the last one whatever the clock's grain."""
    before = path.stat().st_mtime_ns if path.exists() else 0
    path.write_text(text)
    os.utime(path, ns=(before + 10**9, before + 10**9))


# --- errors


def test_an_error_names_file_and_line_through_nested_includes(gl, shaders):
    (shaders / "outer.glsl").write_text('// outer\n#include "inner.glsl"\n')
    (shaders / "inner.glsl").write_text("// inner\n\nfloat twice(float x) { return x * missing; }\n")
    (shaders / "main.frag").write_text(
        '#include "outer.glsl"\nout vec4 color;\nvoid main() { color = vec4(twice(1.0)); }\n'
    )
    with pytest.raises(ShaderError) as caught:
        Programs().get("main.frag")
    lines = str(caught.value).splitlines()
    assert lines[0] == "glsl/main.frag does not compile:"
    assert lines[1].startswith("glsl/inner.glsl:3: ")
    assert "missing" in lines[1]
    assert lines[2] == "    float twice(float x) { return x * missing; }"


def test_a_vertex_shaders_error_names_the_vertex_shader(gl, shaders):
    (shaders / "bad.vert").write_text("void main() {\n    gl_Position = nowhere;\n}\n")
    with pytest.raises(ShaderError, match=r"glsl/bad\.vert does not compile:\nglsl/bad\.vert:2: .*nowhere"):
        Programs().get("none.frag", vertex="bad.vert")


def test_a_text_shaders_error_counts_the_texts_lines(gl):
    with pytest.raises(ShaderError, match=r"<inline>:4: .*oops"):
        Programs().get('#include "lib/color.glsl"\nout vec4 color;\nvoid main() {\n    color = oops;\n}\n')


def test_a_shader_that_compiles_but_does_not_link_is_an_error(gl):
    with pytest.raises(ShaderError, match=r"<inline> does not compile:\n(.|\n)*twice"):
        Programs().get("float twice(float x);\nout vec4 color;\nvoid main() { color = vec4(twice(1.0)); }\n")


def test_a_uniform_that_nothing_gives_is_refused_with_the_nearest(lab, plane):
    class Typing(Module):
        name = "typing"
        shader = "uniform vec2 texel_sise;\nout float visibility;\nvoid main() { visibility = texel_sise.x; }\n"

    with pytest.raises(ShaderError, match=r"uniform 'texel_sise' is given by nothing; did you mean 'texel_size'\?"):
        lab.render(plane, Typing())


def test_a_sampler_without_a_buffer_is_refused_with_the_nearest(lab, plane):
    class Typing(Module):
        name = "typing"
        shader = (
            "uniform sampler2D viewNormals;\nout float visibility;\n"
            "void main() { visibility = texelFetch(viewNormals, ivec2(0), 0).x; }\n"
        )

    with pytest.raises(ShaderError, match=r"no buffer 'viewNormals' to sample; did you mean 'viewNormal'\?"):
        lab.render(plane, Typing())


def test_a_uniform_that_the_compiler_drops_needs_no_value(lab, plane):
    class Lazy(Module):
        name = "lazy"
        shader = "uniform vec2 unused;\nout float visibility;\nvoid main() { visibility = 1.0; }\n"

    assert (lab.render(plane, Lazy())["visibility_raw"][-1] == 1).all()


# --- one program for each set of constants that it declares


def test_programs_are_kept_by_the_constants_that_they_declare(gl):
    programs = Programs()
    text = "const int n;\nout vec4 color;\nvoid main() { color = vec4(n); }\n"
    first = programs.get(text, {"n": 1, "other": 5})
    assert programs.get(text, {"n": 1, "other": 6}) is first
    assert programs.get(text, {"n": 2, "other": 5}) is not first
    assert programs.get(text, {"n": 1}) is first


# --- values


NUMBERS = "uniform vec2 pair;\nuniform int number;\nout vec4 color;\nvoid main() { color = vec4(pair, number, 1.0); }\n"


def drawn(runner: PassRunner, **values: object) -> list[float]:
    """The numbers that the program reads."""
    made = runner.run(Pass("numbers", NUMBERS, {"color": "RGBA32F"}), [Bindings("the test", uniforms=values)], (1, 1))
    return read(made["color"])[0, 0, :3].tolist()


def test_every_draw_has_its_own_values(gl):
    runner, first, second = PassRunner(Programs(), Pool()), (1.0, 2.0), (3.0, 4.0)
    for pair, number in ((first, 5), (second, 5), (second, 6), (first, 5), (first, 5)):
        assert drawn(runner, pair=pair, number=number) == [*pair, number]


@pytest.mark.parametrize("values", [[1.0, 2.0], np.float32([1, 2])], ids=["list", "array"])
def test_values_that_change_in_place_are_seen(gl, values):
    runner = PassRunner(Programs(), Pool())
    assert drawn(runner, pair=values, number=3) == [1, 2, 3]
    values[0] = 9.0
    assert drawn(runner, pair=values, number=3) == [9, 2, 3]


def test_a_value_of_another_type_is_refused_where_an_equal_one_was_taken(gl):
    runner = PassRunner(Programs(), Pool())
    drawn(runner, pair=(1.0, 2.0), number=3)
    with pytest.raises(ShaderError, match="'number' is int in the shader, and float in Python"):
        drawn(runner, pair=(1.0, 2.0), number=3.0)
    assert drawn(runner, pair=(1.0, 2.0), number=3) == [1, 2, 3]


# --- reload


@pytest.fixture
def edited(gl, shaders):
    """A lab over editable shaders, with a scene that it has rendered."""
    lab, scene = Lab((16, 12)), small_scenes.boxes()
    lab.render(scene, "none").complete()
    return lab, scene, shaders / "none.frag"


def visibility(frame: aolab.Frame) -> float:
    return float(np.nanmean(frame["visibility"]))


def test_a_good_edit_changes_the_image_when_asked_for(edited):
    lab, scene, shader = edited
    assert lab.reload() == []
    write(shader, shader.read_text().replace("1.0", "0.25"))
    assert visibility(lab.render(scene, "none")) == 1  # not yet
    assert lab.reload() == ["glsl/none.frag"]
    assert visibility(lab.render(scene, "none")) == 0.25
    assert lab.reload() == []


def test_watching_picks_edits_up_by_itself(edited):
    lab, scene, shader = edited
    lab.watch = True
    write(shader, shader.read_text().replace("1.0", "0.5"))
    assert visibility(lab.render(scene, "none")) == 0.5


def test_a_bad_edit_raises_and_the_last_good_program_stays(edited):
    lab, scene, shader = edited
    good = shader.read_text()
    write(shader, good.replace("1.0", "one"))
    with pytest.raises(ShaderError, match=r"glsl/none\.frag:\d+: .*one"):
        lab.reload()
    assert visibility(lab.render(scene, "none")) == 1
    write(shader, good.replace("1.0", "0.75"))
    assert lab.reload() == ["glsl/none.frag"]
    assert visibility(lab.render(scene, "none")) == 0.75


@pytest.mark.parametrize(
    "break_it", [lambda text: text.replace("1.0", "one"), lambda text: '#include "gone.glsl"\n' + text]
)
def test_a_bad_edit_raises_while_watching_too(edited, break_it):
    lab, scene, shader = edited
    lab.watch = True
    good = shader.read_text()
    write(shader, break_it(good))
    with pytest.raises(ShaderError, match=r"none\.frag"):
        lab.render(scene, "none")
    assert visibility(lab.render(scene, "none")) == 1  # said once; the last good program stays in use
    with pytest.raises(ShaderError, match=r"none\.frag"):
        lab.reload()  # an explicit reload raises again
    write(shader, good.replace("1.0", "0.75"))
    assert visibility(lab.render(scene, "none")) == 0.75


def test_one_bad_file_of_two_changes_neither(edited):
    lab, scene, shader = edited
    good = shader.read_text()
    compose = shader.parent / "pipeline" / "compose.frag"
    write(shader, good.replace("1.0", "0.5"))
    write(compose, compose.read_text() + "nonsense\n")
    with pytest.raises(ShaderError, match=r"compose\.frag"):
        lab.reload()
    assert visibility(lab.render(scene, "none")) == 1


def test_an_edit_of_an_included_file_reaches_all_who_include_it(edited):
    lab, scene, shader = edited
    color = shader.parent / "lib" / "color.glsl"
    write(color, color.read_text().replace("vec3 low = linear * 12.92;", "return vec3(0.0); vec3 low = linear;"))
    assert lab.reload() == ["glsl/pipeline/compose.frag"]
    assert not lab.render(scene, "none").image.any()


def test_an_edit_of_the_geometrys_shaders_is_drawn(edited):
    """Vertex arrays belong to a program: those of the old one must not be used with the new."""
    lab, scene, shader = edited
    gbuffer = shader.parent / "pipeline" / "gbuffer.frag"
    write(gbuffer, gbuffer.read_text().replace("clamp(base.rgb, 0.0, 1.0)", "vec3(0.125)"))
    for _ in range(2):
        lab.reload()
        frame = lab.render(scene, "none")
        np.testing.assert_array_equal(frame["albedo"][frame.mask], 0.125)


def test_an_edit_of_the_shadows_shader_draws_shadows_anew(edited):
    lab, scene, shader = edited
    scene = scene.replace(lights=(aolab.DirectionalLight((1, -2, -1)),))
    before = lab.render(scene, "none")["direct"]
    shadow = shader.parent / "pipeline" / "shadow.frag"
    write(shadow, shadow.read_text().replace("void main() {", "void main() {\n    discard;"))
    lab.reload()
    after = lab.render(scene, "none")["direct"]
    assert after.sum() > 1.01 * before.sum()


# --- interrupts


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="timers of POSIX")
def test_an_interrupt_in_the_compilation_does_not_end_the_process(python):
    """moderngl's C code calls Python for each uniform, and crashes if that raises: 3 of 3 runs without `postponed`."""
    done = python(
        """
        import random, signal
        from aolab.gl.program import Programs
        programs, interrupted = Programs(), 0
        uniforms = "".join(f"uniform vec4 x{i};\\n" for i in range(60))
        total = " + ".join(f"x{i}" for i in range(60))
        random.seed(1)
        for number in range(200):
            shader = f"{uniforms}out vec4 color;\\nvoid main() {{ color = {number}.0 * ({total}); }}\\n"
            try:
                signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
                signal.setitimer(signal.ITIMER_REAL, random.uniform(0.0005, 0.005))
                programs.get(shader)
                signal.setitimer(signal.ITIMER_REAL, 0)
            except KeyboardInterrupt:
                interrupted += 1
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
        print(interrupted > 20)
        """
    )
    assert (done.returncode, done.stdout) == (0, "True\n"), done.stderr
