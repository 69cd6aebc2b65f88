"""Real spherical harmonics, bands 0 to 3: the NumPy twin of `glsl/lib/sh.glsl`.

The basis is the one listed by Sloan 2008, "Stupid Spherical Harmonics (SH) Tricks", appendix A2: orthonormal over the
sphere, with the Condon-Shortley sign, so that odd m is negative: y_1^-1 = -√(3/4π) y, y_1^0 = √(3/4π) z,
y_1^1 = -√(3/4π) x. Coefficient i = l (l + 1) + m holds band l, order m. The polynomials' z is the world's z.
"""

import numpy as np

MAX_BANDS = 4

# Ramamoorthi & Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps", eq. 8: the clamped cosine
COSINE_BANDS = (np.pi, 2 * np.pi / 3, np.pi / 4, 0.0)


def basis(directions: np.ndarray, bands: int = 3) -> np.ndarray:
    """y_i at unit `directions` (..., 3): (..., bands²) float64; `bands` in [1, 4], else ValueError."""
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

    `values` (n, C) at unit `directions` (n, 3), each standing for `solid_angles` (n,) steradians, which add up to 4π.
    The mean is projected analytically and only the deviation from it by summation: a constant comes out exact.
    """
    values = np.asarray(values, np.float64)
    mean = solid_angles @ values / solid_angles.sum()
    coefficients = (basis(directions, bands) * solid_angles[:, None]).T @ (values - mean)
    coefficients[0] += mean * np.sqrt(4 * np.pi)
    return coefficients


def evaluate(coefficients: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Σ c_i y_i at unit `directions` (..., 3): (..., C) for `coefficients` (bands², C)."""
    return basis(directions, round(np.sqrt(len(coefficients)))) @ coefficients


def irradiance(coefficients: np.ndarray) -> np.ndarray:
    """Radiance coefficients (bands², ...) to those of the irradiance on a surface facing each direction.

    The convolution with the clamped cosine scales band l by A_l (Ramamoorthi & Hanrahan 2001, eq. 8).
    """
    coefficients = np.asarray(coefficients, np.float64)
    bands = round(np.sqrt(len(coefficients)))
    scale = np.repeat(COSINE_BANDS[:bands], [2 * band + 1 for band in range(bands)])
    return coefficients * scale.reshape(-1, *[1] * (coefficients.ndim - 1))
