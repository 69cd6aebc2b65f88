"""The picture of a pixel's samples: over the image, and in three dimensions."""

from typing import Any

import numpy as np
from PIL import Image

from ..extras import missing
from ..scene.view import View
from .replay import Samples

OPEN, BLOCKED = "#1f77b4", "#d95f02"
MOST = 64  # directions that are drawn
LEAST_CROP = 24  # pixels: half the side of the crop


def draw(seen: Any) -> Image.Image:
    """The picture of a `Microscope`: left, a crop of the image with the tested points; right, the points in space."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise missing("pictures", error) from error
    figure = Figure((10, 4.6), dpi=90, facecolor="#fafaf8")
    canvas = FigureCanvasAgg(figure)
    _over_the_image(figure.add_subplot(1, 2, 1), seen)
    _in_space(figure.add_subplot(1, 2, 2, projection="3d"), seen.sets[0])
    name, value = next(iter(seen.values.items()))
    figure.suptitle(
        f"{seen.frame.info['module']}, pixel {seen.pixel}: {name} {np.array2string(value, precision=3)}"
        f"; blue open, orange blocked, black: surfaces that block", fontsize=9,
    )  # fmt: skip
    figure.tight_layout()
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _over_the_image(axes, seen: Any) -> None:
    samples, frame = seen.sets[0], seen.frame
    column, row = seen.pixel
    points = _pixels(samples.points, frame)
    half = max(LEAST_CROP, 1.15 * float(np.abs(points - (column + 0.5, row + 0.5)).max()))
    axes.imshow(frame.image, extent=(0, frame.size[0], frame.size[1], 0), interpolation="nearest")
    for i in range(min(len(points), MOST)):
        color = OPEN if samples.open[i] else BLOCKED
        axes.plot(*np.vstack([(column + 0.5, row + 0.5), points[i]]).T, color=color, linewidth=0.7, alpha=0.6)
    shown = points[:MOST]
    axes.scatter(*shown[~samples.blocked[:MOST]].T, s=12, color=OPEN)
    axes.scatter(*shown[samples.blocked[:MOST]].T, s=12, color=BLOCKED)
    axes.plot(column + 0.5, row + 0.5, "o", markersize=7, markerfacecolor="white", markeredgecolor="black")
    axes.set(xlim=(column + 0.5 - half, column + 0.5 + half), ylim=(row + 0.5 + half, row + 0.5 - half))
    axes.set(xlabel="column", ylabel="row")


def _in_space(axes, samples: Samples) -> None:
    """View space: x to the right, y up, -z away from the eye, drawn as depth."""

    def turned(vectors: np.ndarray) -> np.ndarray:
        """matplotlib's vertical axis is z."""
        return np.stack([vectors[..., 0], -vectors[..., 2], vectors[..., 1]], axis=-1)

    start = turned(samples.receiver)
    reach = float(samples.reach.max())
    ends = samples.receiver + (samples.points[:, -1] - samples.receiver) / samples.along[:, -1:]
    for i, end in enumerate(turned(ends[:MOST])):
        color = OPEN if samples.open[i] else BLOCKED
        axes.plot(*np.stack([start, end]).T, color=color, linewidth=0.8, alpha=0.6)
    points, blocked = turned(samples.points[:MOST]), samples.blocked[:MOST]
    axes.scatter(*points[~blocked].T, s=10, color=OPEN)
    axes.scatter(*points[blocked].T, s=14, color=BLOCKED)
    occluders = turned(samples.occluders[:MOST])[blocked]
    near = np.linalg.norm(occluders - start, axis=-1) < 1.2 * reach
    axes.scatter(*occluders[near].T, s=8, color="black")
    axes.quiver(*start, *(turned(samples.normal) * reach * 0.6), color="0.3", linewidth=1.5)
    half = 0.6 * reach
    limits = [(middle - half, middle + half) for middle in start + turned(samples.normal) * reach / 2]
    axes.set(xlim=limits[0], ylim=limits[1], zlim=limits[2], xlabel="x", ylabel="-z (away)", zlabel="y")
    axes.set_box_aspect((1, 1, 1))
    axes.tick_params(labelsize=6)
    axes.view_init(elev=20, azim=-75)


def _pixels(points: np.ndarray, frame) -> np.ndarray:
    """(..., 2): column and row, from the top left, of view-space points."""
    view = View(frame.camera, frame.size, np.zeros((2, 3)))
    x, y = np.moveaxis(view.pixels(points.astype(np.float64)), -1, 0)
    return np.stack([x, frame.size[1] - y], axis=-1)
