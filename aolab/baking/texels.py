"""The texels of a mesh: which triangle covers the middle of each, and where."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import distance_transform_edt

MOST = 2_000_000  # pairs of a texel and a triangle at a time: bounds the memory to about 300 MB
OVERLAPPING = 0.01  # share of the covered texels; seams may meet in the middle of some


@dataclass(frozen=True)
class Texels:
    """Points on triangles: `place` (n,), the texel's index in rows from the top; `triangle` (n,); `weights` (n, 3),
    barycentric.
    """

    place: np.ndarray
    triangle: np.ndarray
    weights: np.ndarray

    def __bool__(self) -> bool:
        return len(self.place) > 0


def texels_of(uv: np.ndarray, side: int) -> Texels | None:
    """The texels, `side`² of them, that triangles with the UV (F, 3, 2), v up, cover; None if these cannot serve.

    They cannot if they leave [0, 1], or if triangles overlap in more than a hundredth of the covered texels.
    """
    if uv.min() < -1e-4 or uv.max() > 1 + 1e-4:
        return None
    corner = uv.astype(np.float64) * side
    corner[..., 1] = side - corner[..., 1]  # rows from the top
    low = np.clip(np.ceil(corner.min(axis=1) - 0.5), 0, side).astype(np.int64)
    high = np.clip(np.floor(corner.max(axis=1) - 0.5), -1, side - 1).astype(np.int64)
    width, height = np.maximum(high - low + 1, 0).T
    found = [Texels(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros((0, 3)))]
    area = width * height
    ends = np.cumsum(area)
    start = 0
    while start < len(corner):
        stop = max(start + 1, int(np.searchsorted(ends, (ends[start - 1] if start else 0) + MOST, side="right")))
        found.append(_covered(corner, low, width, area, np.arange(start, stop), side))
        start = stop
    place, triangle, weights = (
        np.concatenate([getattr(one, name) for one in found]) for name in ("place", "triangle", "weights")
    )
    _, first = np.unique(place, return_index=True)
    within = place[weights.min(axis=1) > 1e-6]  # a texel whose middle lies on an edge belongs to both triangles
    if len(np.unique(within)) < (1 - OVERLAPPING) * len(within):
        return None
    return Texels(place[first], triangle[first], weights[first])


def _covered(
    corner: np.ndarray, low: np.ndarray, width: np.ndarray, area: np.ndarray, which: np.ndarray, side: int
) -> Texels:
    """The texels whose middle lies in one of the triangles `which`."""
    triangle = np.repeat(which, area[which])
    number = np.arange(len(triangle)) - np.repeat(np.cumsum(area[which]) - area[which], area[which])
    x = low[triangle, 0] + number % np.maximum(width[triangle], 1)
    y = low[triangle, 1] + number // np.maximum(width[triangle], 1)
    a, b, c = (corner[triangle, k] - np.stack([x + 0.5, y + 0.5], axis=1) for k in range(3))
    areas = np.stack([_cross(b, c), _cross(c, a), _cross(a, b)], axis=1)
    whole = areas.sum(axis=1, keepdims=True)
    weights = areas / np.where(whole == 0, 1, whole)
    inside = (weights >= 0).all(axis=1) & (whole[:, 0] != 0)
    return Texels((y * side + x)[inside], triangle[inside], weights[inside])


def _cross(one: np.ndarray, two: np.ndarray) -> np.ndarray:
    return one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]


def filled(texels: Texels, values: np.ndarray, side: int) -> np.ndarray:
    """(side, side): the values (n,) at their texels, and at every other texel that of the nearest one.

    So filters and mipmaps read no empty texel beyond a seam.
    """
    picture, empty = np.ones(side * side), np.ones(side * side, bool)
    picture[texels.place], empty[texels.place] = values, False
    nearest = distance_transform_edt(empty.reshape(side, side), return_distances=False, return_indices=True)
    rows, columns = np.asarray(nearest)
    return picture.reshape(side, side)[rows, columns]
