"""From linear radiance to pixels: the NumPy twin of glsl/lib/color.glsl."""

import numpy as np


def srgb(linear: np.ndarray) -> np.ndarray:
    """sRGB uint8 of `linear` values of any shape, which are clipped to [0, 1] (IEC 61966-2-1)."""
    linear = np.clip(linear, 0, 1)
    encoded = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.round(encoded * 255).astype(np.uint8)


def shown(radiance: np.ndarray) -> np.ndarray:
    """(H, W, 3) uint8 sRGB: the filmic curve at exposure 1, the default of renders."""
    return srgb(radiance * (2.51 * radiance + 0.03) / (radiance * (2.43 * radiance + 0.59) + 0.14))
