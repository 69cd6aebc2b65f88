"""What a reproduced figure is: a picture, the numbers behind the paper's claim, and whether they hold it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image

from ..frame import Frame
from ..truth.points import pixel_rays
from ..view import View


@dataclass(frozen=True, eq=False)
class Figure:
    """`numbers` are plain values for JSON; `claim` is the paper's, in a sentence that they can hold or refute."""

    picture: Image.Image
    numbers: dict[str, Any]
    claim: str
    holds: bool


def rmse(one: np.ndarray, other: np.ndarray, where: np.ndarray) -> float:
    """Root mean square difference of two (H, W[, channels]) arrays over the pixels `where` (H, W)."""
    return float(np.sqrt(np.mean((one - other)[where] ** 2)))


def world_positions(frame: Frame, view: View) -> np.ndarray:
    """(H, W, 3): the surface at each pixel's centre; the eye where nothing was drawn. `view`: what `frame` shows."""
    world_from_view = np.linalg.inv(view.camera.view_from_world)
    width, height = view.size
    rays = pixel_rays(view, np.arange(width * height)).reshape(height, width, 3)
    depth = np.where(frame.mask, -frame["viewZ"], 0)
    return rays * depth[..., None] @ world_from_view[:3, :3].T + world_from_view[:3, 3]
