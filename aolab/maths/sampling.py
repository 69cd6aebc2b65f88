"""Directions over the hemisphere: low-discrepancy, stratified, seeded. Their lengths encode the falloff."""

from functools import lru_cache

import numpy as np


def radical_inverse(indices: np.ndarray, base: int) -> np.ndarray:
    """Van der Corput's sequence: the digits of `indices` in `base`, mirrored at the radix point; float64 in [0, 1)."""
    result, digit_value, rest = np.zeros(len(indices)), 1.0 / base, indices.copy()
    while rest.any():
        result += digit_value * (rest % base)
        rest //= base
        digit_value /= base
    return result


@lru_cache(maxsize=256)
def cosine_hemisphere(count: int, seed: int, falloff: float = 0.0) -> np.ndarray:
    """The kernel (count, 4) float32. xyz: a direction around +z, scaled by its reach; w: an offset in [0, 1), in steps.

    The directions have the density cosθ/π. They are Hammersley points (strata in elevation, radical inverses in the
    other dimensions), shifted as a whole by a random vector from `seed` (Cranley and Patterson 1976), and mapped by
    Malley's method: r = √u, z = √(1 - u).

    The reach, in radii, is random: an occluder at distance d lies within it with the probability `influence(d²)`. The
    falloff therefore costs nothing in the shader.
    """
    index = np.arange(count)
    shift = np.random.default_rng(seed).random(4)
    # seed 0 has its elevations in the middle of their strata
    elevation = (index + (0.5 if seed == 0 else shift[0])) / count
    azimuth = 2 * np.pi * (radical_inverse(index, 2) + shift[1])
    offset = (radical_inverse(index, 3) + shift[2]) % 1
    reach = _reach((radical_inverse(index, 5) + shift[3]) % 1, falloff)
    r = np.sqrt(elevation)
    direction = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), np.sqrt(1 - elevation)], axis=1)
    kernel = np.concatenate([direction * reach[:, None], offset[:, None]], axis=1).astype(np.float32)
    kernel.flags.writeable = False
    return kernel


@lru_cache(maxsize=64)
def ways(sets: int, seed: int, falloff: float = 0.0) -> np.ndarray:
    """One way in a given direction for each of `sets` interleaved sets of samples: (sets, 2) float32.

    Its reach, in radii, as `cosine_hemisphere` draws them, and the offset of its first point, in [0, 1) steps; both are
    stratified over the sets.
    """
    index = np.arange(sets)
    shift = np.random.default_rng(seed).random(2)
    offset = (index + (0.5 if seed == 0 else shift[0])) / sets
    reach = _reach((radical_inverse(index, 2) + shift[1]) % 1, falloff)
    result = np.stack([reach, offset], axis=1).astype(np.float32)
    result.flags.writeable = False
    return result


def _reach(uniform: np.ndarray, falloff: float) -> np.ndarray:
    """Distances, in radii, from numbers in [0, 1): an occluder at d is within one with probability `influence(d²)`."""
    # the inverse of smoothstep: t² (3 - 2t) = y at t = 1/2 - sin(asin(1 - 2y) / 3)
    faded = 0.5 - np.sin(np.arcsin(1 - 2 * uniform) / 3)
    return 1 - falloff + falloff * faded


@lru_cache(maxsize=64)
def disc(count: int, seed: int) -> np.ndarray:
    """Samples of the unit disc, more of them near its centre: (count, 4) float32 of x, y, the share of the disc, 0.

    The radius is uniform, so that the density falls with 1/r (Dachsbacher and Stamminger 2005, section 4.1), and the
    share is 2 r / N: the shares add up to 1. Hammersley points, shifted as a whole by a vector from `seed`.
    """
    index = np.arange(count)
    shift = np.random.default_rng(seed).random(2)
    radius = (index + (0.5 if seed == 0 else shift[0])) / count
    angle = 2 * np.pi * (radical_inverse(index, 2) + shift[1])
    samples = np.stack([radius * np.cos(angle), radius * np.sin(angle), 2 * radius / count, 0 * radius], axis=1)
    samples = samples.astype(np.float32)
    samples.flags.writeable = False
    return samples


def line_start(seed: int) -> np.ndarray:
    """The rotated kernel of a seed, as glsl/lib/line.glsl reads it: (3,) float32.

    The unit direction of the first of 16 angles, and the shift of the first samples, in [0, 1). Over many seeds, every
    pixel looks in all directions.
    """
    shift = np.random.default_rng(seed).random(2)
    angle = 2 * np.pi * shift[1]
    return np.array([np.cos(angle), np.sin(angle), 0.0 if seed == 0 else shift[0]], np.float32)


def influence(squared_distance: np.ndarray, falloff: float) -> np.ndarray:
    """The weight of an occluder, in [0, 1], at `squared_distance` in squared radii.

    The weight fades by a smoothstep over the outer share `falloff` of the radius, as in SSDO near the border of the
    hemisphere (Ritschel, Grosch and Seidel 2009, section 7.2). With a falloff of 0 the weight steps from 1 to 0 at the
    radius.
    """
    width = max(falloff, 1e-4)
    t = np.clip((np.sqrt(squared_distance) - (1 - width)) / width, 0, 1)
    return 1 - t * t * (3 - 2 * t)


@lru_cache(maxsize=256)
def uniform_cone(count: int, seed: int, spread: float = 1.0) -> np.ndarray:
    """Directions of uniform density in a cone around +z: (count, 4) float32, unit xyz, and w, an offset in [0, 1).

    `spread` in (0, 1] is the cone's half-angle in right angles. The points are those of `cosine_hemisphere`.
    """
    index = np.arange(count)
    shift = np.random.default_rng(seed).random(3)
    elevation = (index + (0.5 if seed == 0 else shift[0])) / count
    azimuth = 2 * np.pi * (radical_inverse(index, 2) + shift[1])
    offset = (radical_inverse(index, 3) + shift[2]) % 1
    z = 1 - elevation * (1 - np.cos(spread * np.pi / 2))
    r = np.sqrt(np.maximum(0, 1 - z * z))
    kernel = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z, offset], axis=1).astype(np.float32)
    kernel.flags.writeable = False
    return kernel
