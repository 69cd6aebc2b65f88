"""Directions over the hemisphere: cosine-distributed, stratified, two a stratum, so that their own error is known."""

import math
from collections.abc import Iterator

import numpy as np

from ..errors import ParameterError


class Stratum:
    """A cell of the unit square that Malley's method maps to the hemisphere; both of its directions come from it."""

    def __init__(self, low: tuple[float, float], size: tuple[float, float]) -> None:
        self.low, self.size = low, size

    def directions(self, frames: np.ndarray, random: np.random.Generator) -> np.ndarray:
        """(n, 3) float32 unit directions, one around each of `frames` (3, n, 3): tangent, bitangent, normal."""
        u, v = random.random((2, frames.shape[1]), np.float32)
        elevation = np.float32(self.low[0]) + np.float32(self.size[0]) * u
        azimuth = np.float32(2 * np.pi) * (np.float32(self.low[1]) + np.float32(self.size[1]) * v)
        r = np.sqrt(elevation)
        up = np.sqrt(np.maximum(1 - elevation, 0))
        directions = (r * np.cos(azimuth))[:, None] * frames[0]
        directions += (r * np.sin(azimuth))[:, None] * frames[1]
        directions += up[:, None] * frames[2]
        return directions


def strata(rays: int) -> Iterator[Stratum]:
    """`rays` / 2 cells of equal area, as square as the number allows: powers of two are best.

    Two independent directions in each: the mean is unbiased, and so is the variance estimated from their differences,
    Σ (a - b)² / rays² (the two-per-stratum design: Cochran 1977, Sampling Techniques, section 5A).
    Raises `ParameterError` unless `rays` is even and at least 2.
    """
    if not isinstance(rays, int) or rays < 2 or rays % 2:
        raise ParameterError(f"rays = {rays!r} is not an even whole number from 2 on (two a stratum)")
    cells = rays // 2
    # on the disc a cell at 2/3 of the radius is square when there are about four times more sectors than rings; twice
    # as many is a compromise with the horizon, where occluders mostly stand
    rings = max(k for k in range(1, math.isqrt(cells) + 1) if cells % k == 0 and (k == 1 or 2 * k * k <= cells))
    sectors = cells // rings
    for i in range(cells):
        yield Stratum((i // sectors / rings, i % sectors / sectors), (1 / rings, 1 / sectors))


def frames(normals: np.ndarray) -> np.ndarray:
    """(3, n, 3) float32: tangent, bitangent and normal for unit `normals` (n, 3).

    Duff et al. 2017, "Building an Orthonormal Basis, Revisited", as in glsl/lib/sampling.glsl.
    """
    x, y, z = np.asarray(normals, np.float32).T
    sign = np.where(z >= 0, np.float32(1), np.float32(-1))
    a = -1 / (sign + z)
    b = x * y * a
    tangent = np.stack([1 + sign * x * x * a, sign * b, -sign * x], axis=1)
    bitangent = np.stack([b, sign + y * y * a, -y], axis=1)
    return np.stack([tangent, bitangent, np.stack([x, y, z], axis=1)])
