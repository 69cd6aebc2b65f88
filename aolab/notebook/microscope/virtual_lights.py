"""The twin of glsl/virtual_lights.frag, of its shadow maps (lib/shadow_tiles.glsl) and of lib/fill.glsl."""

from dataclasses import replace

import numpy as np

from ...modules.virtual_lights import VirtualLights
from .blocking import blocked
from .inputs import F, Inputs
from .receiver import Receiver, Texel, lift_off, moved, receiver_at
from .samples import Samples

FILL_THICKNESS = F(0.5)  # as in glsl/lib/fill.glsl
FARTHER, LEAST_FAR = 1.3, 0.1  # of the ways to lights without a place; the least in radii of the scene
# the offsets of the four comparisons of a shadow map, in texels, as in glsl/lib/light.glsl
COMPARISONS = (np.array([(0, 0), (1, 0), (0, 1), (1, 1)], F) - F(0.5)) * F(1.5)


def virtual_lights(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """Light i contributes its irradiance times its shadow. Its shadow map is the last test, after the fill's points."""
    receiver = receiver_at(seen, texel)
    receiver = replace(receiver, facet=receiver.normal)  # as the shader has it
    to_world, from_world = seen.matrix("world_from_view")[:3], seen.matrix("view_from_world")[:3]
    height = (F(1) if seen.orthographic else -receiver.surface[2]) * seen.vector("ray_from_pixel")[0] / F(256)
    place = moved(to_world, (receiver.surface + receiver.normal * height).astype(F))
    normal = (to_world[:, :3] @ receiver.normal).astype(F)

    rows = seen["light_rows"][::-1][: int(seen.uniforms["light_count"])]
    to_light, away, light = _arriving(seen, rows, place, normal)
    ways = (to_light @ from_world[:, :3].T).astype(F)
    shares, in_maps = np.ones(len(rows)), np.broadcast_to(place, (len(rows), 3)).copy()
    for i in range(len(rows)):
        shares[i], in_maps[i] = _shadow(seen, i, place)
    points, hits, occluders = _filled(seen, receiver, place, ways, away)
    hits = np.column_stack([hits, shares <= 0.5])
    at_maps = moved(from_world, in_maps)[:, None]
    shares = shares * ~hits[:, :-1].any(axis=1)
    parts = light * shares[:, None]
    buffer = next(iter(seen.step.outputs))
    far = bool((rows[:, 1, 3] > 0.5).all())
    if far:  # the ways are drawn past the farthest blocker
        lengths = np.linalg.norm(at_maps[hits.any(axis=1), 0] - receiver.surface, axis=1)
        away = np.full(len(rows), max(F(FARTHER) * lengths.max(initial=0), F(LEAST_FAR) * F(seen.scene.radius)))
    ends = receiver.surface + ways * away[:, None]
    return Samples(
        "light", receiver.surface, receiver.normal, ends, np.concatenate([points, at_maps], axis=1), hits,
        np.concatenate([occluders, at_maps], axis=1), {buffer: parts}, {buffer: parts.sum(axis=0)}, shares,
        "infinity" if far else "light",
    )  # fmt: skip


def _arriving(
    seen: Inputs, rows: np.ndarray, place: np.ndarray, normal: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """`arriving`: the unit directions to the lights (n, 3), their distances (n,), and irradiances (n, 3)."""
    places, facing, sent = (rows[:, k, :3] for k in range(3))
    if (rows[:, 1, 3] > 0.5).all():
        return places, np.full(len(rows), F(3e38)), sent * np.maximum(places @ normal, 0)[:, None]
    ways = places - place
    squared = np.maximum((ways**2).sum(axis=1), F(1e-20))
    away = np.sqrt(squared)
    to_light = ways / away[:, None]
    geometry = np.maximum(to_light @ normal, 0) * np.maximum(-(facing * to_light).sum(axis=1), 0) / squared
    if seen.uniforms["clamped"]:
        geometry = np.minimum(geometry, 1 / seen.number("vpl_clamp") ** 2)
    return to_light, away, sent * (geometry / F(np.pi))[:, None]


def _shadow(seen: Inputs, tile: int, place: np.ndarray) -> tuple[float, np.ndarray]:
    """The unshadowed share of a light at a world-space place, and the place (3,) of the surface in its shadow map.

    The place is the receiver's own where the map has no shadow.
    """
    row = seen["shadow_table"][::-1][tile]
    to_tile, (left, bottom, side) = row[:4].T, row[4, :3]
    clip = moved(to_tile, place)
    in_tile = clip[:3] / clip[3] * F(0.5) + F(0.5)
    if clip[3] <= 0 or in_tile[2] >= 1 or (np.abs(in_tile[:2] - F(0.5)) > F(0.5)).any():
        return 1.0, place
    atlas, corner = seen["shadow_atlas"][::-1], np.array([left, bottom], F)
    texel = F(1) / np.array(atlas.shape[::-1], F)
    at = corner + in_tile[:2] * side
    uv = np.clip(at + COMPARISONS * texel, corner + texel, corner + side - texel)
    low = np.floor(uv / texel - F(0.5))
    u, v = (uv / texel - F(0.5) - low).T
    limit = np.array(atlas.shape[::-1]) - 1
    x0, y0 = np.clip(low, 0, limit).astype(int).T
    x1, y1 = np.clip(low + 1, 0, limit).astype(int).T
    near, far = (((in_tile[2] <= atlas[y, x0]) * (1 - u) + (in_tile[2] <= atlas[y, x1]) * u) for y in (y0, y1))
    share = near * (1 - v) + far * v
    if share.mean() == 1:
        return 1.0, place
    nearest = atlas[y0, x0].argmin()
    at_texel = np.array([x0[nearest], y0[nearest]])
    in_map = ((at_texel + 0.5) * texel - corner) / side
    seen_there = np.linalg.inv(to_tile.astype(np.float64)) @ (
        *(2 * in_map - 1),
        2 * _depth(seen, atlas, at_texel) - 1,
        1,
    )
    return float(share.mean()), seen_there[:3] / seen_there[3]


def _depth(seen: Inputs, atlas: np.ndarray, texel: np.ndarray) -> float:
    """The depth of the surface at a texel (column, row) of a shadow map, without the bias that glPolygonOffset adds."""
    assert isinstance(seen.step, VirtualLights)
    limit = np.array(atlas.shape[::-1]) - 1

    def depth(step: tuple[int, int]) -> float:
        column, row = np.clip(texel + step, 0, limit)
        return float(atlas[row, column])

    here = depth((0, 0))
    # the change to the next texel; of the two sides, the one that is on the same surface
    changes = [min(abs(depth((x, y)) - here), abs(depth((-x, -y)) - here)) for x, y in ((1, 0), (0, 1))]
    return here - seen.step.slope_bias * max(changes)


def _filled(
    seen: Inputs, receiver: Receiver, place: np.ndarray, ways: np.ndarray, away: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """`isFilledOpen`: the points (n, fill, 3) on the ways to the lights, whether each is blocked, and the occluders."""
    fill = int(seen.uniforms["fill"])
    points = np.zeros((len(ways), fill, 3), F)
    hits, occluders = np.zeros(points.shape[:2], bool), points.copy()
    table = seen["shadow_table"][::-1]
    along = (np.arange(fill, dtype=F)[:, None] + F(0.5)) / F(max(fill, 1))
    for i in range(len(ways) if fill else 0):
        cosine = np.clip(receiver.normal @ ways[i], F(0.05), F(1))
        bias = table[i, 4, 3] * moved(table[i, :4].T, place)[3] * np.sqrt(1 - cosine * cosine) / cosine
        reach = min(bias, away[i])
        height = lift_off(seen, F(0), reach, receiver.surface)
        lifted = replace(receiver, position=(receiver.surface + receiver.normal * height).astype(F))
        points[i] = lifted.position + ways[i] * (reach * along)
        found = blocked(seen, lifted, points[i], FILL_THICKNESS * reach)
        hits[i], occluders[i] = found.blocked, found.position
    return points, hits, occluders
