"""Finds the tiles in which a buffer differs from one value: elsewhere, the result of a pass over them is known."""

from math import ceil

import moderngl

from ..gl.bindings import Bindings
from ..gl.texture import FORMATS
from ..modules.passes import Pass
from ..scene.view import View, ray_scale_offset
from .pass_runner import PassRunner
from .tiles import PIXELS, Tiles, grid


def differing(
    runner: PassRunner,
    name: str,
    texture: moderngl.Texture,
    format: str,
    value: float,
    seen: View,
    drawn: View,
    reach: int,
) -> Tiles:
    """The tiles of the picture of `drawn` with another value than `value`, at most `reach` texels from the tile.

    `texture`, of `format`, is a buffer of the view `seen`, which may be smaller. `name` is for the timings.
    """
    there, here = (ray_scale_offset(view.camera, view.size) for view in (seen, drawn))
    scale = [here[axis] / there[axis] for axis in (0, 1)]
    offset = [(here[axis + 2] - there[axis + 2]) / there[axis] for axis in (0, 1)]
    constants = {
        "tile_pixels": PIXELS,
        "across": ceil(PIXELS * scale[1]) + (seen.size != drawn.size),  # a tile may begin within a texel
        "reach": reach,
        "single": FORMATS[format][0] == 1,
    }
    numbers = {
        "value": value,
        "source_texel_size": (1 / texture.width, 1 / texture.height),
        "source_from_pixel": (*scale, *offset),
    }
    step = Pass(name, "pipeline/tiles.frag", {"tiles": "R8"}, constants)
    return Tiles(runner.run(step, [Bindings("the buffer", {"source": texture}, numbers)], grid(drawn.size))["tiles"])
