"""Textures that passes draw into: made by format name, lent from a pool, read back the right side up."""

import math
import operator
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

import moderngl
import numpy as np

from ..errors import GpuMemoryError, ParameterError, suggestion
from . import context

# name: (components, moderngl dtype); "f2", "f4": half and single floats; "f1", "nu2": bytes and 16 bits, from 0 to 1;
# "u4": whole numbers
FORMATS = {
    "R8": (1, "f1"),
    "RGBA8": (4, "f1"),
    "RG16": (2, "nu2"),
    "R16F": (1, "f2"),
    "RG16F": (2, "f2"),
    "RGBA16F": (4, "f2"),
    "R32F": (1, "f4"),
    "RG32F": (2, "f4"),
    "RGBA32F": (4, "f4"),
    "R32UI": (1, "u4"),
    "RGBA32UI": (4, "u4"),
}
# moderngl dtype: as it is stored, as `read` returns it
_DTYPES = {
    "f1": (np.uint8, np.uint8),
    "nu2": (np.uint16, np.uint16),
    "f2": (np.float16, np.float32),
    "f4": (np.float32, np.float32),
    "u4": (np.uint32, np.uint32),
}
DEPTH = "DEPTH24"  # the format of a depth texture, which `make` makes too
Size = tuple[int, int]
Depth = moderngl.Texture | moderngl.Renderbuffer


def check_size(size: Size) -> Size:
    """(width, height) as the driver can draw it; raises `ParameterError` with the driver's limit."""
    try:
        width, height = (operator.index(value) for value in size)
    except (TypeError, ValueError):
        raise ParameterError(f"size = {size!r} is not two whole numbers, (width, height)") from None
    limit = context.get().info["GL_MAX_TEXTURE_SIZE"]
    if not (1 <= width <= limit and 1 <= height <= limit):
        raise ParameterError(f"size = {width}x{height}: each side must be from 1 to {limit} pixels on this driver")
    return width, height


def make(size: Size, format: str, data: bytes | None = None) -> moderngl.Texture:
    """A nearest-filtered, edge-clamped texture. Raises `GpuMemoryError` where the driver has no room.

    `extra` of the texture is its border: the value that samplers read beyond the edge, or None for the nearest texel.
    """
    if format == DEPTH:
        depth = context.get().depth_texture(size)
        refuse_exhaustion(f"a depth texture of {size[0]}x{size[1]}")
        return depth
    if format not in FORMATS:
        raise ParameterError(f"texture format '{format}' is unknown{suggestion(format, FORMATS)}")
    components, dtype = FORMATS[format]
    gl = context.get()
    needed = math.prod(size) * components * np.dtype(_DTYPES[dtype][0]).itemsize
    gl.clear_errors() if hasattr(gl, "clear_errors") else gl.error
    try:
        texture = gl.texture(size, components, data, dtype=dtype)
    except moderngl.Error as error:
        raise GpuMemoryError(f"no {needed / 1e6:.0f} MB for a {size[0]}x{size[1]} {format} texture: {error}") from error
    refuse_exhaustion(f"a {size[0]}x{size[1]} {format} texture of {needed / 1e6:.0f} MB")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    texture.repeat_x = texture.repeat_y = False
    return texture


def refuse_exhaustion(what: str) -> None:
    """Raise `GpuMemoryError` if the driver has said that memory ran out: otherwise the picture would be black."""
    error = context.get().error
    if error == "GL_OUT_OF_MEMORY":
        raise GpuMemoryError(f"the driver ran out of memory for {what}; use a smaller size, or fewer kept frames")
    if error != "GL_NO_ERROR":
        raise GpuMemoryError(f"the driver refused {what}: {error}")


def attach(textures: list[moderngl.Texture], depth: Depth | None = None) -> moderngl.Framebuffer:
    """A framebuffer over these. Raises `GpuMemoryError`: some drivers say only here that there was no memory."""
    try:
        return context.get().framebuffer(textures, depth)
    except moderngl.Error as error:
        width, height = (*textures, depth)[0].size  # pyright: ignore[reportOptionalMemberAccess]
        raise GpuMemoryError(
            f"the driver has no room to draw at {width}x{height}: {error}; use a smaller size"
        ) from error


