"""More rays where the error is: the number of batches that each pixel needs to meet a target."""

import numpy as np

from .buffers import BUFFERS
from .moments import Moments
from .picture import spread
from .points import Surface

MOST_BATCHES = 16  # of `rays` each, a pixel: a quarter of the first batch's error
NEIGHBOURS = 5  # pixels: the side of the square whose other pixels decide


def batches_needed(surface: Surface, moments: Moments, wanted: list[str], target: float) -> np.ndarray:
    """(n,): batches, the first one included, that bring the standard error around each point to `target`.

    `target` is relative to the buffer's root mean square over the image. The variance of a mean falls as 1 / batches.
    Only the samples of a point's neighbours on the screen decide. Its own must not: a point whose first samples happen
    to agree would stop early, and the mean over all points would be biased (Kirk and Arvo 1991, Unbiased Sampling
    Techniques for Image Synthesis).
    """
    needed = np.ones(len(surface))
    for name in wanted:
        buffer = BUFFERS[name]
        allowed = (target * root_mean_square(buffer.value(moments, surface.albedo))) ** 2
        if allowed > 0:
            variance = buffer.variance(moments, surface.albedo).mean(axis=1, keepdims=True)
            around = _mean_of_others(spread(variance, surface.pixel, surface.view, np.nan))
            needed = np.maximum(needed, np.ceil(around.reshape(-1)[surface.pixel] / allowed))
    return np.clip(needed, 1, MOST_BATCHES).astype(int)


def root_mean_square(values: np.ndarray) -> float:
    """Over all of `values` (n, channels)."""
    return float(np.sqrt(np.mean(np.square(values, dtype=np.float64)))) if values.size else 0.0


def _mean_of_others(image: np.ndarray) -> np.ndarray:
    """(H, W): the mean of `image` over the square around each pixel, without the pixel; NaN values do not count."""
    from scipy.ndimage import uniform_filter  # its import takes 0.3 s

    known = np.isfinite(image)
    cells = NEIGHBOURS**2
    total = uniform_filter(np.where(known, image, 0), NEIGHBOURS, mode="constant") * cells - np.where(known, image, 0)
    count = np.rint(uniform_filter(known.astype(np.float64), NEIGHBOURS, mode="constant") * cells) - known
    everywhere = image[known].mean() if known.any() else 0.0
    return np.where(count > 0, np.maximum(total, 0) / np.maximum(count, 1), everywhere)
