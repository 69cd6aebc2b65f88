"""How different two pictures look: structural similarity and FLIP, each as a map."""

import math

import numpy as np

from ..extras import need

_C1, _C2 = 0.01**2, 0.03**2  # Wang et al. 2004, section III-C: K1 and K2 for a range of 1
_SIGMA, _TRUNCATE = 1.5, 3.5  # its window, 11 × 11: 3.5 sigma reach 5 pixels

# The tone curve of HDR-FLIP (Andersson et al. 2021): an approximation of ACES, x(ax + b) / (x(cx + d) + e)
_ACES = 0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14
_BRIGHT = 0.85  # exposures put the reference's highest and median luminance there (its section 3)
_REC_709 = np.array([0.2126, 0.7152, 0.0722])
_STOPS = 8.0  # at most: the median of a mostly black image is arbitrary, and each stop costs a whole FLIP


def ssim_map(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(H, W): structural similarity of pictures (H, W, C) in [0, 1], the mean of the channels; 1 where they are equal.

    Wang et al. 2004, eq. 13, in a Gaussian window; at the image's edge the picture is mirrored.
    """
    from scipy.ndimage import gaussian_filter  # its import takes 0.3 s

    def mean(picture: np.ndarray) -> np.ndarray:
        return gaussian_filter(picture, (_SIGMA, _SIGMA, 0), truncate=_TRUNCATE)

    a, b = a.astype(np.float64), b.astype(np.float64)
    mean_a, mean_b = mean(a), mean(b)
    variance_a, variance_b = mean(a * a) - mean_a**2, mean(b * b) - mean_b**2
    covariance = mean(a * b) - mean_a * mean_b
    likeness = (2 * mean_a * mean_b + _C1) * (2 * covariance + _C2)
    return (likeness / ((mean_a**2 + mean_b**2 + _C1) * (variance_a + variance_b + _C2))).mean(axis=2)


def flip_map(a: np.ndarray, b: np.ndarray, *, hdr: bool) -> np.ndarray:
    """(H, W) in [0, 1]: FLIP of the test picture `a` against the reference `b`, (H, W, 1 or 3), at 67 pixels a degree.

    LDR-FLIP (Andersson et al. 2020) compares sRGB in [0, 1]. HDR-FLIP (2021) compares linear radiance from 0 on, and is
    the greatest difference over a range of exposures.
    """
    flip_evaluator = need("flip", ", or flip=False")
    test, reference = (
        np.ascontiguousarray(np.broadcast_to(one, (*one.shape[:2], 3)), np.float32) for one in (a, b)
    )  # fmt: skip
    settings = exposures(reference) if hdr else {}
    result = flip_evaluator.evaluate(
        reference, test, "HDR" if hdr else "LDR", applyMagma=False, computeMeanError=False, parameters=settings
    )
    return result[0][..., 0]


def exposures(reference: np.ndarray) -> dict[str, float | int]:
    """HDR-FLIP's range of exposures, its own rule, for linear (H, W, 3).

    flip-evaluator ends the process for a black reference, and its number of stops is unbounded; here it is bounded.
    """
    luminance = reference @ _REC_709
    highest = float(luminance.max())
    if not highest > 0:
        return {"startExposure": 0.0, "stopExposure": 0.0, "numExposures": 2}
    median = max(float(np.median(luminance)), highest / 2**_STOPS)
    a, b, c, d, e = _ACES
    a, b, c = a - _BRIGHT * c, b - _BRIGHT * d, -_BRIGHT * e
    white = (-b + math.sqrt(b * b - 4 * a * c)) / (2 * a)  # the luminance that is displayed as _BRIGHT
    start, stop = math.log2(white / highest), math.log2(white / median)
    return {"startExposure": start, "stopExposure": stop, "numExposures": max(2, math.ceil(stop - start))}
