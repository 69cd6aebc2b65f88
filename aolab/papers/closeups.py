"""Overviews and close-ups of a large picture; pictures of the truth's light."""

import numpy as np
from PIL import Image

from ..gl.texture import Size
from ..pipeline.frame import Frame
from ..truth.picture import over_environment, shown
from .pixels import view_of

ZOOM = 3  # a picture with close-ups is rendered at this multiple of the size at which it is shown


def zoomed(size: Size) -> Size:
    """The size of the render, if its overview and its close-ups are shown at `size`."""
    return ZOOM * size[0], ZOOM * size[1]


def overview(picture: np.ndarray) -> np.ndarray:
    """A render of `zoomed` size, (H, W, 3) uint8, reduced to the size at which it is shown."""
    return np.asarray(Image.fromarray(picture).reduce(ZOOM))


def closeup(picture: np.ndarray, middle: tuple[float, float]) -> np.ndarray:
    """A part of a render of `zoomed` size, (H, W, 3) uint8, without any change of its pixels.

    It is as large as the `overview`. `middle`: x, y as shares of the render's sides.
    """
    height, width = (side // ZOOM for side in picture.shape[:2])
    left, top = (
        int(np.clip(share * side - part / 2, 0, side - part))
        for share, side, part in zip(middle, picture.shape[1::-1], (width, height), strict=True)
    )
    return picture[top : top + height, left : left + width]


def over_background(radiance: np.ndarray, truth: Frame) -> np.ndarray:
    """`radiance` (H, W, 3) of the truth's surfaces, over its environment, as an image (H, W, 3) uint8."""
    assert truth.scene is not None  # the reference has one
    assert truth.scene.environment is not None  # Scene fills it in
    return shown(over_environment(radiance, truth.mask, truth.scene.environment, view_of(truth)))