@dataclass(frozen=True, eq=False)
class Kept:
    """Textures that outlive the frame that drew them, and the `key` of their content."""

    key: object
    textures: Mapping[str, moderngl.Texture]


class Pool:
    """Textures and their framebuffers, used again when nobody holds them; and `kept` textures by name."""

    def __init__(self) -> None:
        self.kept: dict[str, Kept] = {}
        self._even: dict[tuple[Size, str, float], moderngl.Texture] = {}
        self._free: dict[tuple[Size, str], list[moderngl.Texture]] = defaultdict(list)
        self._framebuffers: dict[tuple[int, ...], moderngl.Framebuffer] = {}
        self._borders: dict[float, moderngl.Sampler] = {}

    def take(self, size: Size, format: str, border: float | None = None) -> moderngl.Texture:
        """A texture of unspecified content; beyond its edge, samplers read `border`, or the nearest texel for None."""
        free = self._free[size, format]
        texture = free.pop() if free else make(size, format)
        texture.extra = border
        return texture

    def give_back(self, lent: list[tuple[Size, str, moderngl.Texture]]) -> None:
        """Textures that are no longer held; touches no GL, so that any thread's garbage collector may call it."""
        for size, format, texture in lent:
            self._free[size, format].append(texture)

    def fill(self, texture: moderngl.Texture, format: str, value: float) -> None:
        """Give every texel and channel one value.

        On a software renderer, by a copy of a kept texture, which took a quarter of the time (RGBA16F).
        """
        if not context.is_software():
            self.framebuffer([texture]).clear(value, value, value, value)
            return
        key = texture.size, format, value
        if key not in self._even:
            self._even[key] = make(texture.size, format)
            self.framebuffer([self._even[key]]).clear(value, value, value, value)
        context.get().copy_framebuffer(self.framebuffer([texture]), self.framebuffer([self._even[key]]))

    def framebuffer(self, textures: list[moderngl.Texture], depth: Depth | None = None) -> moderngl.Framebuffer:
        """A framebuffer over these textures, kept."""
        key = (*(texture.glo for texture in textures), *_depth_key(depth))
        if key not in self._framebuffers:
            self._framebuffers[key] = attach(textures, depth)
        return self._framebuffers[key]

    def border(self, value: float) -> moderngl.Sampler:
        """Reads `value` beyond the edge of a texture, and the nearest texel within."""
        if value not in self._borders:
            nearest = moderngl.NEAREST, moderngl.NEAREST
            sampler = context.get().sampler(repeat_x=False, repeat_y=False, filter=nearest)
            sampler.border_color = (value, value, value, value)
            self._borders[value] = sampler
        return self._borders[value]

    def trim(self, sizes: set[Size]) -> None:
        """Free what nobody holds and is of none of these sizes."""
        for key in [key for key in self._even if key[0] not in sizes]:
            self._free[key[:2]].append(self._even.pop(key))
        for key in [key for key in self._free if key[0] not in sizes]:
            gone = {texture.glo for texture in self._free.pop(key)}
            for names in [names for names in self._framebuffers if gone & set(names)]:
                del self._framebuffers[names]


def _depth_key(depth: Depth | None) -> tuple[int, ...]:
    """Textures and renderbuffers are numbered apart: those of renderbuffers are negative here."""
    if depth is None:
        return ()
    return 0, depth.glo if isinstance(depth, moderngl.Texture) else -depth.glo


def read(texture: moderngl.Texture, channels: int | None = None) -> np.ndarray:
    """(H, W) or (H, W, channels), top row first; float32, or the whole numbers as they are stored."""
    context.get()  # refuses the wrong thread
    dtype, returned = _DTYPES[texture.dtype]
    what = f"reading back a {texture.width}x{texture.height} texture"
    try:
        # our own memory: moderngl's `read` does not survive if there is none
        pixels = np.empty((texture.height, texture.width, texture.components), dtype)
        texture.read_into(pixels, alignment=1)
        refuse_exhaustion(what)
        pixels = pixels[::-1, :, : channels or texture.components]
        pixels = pixels[..., 0] if pixels.shape[2] == 1 else pixels
        return np.ascontiguousarray(pixels, returned)
    except MemoryError as error:
        raise GpuMemoryError(f"no memory for {what}: {error}") from error
