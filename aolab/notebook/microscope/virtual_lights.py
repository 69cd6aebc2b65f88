"""The twin of glsl/virtual_lights.frag."""

from dataclasses import replace

import numpy as np

from .inputs import F, Inputs
from .receiver import Texel, moved, receiver_at
from .samples import Samples
from .shadows import filled, lit_place, shadow, together

FARTHER, LEAST_FAR = 1.3, 0.1  # of the ways to lights without a place; the least in radii of the scene


def virtual_lights(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """Light i contributes its irradiance times its shadow. Its shadow map is the last test, after the fill's points."""
    receiver = receiver_at(seen, texel)
    receiver = replace(receiver, facet=receiver.normal)  # as the shader has it
    to_world, from_world = seen.matrix("world_from_view")[:3], seen.matrix("view_from_world")[:3]
    place, normal = lit_place(seen, receiver), (to_world[:, :3] @ receiver.normal).astype(F)

    rows = seen["light_rows"][::-1][: int(seen.uniforms["light_count"])]
    to_light, away, light = _arriving(seen, rows, place, normal)
    ways = (to_light @ from_world[:, :3].T).astype(F)
    shares, tested = np.ones(len(rows)), []
    for i in range(len(rows)):
        points, hits, occluders = filled(seen, receiver, i, place, ways[i], away[i])
        open_, in_map = shadow(seen, i, place)
        at_map = moved(from_world, in_map)[None]
        shares[i] = 0 if hits.any() else open_
        tested.append((np.vstack([points, at_map]), np.append(hits, open_ <= 0.5), np.vstack([occluders, at_map])))
    points, hits, occluders = together(tested)
    parts = light * shares[:, None]
    buffer = next(iter(seen.step.outputs))
    far = bool((rows[:, 1, 3] > 0.5).all())
    if far:  # the ways are drawn past the farthest blocker
        lengths = np.linalg.norm(occluders[:, -1] - receiver.surface, axis=1)[hits[:, -1]]
        away = np.full(len(rows), max(F(FARTHER) * lengths.max(initial=0), F(LEAST_FAR) * F(seen.scene.radius)))
    return Samples(
        "light", receiver.surface, receiver.normal, receiver.surface + ways * away[:, None], points, hits, occluders,
        {buffer: parts}, {buffer: parts.sum(axis=0)}, shares, "infinity" if far else "light",
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
    return to_light, away, sent * (np.minimum(geometry, rows[:, 0, 3]) / F(np.pi))[:, None]
