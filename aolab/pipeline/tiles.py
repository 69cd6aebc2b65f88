"""Tiles: squares of pixels, over which a pass is drawn in place of the whole picture."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import moderngl

from ..gl import context
from ..gl.bindings import Bindings
from ..gl.texture import Size
from ..scene.view import Region

PIXELS = 8  # a side of a tile. Of 8, 16 and 32, 8 took the least time (box4, llvmpipe, 960×540)


def grid(size: Size) -> Size:
    """The number of tiles in a row and in a column, which cover a picture of this size."""
    return -(-size[0] // PIXELS), -(-size[1] // PIXELS)


@dataclass(frozen=True, eq=False)
class Tiles:
    """The tiles over which a pass is drawn: `texture` has a texel a tile, above 0 where the pass is drawn.

    A tile is a point of OpenGL, `PIXELS` wide: on llvmpipe, two triangles a tile took 1.4 times as long as a point.
    """

    texture: moderngl.Texture
    vertex = "pipeline/tiles.vert"
    depth = None

    @property
    def bindings(self) -> list[Bindings]:
        """The values that the vertex shader reads."""
        return [Bindings("the tiles", {"tiles": self.texture}, constants={"tile_pixels": PIXELS})]

    @contextmanager
    def test(self, framebuffer: moderngl.Framebuffer) -> Iterator[None]:
        """Draw tiles: the size of a point is that of its vertex shader."""
        gl = context.get()
        gl.enable_only(moderngl.PROGRAM_POINT_SIZE)
        try:
            yield
        finally:
            framebuffer.scissor = None  # pyright: ignore[reportAttributeAccessIssue]  # its stub lacks None
            gl.enable_only(moderngl.NOTHING)

    def draw(self, framebuffer: moderngl.Framebuffer, vertices: moderngl.VertexArray, band: Region) -> None:
        """Draw the pixels of these tiles that are in `band`."""
        columns, rows = self.texture.size
        framebuffer.viewport = (0, 0, columns * PIXELS, rows * PIXELS)  # the last tiles may reach beyond the edge
        framebuffer.scissor = band
        vertices.render(moderngl.POINTS, columns * rows)
