"""Directions over the hemisphere: cosine-distributed, stratified, two a stratum, so that their own error is known."""

import math
from collections.abc import Iterator

import numpy as np

from ..errors import ParameterError


class Stratum:
    """A cell of the unit square; both samples of a pair come from it."""

    def __init__(self, low: tuple[float, float], size: tuple[float, float]) -> None:
        self.low, self.size = low, size

    def square(self, count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        """Two coordinates (count,) float32, uniform in the cell."""
        u, v = random.random((2, count), np.float32)
        return tuple(
            np.float32(low) + np.float32(size) * x for low, size, x in zip(self.low, self.size, (u, v), strict=True)
        )

    def directions(self, frames: np.ndarray, random: np.random.Generator, covered: float = 1.0) -> np.ndarray:
        """(n, 3) float32 unit directions by Malley's method, around `frames` (3, n, 3): tangent, bitangent, normal.

        `covered` is sin² of the half-angle of the cone that they fill; 1 is the hemisphere.
        """
        elevation, turn = self.square(frames.shape[1], random)
        elevation *= np.float32(covered)
        azimuth = np.float32(2 * np.pi) * turn
        r = np.sqrt(elevation)
        up = np.sqrt(np.maximum(1 - elevation, 0))
        directions = (r * np.cos(azimuth))[:, None] * frames[0]
        directions += (r * np.sin(azimuth))[:, None] * frames[1]
        directions += up[:, None] * frames[2]
        return directions


WHOLE = Stratum((0.0, 0.0), (1.0, 1.0))


def covered_by(spread: float) -> float:
    """sin² of the half-angle of a cone, `spread` in right angles: the share of ∫ cosθ dω that the cone holds."""
    return math.sin(spread * math.pi / 2) ** 2


def strata(samples: int) -> Iterator[Stratum]:
    """`samples` / 2 cells of equal area, as square as the number allows: powers of two are best.

    Raises `ParameterError` unless `samples` is even and at least 2.
    """
    if not isinstance(samples, int) or samples < 2 or samples % 2:
        raise ParameterError(f"rays = {samples!r} is not an even whole number from 2 on (two a stratum)")
    cells = samples // 2
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
