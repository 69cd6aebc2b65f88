"""The numbers: the differences of a region's pixels, summed up."""

import math
from dataclasses import dataclass

import numpy as np

NAN = float("nan")
WORST = 0.01  # of the pixels: those that `trimmed` leaves out, at least one


@dataclass(frozen=True)
class Measures:
    """The measures of one region; NaN where a measure has no meaning, or the region has no pixel.

    Of the values' differences, result - reference, over all pixels and channels: `rmse`, `bias` (their mean), `mae`
    (mean of the magnitudes), `p50`, `p90`, `p99` (percentiles of the magnitudes) and `maximum`. A few pixels may make
    most of the RMSE: `trimmed` is the RMSE without the 1 % of the pixels that err most, and `outliers` is the share
    of these pixels in the sum of squares. `noise` is the root mean square of the reference's standard error.
    Of the pictures (`Kind.picture`): `psnr` (decibels, infinite for equal pictures), `ssim`, `flip`.
    Of directions: `angle`, mean, and `angle_p90`, in degrees.
    """

    pixels: int
    rmse: float = NAN
    trimmed: float = NAN
    outliers: float = NAN
    noise: float = NAN
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
    """The measures of differences (..., channels) or (pixels,), not empty: those from `rmse` to `maximum`."""
    difference = np.asarray(difference, np.float64)
    magnitude = np.abs(difference)
    p50, p90, p99 = np.percentile(magnitude, (50, 90, 99))
    squares = np.sort((difference**2).mean(axis=-1).ravel() if difference.ndim > 1 else difference**2)
    worst = math.ceil(WORST * len(squares))
    return {
        "rmse": float(np.sqrt(squares.mean())),
        "trimmed": float(np.sqrt(squares[:-worst].mean())) if worst < len(squares) else NAN,
        "outliers": float(squares[-worst:].sum() / squares.sum()) if squares[-1] > 0 else 0.0,
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
