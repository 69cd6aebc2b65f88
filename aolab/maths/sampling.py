"""Sample sets: low-discrepancy, stratified, seeded."""

from functools import lru_cache

import numpy as np


def radical_inverse(indices: np.ndarray, base: int) -> np.ndarray:
    """Van der Corput's sequence: the digits of `indices` in `base`, mirrored at the point; float64 in [0, 1)."""
    result, digit_value, rest = np.zeros(len(indices)), 1.0 / base, indices.copy()
    while rest.any():
        result += digit_value * (rest % base)
        rest //= base
        digit_value /= base
    return result


@lru_cache(maxsize=256)
def cosine_hemisphere(count: int, seed: int, falloff: float = 0.0) -> np.ndarray:
    """Directions with density cosθ/π around +z, times their reach: (count, 4) float32, xyz and w, an offset in [0, 1).

    Hammersley points (strata in elevation, radical inverses in the other dimensions), moved as a whole by a random
    vector that `seed` decides (Cranley and Patterson 1976), mapped by Malley's method: r = √u, z = √(1 - u).
    The reach, in radii, is drawn so that an occluder at distance d is within it with the probability `influence(d²)`:
    the falloff costs the shader nothing.
    """
    index = np.arange(count)
    shift = np.random.default_rng(seed).random(4)
    # the first set is the sequence itself, with its points in the middle of their strata
    elevation = (index + (0.5 if seed == 0 else shift[0])) / count
    azimuth = 2 * np.pi * (radical_inverse(index, 2) + shift[1])
    offset = (radical_inverse(index, 3) + shift[2]) % 1
    # the inverse of smoothstep: t² (3 - 2t) = y at t = 1/2 - sin(asin(1 - 2y) / 3)
    faded = 0.5 - np.sin(np.arcsin(1 - 2 * ((radical_inverse(index, 5) + shift[3]) % 1)) / 3)
    reach = 1 - falloff + falloff * faded
    r = np.sqrt(elevation)
    direction = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), np.sqrt(1 - elevation)], axis=1)
    kernel = np.concatenate([direction * reach[:, None], offset[:, None]], axis=1).astype(np.float32)
    kernel.flags.writeable = False
    return kernel


def influence(squared_distance: np.ndarray, falloff: float) -> np.ndarray:
    """How much an occluder counts, in [0, 1], at `squared_distance` in squared radii.

    It fades by a smoothstep over the outer share `falloff` of the radius, as SSDO's occluders do near the hemisphere's
    border (Ritschel, Grosch and Seidel 2009, section 7.2); 0 is a hard edge: occlusion within a radius.
    """
    width = max(falloff, 1e-4)
    t = np.clip((np.sqrt(squared_distance) - (1 - width)) / width, 0, 1)
    return 1 - t * t * (3 - 2 * t)
