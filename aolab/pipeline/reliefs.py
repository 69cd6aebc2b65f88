"""Height maps on the GPU: all maps of a scene in one texture, one above the other."""

import weakref
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import moderngl
import numpy as np

from ..errors import GpuMemoryError
from ..gl import context
from ..gl.texture import refuse_exhaustion
from ..scene.mesh import HeightMap, Wrap
from ..scene.scene import Scene

# of texels around a map, so that it can be interpolated
PAD: dict[Wrap, Literal["wrap", "symmetric", "edge"]] = {"repeat": "wrap", "mirror": "symmetric", "clamp": "edge"}


@dataclass(frozen=True, eq=False)
class Reliefs:
    """`atlas` (R32F) holds the heights. `regions` (maps, 4) are the texels of each map: corner (x, y), width, height.

    `wraps` (maps, 2): 0 repeats, 1 mirrors, 2 clamps, in u and in v.
    """

    atlas: moderngl.Texture
    regions: np.ndarray
    wraps: np.ndarray

    @cached_property
    def uniforms(self) -> dict[str, object]:
        """The values of glsl/lib/relief.glsl."""
        return {
            "relief_region": self.regions.astype(np.float32).tobytes(),
            "relief_wrap": self.wraps.astype(np.float32).tobytes(),
        }


class ReliefStore:
    """The reliefs of scenes, kept for as long as their first height map lives."""

    def __init__(self) -> None:
        self._made: weakref.WeakKeyDictionary[HeightMap, tuple[tuple[int, ...], Reliefs]]
        self._made = weakref.WeakKeyDictionary()
        self._none: Reliefs | None = None

    def of(self, scene: Scene) -> Reliefs:
        """The reliefs of the scene's height maps; of none, a map of height 0."""
        maps = scene.height_maps
        if not maps:
            self._none = self._none or _made([HeightMap(np.zeros((1, 1), np.float32))])
            return self._none
        key = tuple(map(id, maps))
        if maps[0] not in self._made or self._made[maps[0]][0] != key:
            self._made[maps[0]] = key, _made(list(maps))
        return self._made[maps[0]][1]


def _made(maps: list[HeightMap]) -> Reliefs:
    """An atlas of the maps, each with a border of one texel. Raises `GpuMemoryError` for maps that are too large."""
    padded = [
        np.pad(np.pad(one.heights[::-1], ((0, 0), (1, 1)), PAD[one.wrap[0]]), ((1, 1), (0, 0)), PAD[one.wrap[1]])
        for one in maps
    ]
    width, height = max(one.shape[1] for one in padded), sum(one.shape[0] for one in padded)
    limit = context.get().info["GL_MAX_TEXTURE_SIZE"]
    if max(width, height) > limit:
        sizes = ", ".join(f"'{one.name}' {one.heights.shape[1]}x{one.heights.shape[0]}" for one in maps[:5])
        raise GpuMemoryError(
            f"{len(maps)} height maps ({sizes}) need a texture over the driver's {limit}; use smaller ones"
        )
    atlas, rows, regions = np.zeros((height, width), np.float32), 0, []
    for one in padded:
        atlas[rows : rows + one.shape[0], : one.shape[1]] = one
        regions.append((1, rows + 1, one.shape[1] - 2, one.shape[0] - 2))
        rows += one.shape[0]
    texture = context.get().texture((width, height), 1, atlas.tobytes(), dtype="f4")
    refuse_exhaustion(f"height maps of {width}x{height}")
    texture.filter, texture.repeat_x, texture.repeat_y = (moderngl.LINEAR, moderngl.LINEAR), False, False
    kinds = [*PAD]
    return Reliefs(texture, np.array(regions), np.array([[kinds.index(wrap) for wrap in one.wrap] for one in maps]))
