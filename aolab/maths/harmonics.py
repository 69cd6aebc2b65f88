"""Real spherical harmonics, bands 0 to 3: the NumPy twin of `glsl/lib/sh.glsl` and its neighbours.

The basis is listed by Sloan 2008, "Stupid Spherical Harmonics (SH) Tricks", appendix A2. It is orthonormal over the
sphere and has the Condon-Shortley sign, so that basis functions of odd m are negative: y_1^-1 = -√(3/4π) y,
y_1^0 = √(3/4π) z, y_1^1 = -√(3/4π) x. Coefficient i = l (l + 1) + m belongs to band l, order m. The z of the
polynomials is the world's z.

The coefficients are the last axis of an array, (..., bands²). Functions with C channels are the exception: `project`,
`evaluate` and `irradiance` use (bands², C).
"""

from collections.abc import Sequence
from functools import cache

import numpy as np

MAX_BANDS = 4

# A_l, the clamped cosine (Ramamoorthi & Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps",
# eq. 8)
COSINE_BANDS = np.array([np.pi, 2 * np.pi / 3, np.pi / 4, 0.0])

# Sloan 2008: a zonal coefficient times this is the factor of y_lm(d)
ZONAL_BANDS = np.sqrt(4 * np.pi / np.array([1, 3, 5, 7]))


def basis(directions: np.ndarray, bands: int = 3) -> np.ndarray:
    """Basis functions y_i at unit `directions` (..., 3): (..., bands²) float64. ValueError if `bands` is not 1 to 4."""
    if not 1 <= bands <= MAX_BANDS:
        raise ValueError(f"bands = {bands} is outside [1, {MAX_BANDS}]")
    x, y, z = np.moveaxis(np.asarray(directions, np.float64), -1, 0)
    rows = [np.full_like(x, np.sqrt(1 / (4 * np.pi)))]
    if bands > 1:
        k = np.sqrt(3 / (4 * np.pi))
        rows += [-k * y, k * z, -k * x]
    if bands > 2:
        k, k0 = np.sqrt(15 / (4 * np.pi)), np.sqrt(5 / (16 * np.pi))
        rows += [k * x * y, -k * y * z, k0 * (3 * z * z - 1), -k * x * z, k / 2 * (x * x - y * y)]
    if bands > 3:
        k3, k2, k1, k0 = np.sqrt(np.array([35 / 32, 105 / 4, 21 / 32, 7 / 16]) / np.pi)
        rows += [
            -k3 * y * (3 * x * x - y * y),
            k2 * x * y * z,
            -k1 * y * (5 * z * z - 1),
            k0 * z * (5 * z * z - 3),
            -k1 * x * (5 * z * z - 1),
            k2 / 2 * z * (x * x - y * y),
            -k3 * x * (x * x - 3 * y * y),
        ]
    return np.stack(rows, axis=-1)


def project(values: np.ndarray, directions: np.ndarray, solid_angles: np.ndarray, bands: int = 3) -> np.ndarray:
    """Coefficients (bands², C) of a function sampled over the whole sphere.

    `values` (n, C) are samples at unit `directions` (n, 3). Each sample covers `solid_angles` (n,) steradians; their
    sum is 4π. The mean is projected analytically, and only the deviation is summed: a constant is projected exactly.
    """
    values = np.asarray(values, np.float64)
    mean = solid_angles @ values / solid_angles.sum()
    coefficients = (basis(directions, bands) * solid_angles[:, None]).T @ (values - mean)
    coefficients[0] += mean * np.sqrt(4 * np.pi)
    return coefficients


