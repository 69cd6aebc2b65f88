"""Three boxes between a pink and a turquoise light: a shadow has the colour of the light that still arrives.

For S3HO 2012, Fig. 5 (the paper also swaps the lights) and SSDO 2009, Fig. 3. Lesson: plain occlusion darkens every
crease to the same grey; directional occlusion keeps a crease pink if only the pink light reaches it. Scene and camera
are symmetric about the plane x = 0. Swapping the lights therefore mirrors the picture, which is an exact test.
"""

from functools import cache, lru_cache

import numpy as np

from aolab import Camera, Environment, Instance, Material, Mesh, Scene, SpotLight
from aolab.scene.shapes import block, in_range, loft, placed

PINK, TURQUOISE = np.array((1.0, 0.13, 0.36)), np.array((0.04, 0.78, 0.68))
PAPER = Material((0.8, 0.8, 0.8), name="paper")


def boxes(swap: bool = False, light: float = 1.0, ambient: float = 1.0) -> Scene:
    in_range("boxes", light=(light, 0, 100), ambient=(ambient, 0, 100))
    left, right = (TURQUOISE, PINK) if swap else (PINK, TURQUOISE)
    lamps = tuple(
        SpotLight((side * 5.5, 5.0, 2.5), (side * -5.5, -4.6, -2.5), tuple(light * 95 * color), inner=14, outer=42)
        for side, color in ((-1, left), (1, right))
    )
    return Scene(
        _still_life(),
        lamps,
        _glow(ambient, tuple(left), tuple(right)),
        Camera((0, 2.7, 6.6), (0, 0.72, 0), fov=31),
        name="boxes",
    )


@cache
def _still_life() -> tuple[Instance, ...]:
    tall, low = block((1.1, 1.9, 1.1), PAPER, "tall box"), block((1.05, 1.05, 1.05), PAPER, "low box")
    sunk = -0.01
    return (
        Instance(_backdrop()),
        Instance(tall, placed(0, sunk, -0.75, turn=45)),
        Instance(low, placed(-1.18, sunk, 0.35, turn=28)),
        Instance(low, placed(1.18, sunk, 0.35, turn=-28)),
    )


def _backdrop(width: float = 16.0, thickness: float = 0.2) -> Mesh:
    """A photographer's backdrop: a floor that curves up into a wall, so that the picture has no horizon."""
    radius, back, front, top = 2.5, -5.5, 3.4, 5.0
    angle = np.linspace(0, np.pi / 2, 33)
    bend = np.stack([radius * (1 - np.cos(angle)), back + radius - radius * np.sin(angle)], axis=-1)
    profile = np.array([(0, front), *bend, (top, bend[-1, 1])])  # y, z
    tangent = np.gradient(profile, axis=0)
    outside = np.stack([tangent[:, 1], -tangent[:, 0]], axis=-1) / np.linalg.norm(tangent, axis=1, keepdims=True)
    behind = profile + thickness * outside
    rings = [
        [(-width / 2, *a), (width / 2, *a), (width / 2, *b), (-width / 2, *b)]
        for a, b in zip(profile, behind, strict=True)
    ]
    return loft(np.array(rings), PAPER, "backdrop")


@lru_cache(8)  # a sweep of its strength has many
def _glow(strength: float, left: tuple[float, ...], right: tuple[float, ...]) -> Environment:
    """A dim grey environment with a wide soft box for each lamp, for methods that read the environment's light."""
    azimuth = 2 * np.pi * ((np.arange(128) + 0.5) / 128 - 0.5)
    polar = np.pi * (np.arange(64) + 0.5) / 64
    across, up = np.sin(azimuth) * np.sin(polar)[:, None], np.cos(polar)[:, None] + 0 * azimuth
    radiance = np.full((64, 128, 3), 0.05)
    for side, color in ((-1, left), (1, right)):
        radiance += 0.9 * np.clip(0.85 * side * across + 0.5 * up, 0, None)[..., None] ** 4 * color
    return Environment(strength * radiance, "two soft boxes")
