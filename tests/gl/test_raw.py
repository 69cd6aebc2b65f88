"""OpenGL calls beyond moderngl: integer targets, bits that are OR-ed together, locations of outputs."""

import moderngl
import numpy as np
import pytest

from aolab.gl import raw, texture
from aolab.gl.program import Programs

BITS = """
uniform uint low;
out uvec4 mask;
void main() { mask = uvec4(low, 0u, 0u, 1u << uint(gl_FragCoord.x)); }
"""


def drawn(gl, values: list[int], combined: bool) -> np.ndarray:
    """(4, 8, 4) uint32: the target after one full-screen pass for each value of `low`."""
    target = texture.make((8, 4), "RGBA32UI")
    framebuffer = gl.framebuffer([target])
    raw.clear_integers(framebuffer, 0)
    program = Programs().get(BITS, outputs=["mask"])
    screen = gl.vertex_array(program.gl, [])
    framebuffer.use()
    gl.enable_only(moderngl.NOTHING)
    for value in values:
        program.set({"low": value})
        if combined:
            with raw.or_bits():
                screen.render(moderngl.TRIANGLES, 3)
        else:
            screen.render(moderngl.TRIANGLES, 3)
    return texture.read(target)


def test_bits_are_ored_into_an_integer_target(gl):
    pixels = drawn(gl, [0b0001, 0b1001, 0x80000000], combined=True)
    assert (pixels[..., 0] == 0x80000009).all()
    assert (pixels[..., 1:3] == 0).all()
    np.testing.assert_array_equal(pixels[0, :, 3], 2 ** np.arange(8))


def test_outside_of_the_block_the_last_value_stays(gl):
    assert (drawn(gl, [0b0001, 0b1001, 0b0100], combined=False)[..., 0] == 0b0100).all()
    assert gl.error == "GL_NO_ERROR"


def test_an_integer_target_is_cleared_to_a_value(gl):
    target = texture.make((2, 2), "R32UI")
    raw.clear_integers(gl.framebuffer([target]), 0, 0xFFFFFFFF)
    assert (texture.read(target) == 0xFFFFFFFF).all()


def test_the_location_of_an_output_is_the_drivers(gl):
    linked = gl.program(
        vertex_shader="#version 330 core\nvoid main() { gl_Position = vec4(0.0); }\n",
        fragment_shader="#version 330 core\nlayout(location = 3) out vec4 a;\nlayout(location = 1) out vec4 b;\n"
        "void main() { a = vec4(0.0); b = vec4(1.0); }\n",
    )
    assert [raw.frag_data_location(linked, name) for name in ("a", "b", "c")] == [3, 1, -1]


def test_any_function_is_called_by_its_name_and_types(gl):
    import ctypes

    get_string = raw.function("glGetString", ctypes.c_char_p, raw.Enum)
    assert get_string(0x1F01).decode() == gl.info["GL_RENDERER"]  # GL_RENDERER


@pytest.mark.parametrize("format", ["R32UI", "RGBA32UI"])
def test_whole_numbers_keep_every_bit(gl, format):
    components = texture.FORMATS[format][0]
    values = np.random.default_rng(0).integers(0, 2**32, (3, 5, components), dtype=np.uint32)
    read = texture.read(texture.make((5, 3), format, values[::-1].tobytes()))
    np.testing.assert_array_equal(read, values[..., 0] if components == 1 else values)
