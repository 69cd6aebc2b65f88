"""The numbers: differences of pixels, summed up over a region."""

from dataclasses import dataclass

import numpy as np

NAN = float("nan")


@dataclass(frozen=True)
class Measures:
    """What a region's pixels say; NaN where a measure has no meaning, or the region no pixel.

    Of the values' differences, result - reference, over all pixels and channels: `rmse`, `bias` (their mean), `mae`
    (mean of the magnitudes), `p50`, `p90`, `p99` (percentiles of the magnitudes) and `maximum`.
    Of the pictures (`Kind.picture`): `psnr` (decibels, infinite for equal ones), `ssim`, `flip`.
    Of directions: `angle`, mean, and `angle_p90`, in degrees.
    """

    pixels: int
    rmse: float = NAN
    bias: float = NAN
    mae: float = NAN
    p50: float = NAN
    p90: float = NAN
    p99: float = NAN
    maximum: float = NAN
    psnr: float = NAN
    ssim: float = NAN
    flip: float = NAN
    angle: float = NAN
    angle_p90: float = NAN


def differences(difference: np.ndarray) -> dict[str, float]:
    """rmse, bias, mae, percentiles and maximum of differences of any shape, not empty."""
    difference = np.asarray(difference, np.float64)
    magnitude = np.abs(difference)
    p50, p90, p99 = np.percentile(magnitude, (50, 90, 99))
    return {
        "rmse": float(np.sqrt(np.mean(difference**2))),
        "bias": float(difference.mean()),
        "mae": float(magnitude.mean()),
        "p50": float(p50),
        "p90": float(p90),
        "p99": float(p99),
        "maximum": float(magnitude.max()),
    }


def psnr(difference: np.ndarray) -> float:
    """Peak signal to noise ratio in decibels, of pictures in [0, 1]; infinite where there is no difference."""
    mean_square = float(np.mean(np.asarray(difference, np.float64) ** 2))
    return float("inf") if mean_square == 0 else float(-10 * np.log10(mean_square))


def angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(...): degrees between vectors (..., 3) of any length; NaN where one of them is 0."""
    a, b = np.asarray(a, np.float64), np.asarray(b, np.float64)
    across, along = np.linalg.norm(np.cross(a, b), axis=-1), (a * b).sum(axis=-1)
    degrees = np.degrees(np.arctan2(across, along))  # the arc cosine is blind below 0.02° in float32
    return np.where((a**2).sum(axis=-1) * (b**2).sum(axis=-1) > 0, degrees, np.nan)
