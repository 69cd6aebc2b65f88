"""Reflective shadow maps: the surfaces that each light sees, with the flux that they reflect; in one row."""

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from ..errors import ParameterError, notice
from ..gl import context
from ..gl.bindings import Bindings
from ..gl.texture import make
from ..modules.buffers import REFLECTIVE
from ..modules.passes import GeometryPass, Pass
from ..scene.lights import PointLight
from ..scene.view import Projection
from .pass_runner import Buffers
from .rasterizer import Rasterizer
from .shadows import light_projections

_MAPS = GeometryPass(
    "reflective shadow maps",
    "rsm.map.frag",
    {name: row.format for name, row in REFLECTIVE.items()},
    clear={"rsm_depth": inf},
)

PACKED = "rsm_packed"
_PACK = Pass("pack maps", "rsm.pack.frag", {PACKED: "RGBA32UI"})

# view_from_world and clip_from_view of a map without a light: every vertex lies behind the far plane
_NOTHING = np.eye(4), np.array([(0, 0, 0, 0), (0, 0, 0, 0), (0, 0, 0, 2), (0, 0, 0, 1)], float)
DEFAULT_SIZE = 256  # for a module without the parameter `rsm_resolution`


@dataclass(frozen=True)
class ReflectiveMaps:
    """The maps of all lights but points: `buffers` by name, and `bindings` with `rsm_table` for shaders.

    The table has a row for each map: the four columns of its clip_from_world; then the number of its light, the width
    of its pixels (at the distance 1 from a spot), and its pixels a side.
    """

    buffers: Buffers
    bindings: Bindings


def draw_reflective(rasterizer: Rasterizer, lamps: Bindings, size: int) -> ReflectiveMaps:
    """Draw the maps, `size` pixels a side. A `Notice` counts the point lights, which have none."""
    scene = rasterizer.scene
    if points := sum(isinstance(light, PointLight) for light in scene.lights):
        notice(
            f"scene '{scene.name}': {points} of its {len(scene.lights)} lights are points, which have no reflective "
            "shadow map: their light does not bounce. A spot has a map"
        )
    rows, projections = [], []
    for number, light in enumerate(scene.lights):
        if not isinstance(light, PointLight):
            ((view, clip),) = light_projections(light, scene)
            projections.append((view, clip))
            rows.append([*(clip @ view).T, (number, 2 / clip[0, 0] / size, size, 0)])
    table = np.array(rows or np.zeros((1, 5, 4)), np.float32)  # GL has no empty texture
    box = (*(scene.centre - scene.shader_origin), scene.radius * 1.001)
    given = Bindings(
        "the reflective shadow maps",
        {"rsm_table": make((5, len(table)), "RGBA32F", table.tobytes())},
        {"rsm_box": tuple(map(float, box))},
        {"rsm_tiles": len(rows)},
    )
    key = (scene.instances, scene.lights, size)
    maps = rasterizer.kept("reflective shadow maps", key, lambda: _drawn(rasterizer, projections, size, [lamps, given]))
    buffers = {name: maps[name] for name in REFLECTIVE}
    return ReflectiveMaps(buffers, replace(given, textures={**given.textures, **maps}))


def _drawn(
    rasterizer: Rasterizer, projections: list[tuple[np.ndarray, np.ndarray]], size: int, given: list[Bindings]
) -> Buffers:
    """The maps, and the same packed."""
    count, limit = max(1, len(projections)), context.get().info["GL_MAX_TEXTURE_SIZE"]
    if count * size > limit:
        raise ParameterError(
            f"{count} reflective shadow maps of {size} pixels a side stand in a row of {count * size}; this driver has "
            f"at most {limit}. At most {limit // size} such maps fit, or {count} with rsm_resolution = {limit // count}"
        )
    sheet = count * size, size
    views = [
        Projection(view, clip, (size, size), (number * size, 0), sheet)
        for number, (view, clip) in enumerate(projections or [_NOTHING])
    ]
    maps = rasterizer.triangles(_MAPS, views, given)
    return maps | rasterizer.run(_PACK, [*given, Bindings("the maps", maps)], sheet)
