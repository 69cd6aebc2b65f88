"""Flicker: how much a surface changes from frame to frame while the camera moves."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import map_coordinates

from ..errors import ParameterError
from ..pipeline.frame import Frame
from ..scene.camera import Camera
from ..scene.view import View
from .regions import nearness

# A point counts as seen if the frame before shows a surface at its distance, within this share. Half or twice as much
# changes the mean flicker of SSAO by 1 to 4 % on five scenes at 320×180, and on `atrium`, of thin parts, by 14 %.
SAME_SURFACE = 0.01


@dataclass(frozen=True)
class Flicker:
    """`mean` and `p99` of |now - before| at the same points of surfaces, in the buffer's unit.

    `seen` is the share of the surface pixels, of all frames but the first, whose point is visible in the frame before.
    """

    mean: float
    p99: float
    seen: float


def flicker(frames: Sequence[Frame], buffer: str = "visibility") -> Flicker:
    """Mean temporal difference after re-projection, of consecutive frames with their own cameras.

    Each surface pixel is projected into the frame before, by `viewZ` and the two cameras. If the pixels there show the
    same surface, their values are interpolated bilinearly and compared. Objects must not move. Shading that depends on
    the camera, such as occlusion by surfaces that enter the screen, counts as flicker too.
    Raises `ParameterError` for fewer than two frames, or frames of different sizes.
    """
    if len(frames) < 2:
        raise ParameterError(f"flicker compares consecutive frames; {len(frames)} given, at least 2 needed")
    sizes = sorted({frame.size for frame in frames})
    if len(sizes) > 1:
        raise ParameterError(f"flicker: frames differ in size: {', '.join(f'{w}x{h}' for w, h in sizes)}")
    differences = [_difference(before, now, buffer) for before, now in pairwise(frames)]
    found = np.concatenate(differences)
    if not len(found):
        raise ParameterError("flicker: no surface is seen in two consecutive frames")
    surface = sum(int(frame.mask.sum()) for frame in frames[1:])
    return Flicker(float(found.mean()), float(np.percentile(found, 99)), len(found) / surface)


def _difference(before: Frame, now: Frame, buffer: str) -> np.ndarray:
    """(n,): mean over channels of |now - before|, at the pixels of `now` whose points `before` shows."""
    width, height = now.size
    here, there = (Camera(**frame.info["camera"]) for frame in (now, before))
    here_view, there_view = (View(camera, now.size, np.zeros((2, 3))) for camera in (here, there))  # clips nothing
    rows, columns = np.nonzero(now.mask)
    pixels = np.stack([columns + 0.5, height - rows - 0.5], axis=-1)
    here_pos = here_view.positions(pixels, now["viewZ"][rows, columns])
    there_from_here = there.view_from_world @ np.linalg.inv(here.view_from_world)
    there_pos = here_pos @ there_from_here[:3, :3].T + there_from_here[:3, 3]

    x, y = there_view.pixels(there_pos).T
    column, row = x - 0.5, height - 0.5 - y
    there_pos, distance = there_pos.T, np.maximum(-there_pos[:, 2], 1e-20)
    # with a still camera each pixel is its own: rounding must not fetch a neighbour across an edge
    column, row = (np.where(np.abs(at - np.rint(at)) < 1e-4, np.rint(at), at) for at in (column, row))
    inside = (there_pos[2] < 0) & (column >= 0) & (row >= 0) & (column <= width - 1) & (row <= height - 1)
    # nearness is linear over the image of a plane, so that interpolation keeps it on the surface
    found = _bilinear(nearness(before["viewZ"]), np.where(inside, row, 0), np.where(inside, column, 0))
    seen = inside & (np.abs(found * distance - 1) <= SAME_SURFACE)

    values = [frame[buffer].astype(np.float64).reshape(height, width, -1) for frame in (before, now)]
    known = np.nan_to_num(values[0])  # NaN in the background, whose weight is negligible here
    old = np.stack([_bilinear(one, row[seen], column[seen]) for one in np.moveaxis(known, -1, 0)], axis=-1)
    return np.abs(values[1][rows[seen], columns[seen]] - old).mean(axis=-1)


def _bilinear(values: np.ndarray, row: np.ndarray, column: np.ndarray) -> np.ndarray:
    return map_coordinates(values, np.stack([row, column]), order=1, mode="nearest")
