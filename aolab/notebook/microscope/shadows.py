"""The twins of shadow maps (glsl/lib/shadow_tiles.glsl, light.glsl) and of the fill of their bias (lib/fill.glsl)."""

from dataclasses import replace

import numpy as np

from ...pipeline.shadows import ShadowSettings
from .blocking import blocked
from .inputs import F, Inputs
from .receiver import Receiver, lift_off, moved

FILL_THICKNESS = F(0.5)  # as in glsl/lib/fill.glsl
# the offsets of the four comparisons of a shadow map, in texels, as in glsl/lib/light.glsl
COMPARISONS = (np.array([(0, 0), (1, 0), (0, 1), (1, 1)], F) - F(0.5)) * F(1.5)

Length = float | np.floating
Tested = tuple[np.ndarray, np.ndarray, np.ndarray]  # points (S, 3), blocked (S,), occluders (S, 3)


def lit_place(seen: Inputs, receiver: Receiver) -> np.ndarray:
    """(3,): `litPoint` in world space, the place of which shadow maps are asked."""
    height = (F(1) if seen.orthographic else -receiver.surface[2]) * seen.vector("ray_from_pixel")[0] / F(256)
    return moved(seen.matrix("world_from_view")[:3], (receiver.surface + receiver.normal * height).astype(F))


def shadow(seen: Inputs, tile: int, place: np.ndarray) -> tuple[float, np.ndarray]:
    """The unshadowed share of a light at a world-space place, and the place (3,) of the surface in its shadow map.

    The place is the receiver's own where the map has no shadow.
    """
    row = seen["shadow_table"][::-1][tile]
    to_tile, corner, side = row[:4].T, row[4, :2], row[4, 2]
    clip = moved(to_tile, place)
    in_tile = clip[:3] / clip[3] * F(0.5) + F(0.5)
    if clip[3] <= 0 or in_tile[2] >= 1 or (np.abs(in_tile[:2] - F(0.5)) > F(0.5)).any():
        return 1.0, place
    atlas = seen["shadow_atlas"][::-1]
    pixel = np.clip(corner + in_tile[:2] * side + COMPARISONS, corner + F(1), corner + side - F(1))
    low = np.floor(pixel - F(0.5))
    u, v = (pixel - F(0.5) - low).T
    limit = np.array(atlas.shape[::-1]) - 1
    x0, y0 = np.clip(low, 0, limit).astype(int).T
    x1, y1 = np.clip(low + 1, 0, limit).astype(int).T
    near, far = (((in_tile[2] <= atlas[y, x0]) * (1 - u) + (in_tile[2] <= atlas[y, x1]) * u) for y in (y0, y1))
    share = near * (1 - v) + far * v
    if share.mean() == 1:
        return 1.0, place
    nearest = atlas[y0, x0].argmin()
    at_texel = np.array([x0[nearest], y0[nearest]])
    in_map = (at_texel + 0.5 - corner) / side
    seen_there = np.linalg.inv(to_tile.astype(np.float64)) @ (
        *(2 * in_map - 1),
        2 * _depth(seen, atlas, at_texel) - 1,
        1,
    )
    return float(share.mean()), seen_there[:3] / seen_there[3]


def _depth(seen: Inputs, atlas: np.ndarray, texel: np.ndarray) -> float:
    """The depth of the surface at a texel (column, row) of a shadow map, without the bias that glPolygonOffset adds."""
    limit = np.array(atlas.shape[::-1]) - 1

    def depth(step: tuple[int, int]) -> float:
        column, row = np.clip(texel + step, 0, limit)
        return float(atlas[row, column])

    here = depth((0, 0))
    # the change to the next texel; of the two sides, the one that is on the same surface
    changes = [min(abs(depth((x, y)) - here), abs(depth((-x, -y)) - here)) for x, y in ((1, 0), (0, 1))]
    return here - ShadowSettings.of(seen.module).slope_bias * max(changes)


def segment(
    seen: Inputs, receiver: Receiver, way: np.ndarray, reach: Length, along: np.ndarray, depth: Length
) -> Tested:
    """`isSegmentOpen`: points at the shares `along` (S,) of a segment of length `reach` on the unit `way`."""
    points = (receiver.position + way * (F(reach) * along[:, None])).astype(F)
    found = blocked(seen, receiver, points, F(depth))
    return points, found.blocked, found.position


def filled(seen: Inputs, receiver: Receiver, tile: int, place: np.ndarray, way: np.ndarray, away: Length) -> Tested:
    """`isFilledOpen`: the points in the gap that the bias of a tile leaves; none without `fill` or without a tile."""
    fill = int(seen.uniforms["fill"])
    if fill == 0 or tile < 0:
        points = np.broadcast_to(receiver.position, (fill, 3))
        return points, np.zeros(fill, bool), points
    cosine = np.clip(receiver.normal @ way, F(0.05), F(1))
    row = seen["shadow_table"][::-1][tile]
    bias = row[4, 3] * moved(row[:4].T, place)[3] * np.sqrt(1 - cosine * cosine) / cosine
    reach = min(bias, F(away))
    height = lift_off(seen, F(0), reach, receiver.surface)
    lifted = replace(receiver, position=(receiver.surface + receiver.normal * height).astype(F))
    along = (np.arange(fill, dtype=F) + F(0.5)) / F(fill)
    return segment(seen, lifted, way, reach, along, FILL_THICKNESS * reach)


def together(tested: list[Tested]) -> Tested:
    """The tests of n ways: (n, S, 3), (n, S) and (n, S, 3)."""
    if not tested:
        return np.zeros((0, 1, 3), F), np.zeros((0, 1), bool), np.zeros((0, 1, 3), F)
    points, hits, occluders = (np.stack(arrays) for arrays in zip(*tested, strict=True))
    return points, hits, occluders
