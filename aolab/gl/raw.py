"""OpenGL calls that moderngl has no name for, found by their address in the driver."""

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import moderngl

from . import context

Enum = ctypes.c_uint

_COLOR_LOGIC_OP, _OR = 0x0BF2, 0x1507  # GL_COLOR_LOGIC_OP, GL_OR
_COLOR = 0x1800  # GL_COLOR, of glClearBuffer
_TEXTURE_2D, _WRAP, _MIRRORED_REPEAT = 0x0DE1, (0x2802, 0x2803), 0x8370  # GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T


def function(name: str, result: Any, *arguments: Any) -> Callable[..., Any]:
    """The OpenGL function `name` with its C types: `function("glLogicOp", None, ctypes.c_uint)(0x1507)`.

    A driver may return an address for a name that it lacks: name functions of OpenGL 3.3 core only.
    """
    return _loaded(context.get(), name, result, *arguments)


@cache
def _loaded(gl: moderngl.Context, name: str, result: Any, *arguments: Any) -> Callable[..., Any]:
    address = gl.mglo._context.load_opengl_function(name)
    return ctypes.CFUNCTYPE(result, *arguments)(address)


def frag_data_location(program: moderngl.Program, name: str) -> int:
    """The location of the fragment shader's `out` variable `name`, or -1 where the linked program has none."""
    return function("glGetFragDataLocation", ctypes.c_int, ctypes.c_uint, ctypes.c_char_p)(program.glo, name.encode())


def clear_integers(framebuffer: moderngl.Framebuffer, attachment: int, value: int = 0) -> None:
    """Fill the unsigned integers of one colour attachment; `Framebuffer.clear` is for floats and normalised bytes."""
    framebuffer.use()
    values = (ctypes.c_uint * 4)(*[value] * 4)
    function("glClearBufferuiv", None, Enum, ctypes.c_int, ctypes.POINTER(ctypes.c_uint))(_COLOR, attachment, values)


@contextmanager
def or_bits() -> Iterator[None]:
    """Every fragment that is drawn inside is OR-ed into its integer target, bit by bit."""
    gl = context.get()
    function("glLogicOp", None, Enum)(_OR)
    gl.enable_direct(_COLOR_LOGIC_OP)
    try:
        yield
    finally:
        gl.disable_direct(_COLOR_LOGIC_OP)


@contextmanager
def depth_up_to(far: float) -> Iterator[None]:
    """Depths that are drawn inside lie from 0 to `far`, in place of 0 to 1."""
    depth_range = function("glDepthRange", None, ctypes.c_double, ctypes.c_double)
    depth_range(0.0, far)
    try:
        yield
    finally:
        depth_range(0.0, 1.0)


def mirror(texture: moderngl.Texture, axis: int) -> None:
    """Let the texture go on mirrored along an axis, 0 for u and 1 for v."""
    texture.use(0)
    function("glTexParameteri", None, Enum, Enum, ctypes.c_int)(_TEXTURE_2D, _WRAP[axis], _MIRRORED_REPEAT)