def evaluate(coefficients: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """The function Σ c_i y_i at unit `directions` (..., 3), with `coefficients` (bands², C). Returns (..., C)."""
    return basis(directions, round(np.sqrt(len(coefficients)))) @ coefficients


def irradiance(coefficients: np.ndarray) -> np.ndarray:
    """Coefficients of the irradiance, as a function of the surface normal, from those of the radiance: (bands², ...).

    The convolution with the clamped cosine scales band l by A_l (Ramamoorthi & Hanrahan 2001, eq. 8).
    """
    coefficients = np.asarray(coefficients, np.float64)
    bands = round(np.sqrt(len(coefficients)))
    return window(coefficients.T, COSINE_BANDS[:bands]).T


def window(coefficients: np.ndarray, weights: np.ndarray | Sequence[float]) -> np.ndarray:
    """`coefficients` (..., bands²) with band l multiplied by `weights[..., l]`: (..., bands²).

    The last axis of `weights` has one entry per band. Raises ValueError if it does not fit the coefficients.
    """
    coefficients, weights = np.asarray(coefficients, np.float64), np.asarray(weights, np.float64)
    bands = weights.shape[-1]
    if coefficients.shape[-1] != bands**2:
        raise ValueError(f"{bands} weights do not fit {coefficients.shape[-1]} coefficients")
    return coefficients * np.repeat(weights, [2 * band + 1 for band in range(bands)], axis=-1)


def zonal_lobe(zonal: np.ndarray | Sequence[float], directions: np.ndarray) -> np.ndarray:
    """A lobe around the z axis, rotated to each of the unit `directions` d (..., 3): (..., 16).

    `zonal` (..., 4) are the lobe's coefficients z_l of order 0: c_lm = √(4π / (2l + 1)) z_l y_lm(d) (Sloan 2008).
    """
    return window(basis(directions, MAX_BANDS), ZONAL_BANDS * np.asarray(zonal, np.float64))


def clamped_cosine(directions: np.ndarray) -> np.ndarray:
    """Coefficients (..., 16) of max(w·d, 0) as a function of w, for unit `directions` d (..., 3)."""
    return window(basis(directions, MAX_BANDS), COSINE_BANDS)


def hanning(width: float, bands: int = MAX_BANDS) -> np.ndarray:
    """Weights (bands,) of a Hann window against ringing, `width` > 0 in bands (Sloan 2008); else ValueError."""
    if not width > 0:
        raise ValueError(f"width = {width} is not above 0")
    band = np.arange(bands)
    return np.where(band < width, (1 + np.cos(np.pi * band / width)) / 2, 0)


def light_lobe(weights: np.ndarray | Sequence[float] = (1, 1, 1, 1)) -> np.ndarray:
    """Zonal coefficients (..., 4) of a light without size, windowed by `weights` (..., 4).

    The lobe is scaled so that an unoccluded surface facing the light receives irradiance 1 (Sloan 2008). Raises
    ValueError if the weights leave that surface dark: then no scale exists.
    """
    lobe = np.asarray(weights, np.float64) / ZONAL_BANDS  # a Dirac impulse: y_l0 at the pole
    facing = lobe @ (COSINE_BANDS / ZONAL_BANDS)
    if not np.all(facing > 0):
        raise ValueError(f"weights = {weights} leave the surface that faces the light dark")
    return lobe / facing[..., None]


# --- rotation and product, by quadrature over the sphere


@cache
def _quadrature() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Directions (n, 3) of Gauss-Legendre rings × azimuths, their solid angles (n,), and the basis there (n, 16).

    Exact up to degree 2·rings - 1 = 9: a product integral has three factors of degree 3.
    """
    rings = 5
    z, weights = np.polynomial.legendre.leggauss(rings)
    step = np.pi / rings
    azimuth, across = step * np.arange(2 * rings), np.sqrt(1 - z**2)[:, None]
    directions = np.broadcast_arrays(across * np.cos(azimuth), across * np.sin(azimuth), z[:, None])
    nodes = np.stack(directions, -1).reshape(-1, 3)
    return nodes, np.repeat(weights * step, 2 * rings), basis(nodes, MAX_BANDS)


def rotation(matrix: np.ndarray) -> np.ndarray:
    """The matrix D (..., 16, 16) that rotates coefficients by R = `matrix` (..., 3, 3): f'(w) = f(Rᵀw).

    D_ij = ∫ y_i(R u) y_j(u) du, block-diagonal up to rounding. Raises ValueError if `matrix` deviates from a rotation
    by more than 1e-5; float32 rounding stays below that.
    """
    matrix = np.asarray(matrix, np.float64)
    transposed = np.swapaxes(matrix, -1, -2)
    deviation = np.abs(matrix @ transposed - np.eye(3)).max()
    if not (deviation <= 1e-5 and np.all(np.linalg.det(matrix) > 0)):
        raise ValueError(f"matrix = {matrix.tolist()} is not a rotation")
    nodes, solid_angles, node_basis = _quadrature()
    turned = basis(nodes @ transposed, MAX_BANDS) * solid_angles[:, None]
    return np.swapaxes(turned, -1, -2) @ node_basis


def rotate(coefficients: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """`coefficients` (..., 16) of a function rotated by `matrix` (..., 3, 3); ValueError as in `rotation`."""
    return (rotation(matrix) @ np.asarray(coefficients, np.float64)[..., None])[..., 0]


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Coefficients (..., 16) of the product of two functions (..., 16), truncated to 4 bands."""
    _, solid_angles, node_basis = _quadrature()
    values = (a @ node_basis.T) * (b @ node_basis.T)
    return values * solid_angles @ node_basis
