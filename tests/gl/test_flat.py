"""Uniforms as flat varyings: the same numbers, and reports about the shader as it is written."""

import numpy as np
import pytest

import aolab
from aolab import ShaderError
from aolab.gl import context, program
from aolab.gl.flat import flattened
from aolab.gl.source import assemble

ROOM = 30


def texts(fragment: str, room: int = ROOM, read: str = "abc") -> tuple[str, str]:
    made = flattened(assemble("pipeline/fullscreen.vert"), assemble(fragment), room, lambda: read)
    return made[0].text, made[1].text


def test_each_uniform_has_a_varying_at_a_location_of_its_own():
    vertex, fragment = texts(
        "const int count = 3;\nuniform float a;   // unit\nuniform mat4 b;\nuniform vec2 c[count];\nuniform int d;\n"
    )
    for location, declared in ((0, "float a"), (1, "mat4 b"), (5, "vec2 c[count]"), (8, "int d")):
        assert f"layout(location = {location}) flat in {declared};" in fragment
        assert f"uniform {declared.replace('count', '3')}; layout(location = {location}) flat out" in vertex
    assert "// unit" in fragment
    assert "uniform" not in fragment


@pytest.mark.parametrize(
    "line",
    ["uniform float a = 1.0;", "uniform float a, b;", "uniform bool a;", "uniform sampler2D a;", "uniform vec4 a[n];"],
)
def test_other_declarations_stay(line):
    vertex, fragment = texts(f"{line}\n")
    assert line in fragment
    assert "flat" not in vertex


def test_uniforms_beyond_the_room_stay():
    _, fragment = texts("uniform mat4 a;\nuniform mat4 b;\nuniform vec4 c;\n", room=5)
    assert "flat in mat4 a;" in fragment
    assert "uniform mat4 b;" in fragment
    assert "location = 4) flat in vec4 c;" in fragment


def test_uniforms_that_are_not_read_take_no_room():
    _, fragment = texts("uniform mat4 a;\nuniform mat4 b;\nuniform vec4 c;\n", room=5, read="bc")
    assert "uniform mat4 a;" in fragment
    assert "location = 0) flat in mat4 b;" in fragment
    assert "location = 4) flat in vec4 c;" in fragment


def test_the_driver_finds_the_uniforms_that_are_read(boxes, monkeypatch):
    """Of more uniforms than there is room for."""
    if not context.is_software():
        pytest.skip("on hardware, uniforms stay uniforms")

    class Many(aolab.Module):
        shader = """
        uniform mat4 view_from_world;
        uniform vec4 view_region;
        out float visibility;
        void main() { visibility = view_region.z; }
        """

    found = []

    def noted(vertex, fragment, room, read):
        if "view_region.z" in fragment.text:
            found.append((read(), flattened(vertex, fragment, 3, read)[1].text))
        return flattened(vertex, fragment, room, read)

    monkeypatch.setattr(program, "flattened", noted)
    aolab.Lab().render(boxes, Many(), size=(8, 8))
    names, text = found[0]
    assert names == {"view_region"}
    assert "flat in vec4 view_region;" in text


def test_both_branches_of_a_condition_declare_the_varying():
    _, fragment = texts("#ifdef A\nuniform vec2 a;\n#else\nuniform vec2 a;\n#endif\n")
    assert fragment.count("flat in vec2 a;") == 2


def test_lines_keep_their_places():
    source = assemble("float x;\nuniform float a;\nfloat y;\n")
    _, fragment = flattened(assemble("pipeline/fullscreen.vert"), source, ROOM, set)
    places = dict(zip(fragment.text.splitlines(), fragment.lines, strict=True))
    assert places["float y;"] == ("<inline>", 3)


@pytest.mark.parametrize(("module", "occluders"), [("ssao", "depth"), ("s3ho", "depth"), ("ssdo", "views")])
def test_buffers_and_pictures_are_those_of_uniforms(boxes, monkeypatch, module, occluders):
    if not context.is_software():
        pytest.skip("on hardware, uniforms stay uniforms")
    options = {"size": (64, 48), "radius": 1.0, "occluders": occluders}
    fast = aolab.Lab().render(boxes, module, **options)
    monkeypatch.setattr(program, "_flat_vectors", lambda: 0)
    plain = aolab.Lab().render(boxes, module, **options)
    np.testing.assert_array_equal(fast.image, plain.image)
    for name in plain.buffers:
        np.testing.assert_array_equal(fast[name], plain[name], err_msg=name)


def test_varyings_are_used(boxes, monkeypatch):
    """A vertex shader that hands on other numbers changes the picture."""
    if not context.is_software():
        pytest.skip("on hardware, uniforms stay uniforms")
    right = aolab.Lab().render(boxes, "ssao", size=(64, 48), radius=1.0)["visibility"]

    def wrong(*given):
        vertex, fragment = flattened(*given)
        vertex.text = vertex.text.replace("flat_radius = radius;", "flat_radius = 0.1 * radius;")
        return vertex, fragment

    monkeypatch.setattr(program, "flattened", wrong)
    other = aolab.Lab().render(boxes, "ssao", size=(64, 48), radius=1.0)["visibility"]
    assert np.nanmax(np.abs(right - other)) > 0.2


def test_a_report_is_about_the_shader_as_it_is_written(lab, boxes):
    class Wrong(aolab.Module):
        shader = "uniform vec2 texel_size;\nout float visibility;\nvoid main() { texel_size.x = visibility = 1.0; }"

    with pytest.raises(ShaderError, match="<Wrong>:3: ") as told:
        lab.render(boxes, Wrong(), size=(16, 16))
    assert "flat" not in str(told.value)


def test_a_uniform_that_is_declared_twice_is_an_error_as_on_hardware(lab, boxes):
    class Twice(aolab.Module):
        shader = """uniform vec2 texel_size;
uniform vec2 texel_size;
out float visibility;
void main() { visibility = texel_size.x; }"""

    with pytest.raises(ShaderError, match=r"<Twice>:2: .*texel_size"):
        lab.render(boxes, Twice(), size=(16, 16))
