"""From buffers at points to pictures: the NumPy twins of glsl/lib/color.glsl and glsl/pipeline/compose.frag."""

import numpy as np

from ..pictures.tone import shown as shown
from ..scene.environment import Environment
from ..scene.view import View
from .points import window
from .sky import environment_radiance


def spread(values: np.ndarray, pixel: np.ndarray, view: View, background: float) -> np.ndarray:
    """(H, W) or (H, W, channels): `values` (n, channels) at the row-major indices `pixel`."""
    width, height = view.size
    image = np.full((height * width, values.shape[1]), background, np.float32)
    image[pixel] = values
    return image.reshape(height, width, -1) if values.shape[1] > 1 else image.reshape(height, width)


def over_environment(radiance: np.ndarray, mask: np.ndarray, environment: Environment, view: View) -> np.ndarray:
    """(H, W, 3): `radiance`, with the environment where `mask` is False."""
    behind = view.sights(window(view, np.flatnonzero(~mask))) @ view.camera.view_from_world[:3, :3]
    result = radiance.copy()
    result[~mask] = environment_radiance(environment, behind)
    return result
