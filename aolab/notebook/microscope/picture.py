"""The picture of a pixel's samples: over the image, and in three dimensions; a row for each pass."""

from collections.abc import Sequence

import numpy as np
from PIL import Image

from ...extras import missing
from ...pipeline.frame import Frame
from ...scene.view import View
from .sampled import Sampled
from .samples import Samples

OPEN, BLOCKED, LIGHT = "#1f77b4", "#d95f02", "#ffd92f"
MOST = 64  # ways that are drawn
LEAST_CROP = 24  # pixels: half the side of the crop
THIN, THICK = 0.5, 2.5  # lines of ways that contribute nothing, and most


def draw(frame: Frame, pixel: tuple[int, int], passes: Sequence[Sampled]) -> Image.Image:
    """The picture of a pixel: left, a crop of the image with the tested points; right, the points in space."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise missing("pictures", error) from error
    count = len(passes)
    height = 4.6 * count
    figure = Figure((10, height), dpi=90, facecolor="#fafaf8")
    canvas = FigureCanvasAgg(figure)
    for number, one in enumerate(passes):
        _over_the_image(figure.add_subplot(count, 2, 2 * number + 1), frame, pixel, one)
        _in_space(figure.add_subplot(count, 2, 2 * number + 2, projection="3d"), one.sets[0])
    figure.suptitle(
        f"{frame.info['module']}, pixel {pixel}; blue open, orange blocked, black: surfaces "
        "that block; thick: contributes most; stars: lights",
        fontsize=9, y=1 - 0.08 / height, va="top",
    )  # fmt: skip
    figure.tight_layout(rect=(0, 0.3 / height, 1, 1 - 0.3 / height), h_pad=2.5)
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _widths(samples: Samples) -> np.ndarray:
    """(N,): the width of each way's line, which grows with its contribution."""
    return THIN + (THICK - THIN) * samples.sizes / max(samples.sizes.max(initial=0), 1e-20)


def _over_the_image(axes, frame: Frame, pixel: tuple[int, int], one: Sampled) -> None:
    samples = one.sets[0]
    column, row = pixel
    chosen, widths = samples.foremost(MOST), _widths(samples)
    start = np.array((column + 0.5, row + 0.5))
    points, ends = _pixels(samples.points, frame), _pixels(samples.ends, frame)
    shown = ends if samples.until == "light" else points
    half = np.abs(shown - start).max(initial=0, where=np.isfinite(shown))
    half = max(LEAST_CROP, 1.15 * float(half))
    axes.imshow(frame.image, extent=(0, frame.size[0], frame.size[1], 0), interpolation="nearest")
    for i in chosen:
        color = OPEN if samples.open[i] else BLOCKED
        axes.plot(*np.vstack([start, ends[i]]).T, color=color, linewidth=widths[i], alpha=0.6)
    for blocked, color in ((False, OPEN), (True, BLOCKED)):
        axes.scatter(*points[chosen][samples.blocked[chosen] == blocked].T, s=12, color=color)
    axes.plot(*start, "o", markersize=7, markerfacecolor="white", markeredgecolor="black")
    if samples.until == "light":
        axes.scatter(*ends[chosen].T, s=30, marker="*", color=LIGHT, edgecolor="black", linewidth=0.4, zorder=3)
    (left, top), (right, bottom) = np.clip([start - half, start + half], 0, frame.size)
    axes.set(xlim=(left, right), ylim=(bottom, top))
    axes.set(xlabel="column", ylabel="row")
    name, value = next(iter(one.values.items()))
    axes.set_title(f"{one.name}: {name} {np.array2string(value, precision=3)}", fontsize=9)


def _in_space(axes, samples: Samples) -> None:
    """View space: x to the right, y up, -z away from the eye, drawn as depth."""

    def turned(vectors: np.ndarray) -> np.ndarray:
        """matplotlib's vertical axis is z."""
        return np.stack([vectors[..., 0], -vectors[..., 2], vectors[..., 1]], axis=-1)

    chosen, widths = samples.foremost(MOST), _widths(samples)
    if not len(chosen):
        axes.set_axis_off()
        axes.text2D(0.5, 0.5, "no samples contribute here", ha="center", va="center", transform=axes.transAxes)
        return
    start = turned(samples.receiver)
    reach = float(samples.distances[chosen].max(initial=1e-6))
    for i in chosen:
        color = OPEN if samples.open[i] else BLOCKED
        axes.plot(*np.stack([start, turned(samples.ends[i])]).T, color=color, linewidth=widths[i], alpha=0.6)
    points, blocked = turned(samples.points[chosen]), samples.blocked[chosen]
    axes.scatter(*points[~blocked].T, s=10, color=OPEN)
    axes.scatter(*points[blocked].T, s=14, color=BLOCKED)
    occluders = turned(samples.occluders[chosen])[blocked]
    near = np.linalg.norm(occluders - start, axis=-1) < 1.2 * reach
    axes.scatter(*occluders[near].T, s=8, color="black")
    if samples.until == "light":
        axes.scatter(*turned(samples.ends[chosen]).T, s=30, marker="*", color=LIGHT, edgecolor="black", linewidth=0.4)
    axes.quiver(*start, *(turned(samples.normal) * reach * 0.6), color="0.3", linewidth=1.5)
    half = 0.6 * reach
    limits = [(middle - half, middle + half) for middle in start + turned(samples.normal) * reach / 2]
    axes.set(xlim=limits[0], ylim=limits[1], zlim=limits[2], xlabel="x", ylabel="-z (away)", zlabel="y")
    axes.set_box_aspect((1, 1, 1))
    axes.tick_params(labelsize=6)
    axes.view_init(elev=20, azim=-75)


def _pixels(points: np.ndarray, frame: Frame) -> np.ndarray:
    """(..., 2): column and row, from the top left, of view-space points."""
    view = View(frame.camera, frame.size, np.zeros((2, 3)))
    x, y = np.moveaxis(view.pixels(points.astype(np.float64)), -1, 0)
    return np.stack([x, frame.size[1] - y], axis=-1)
