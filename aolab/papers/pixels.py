"""Measures over pixels, and the positions of pixels in the scene."""

from collections.abc import Sequence

import numpy as np

from ..pipeline.frame import Frame
from ..scene.view import View
from ..truth.points import window

LUMINANCE = np.array((0.2126, 0.7152, 0.0722))  # of linear sRGB (ITU-R BT.709)


def rmse(one: np.ndarray, other: np.ndarray, where: np.ndarray) -> float:
    """Root mean square difference of two (H, W[, channels]) arrays over the pixels `where` (H, W)."""
    return float(np.sqrt(np.mean((one - other)[where] ** 2)))


def noise(draws: Sequence[np.ndarray], where: np.ndarray) -> float:
    """Relative noise: the standard deviation among `draws`, divided by their mean, over the pixels `where` (H, W).

    `draws`: (H, W[, channels]), each with another seed.
    """
    seen = np.array([draw[where] for draw in draws], np.float64)
    return float(np.sqrt(seen.var(axis=0, ddof=1).mean()) / seen.mean())


def chromaticity(rgb: np.ndarray) -> np.ndarray:
    """(..., 3): the shares of red, green and blue."""
    return rgb / np.maximum(rgb.sum(axis=-1, keepdims=True), 1e-12)


def world_positions(frame: Frame) -> np.ndarray:
    """(H, W, 3): the surface at each pixel's centre, world space; the eye at background pixels."""
    view = view_of(frame)
    world_from_view = np.linalg.inv(view.camera.view_from_world)
    width, height = view.size
    pixels = window(view, np.arange(width * height)).reshape(height, width, 2)
    positions = view.positions(pixels, np.where(frame.mask, frame["viewZ"], 0))
    return positions @ world_from_view[:3, :3].T + world_from_view[:3, 3]


def pixel_at(frame: Frame, point: Sequence[float]) -> tuple[int, int]:
    """(column, row) of the pixel that shows the surface nearest to the world-space `point`."""
    distance = np.linalg.norm(world_positions(frame) - np.asarray(point), axis=-1)
    row, column = np.unravel_index(np.where(frame.mask, distance, np.inf).argmin(), distance.shape)
    return int(column), int(row)


def view_of(frame: Frame) -> View:
    assert frame.scene is not None  # it was rendered
    return View(frame.camera, frame.size, frame.scene.bounds)
