"""Pictures of an error, with a scale: result, reference, error, colour bar."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image

from ..extras import missing
from .buffer import BufferComparison
from .quantities import picture

try:
    from matplotlib import colormaps
    from matplotlib.axes import Axes
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
except ImportError as error:
    raise missing("pictures", error) from error

# signed: white is zero, red is more; magnitudes: perceptually uniform from dark to bright
SIGNED, MAGNITUDE = "RdBu_r", "viridis"
BACKGROUND = "0.6"  # a grey that neither map contains
DPI = 100
PANEL_WIDTH = 260, 480  # pixels: smaller pictures are enlarged by whole numbers, larger ones reduced
MARGIN, HEAD, BAR, TEXT, PER_LINE = 14, 46, 92, 215, 17  # pixels


@dataclass(frozen=True)
class Line:
    """A line of the sheet: one comparison, a title and the text beside it."""

    comparison: BufferComparison
    title: str
    text: str


def comparison_picture(one: BufferComparison, names: tuple[str, str], limit: float | None = None) -> Image.Image:
    """`result`, `reference` and error of one buffer; see `Comparison.picture`."""
    return draw([Line(one, "", "")], f"{one.name}: {names[0]} against {names[1]}", names, limit)


def draw(
    lines: Sequence[Line], title: str, names: tuple[str, str] = ("result", "truth"), limit: float | None = None
) -> Image.Image:
    """Lines of result, reference, error and text under one `title`; all errors have one scale, its bar on the right.

    All `lines` show the same buffer. `limit` is that of `Comparison.picture`, over all lines.
    """
    height, width = lines[0].comparison.foreground.shape
    scale = max(1, -(-PANEL_WIDTH[0] // width)) if width < PANEL_WIDTH[0] else min(1, PANEL_WIDTH[1] / width)
    panel = round(width * scale), max(1, round(height * scale))
    text = TEXT if any(line.text for line in lines) else 0
    line_height = max(panel[1], PER_LINE * max(line.text.count("\n") + 2 for line in lines), 120) + HEAD // 2
    total = 3 * (panel[0] + MARGIN) + text + BAR + MARGIN, HEAD + len(lines) * line_height + MARGIN

    figure = Figure((total[0] / DPI, total[1] / DPI), dpi=DPI, facecolor="#fafaf8")
    canvas = FigureCanvasAgg(figure)

    def box(x: float, y: float, w: float, h: float) -> tuple[float, float, float, float]:
        """Pixels from the upper left corner as matplotlib counts."""
        return x / total[0], 1 - (y + h) / total[1], w / total[0], h / total[1]

    def write(x: float, y: float, words: str, **style: object) -> None:
        figure.text(x / total[0], 1 - y / total[1], words, va="top", **style)  # type: ignore[arg-type]

    one = lines[0].comparison
    signed = one.kind.error == "signed"
    mappable, largest = _scale([line.comparison for line in lines], limit)
    write(MARGIN, 6, title, fontsize=10, weight="bold")
    for index, line in enumerate(lines):
        y = HEAD + index * line_height
        heads = (f"{line.title or names[0]}", names[1], f"error, {names[0]} - {names[1]}" if signed else "error")
        panels = (*_seen(line.comparison), _colored(line.comparison.error, mappable))
        for column, (head, pixels) in enumerate(zip(heads, panels, strict=True)):
            x = MARGIN + column * (panel[0] + MARGIN)
            if column == 1 and index and _same_truth(line, lines[index - 1]):
                write(x, y, "the same truth as above", fontsize=9, color="0.5")
                continue
            write(x, y - 17, head, fontsize=9)
            axes = figure.add_axes(box(x, y, *panel), xticks=[], yticks=[])
            axes.spines[:].set(color="0.75", linewidth=0.6)
            axes.imshow(pixels, interpolation="nearest" if scale >= 1 else "antialiased", aspect="auto")
        write(MARGIN + 3 * (panel[0] + MARGIN), y, line.text, fontsize=8.5, family="monospace", linespacing=1.3)
    bar = figure.add_axes(box(total[0] - BAR, HEAD, 16, min(total[1] - HEAD - 2 * MARGIN, 420)))
    _bar(figure, mappable, largest, bar, one)
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _same_truth(line: Line, above: Line) -> bool:
    return np.array_equal(line.comparison.reference, above.comparison.reference, equal_nan=True)


def _scale(comparisons: Sequence[BufferComparison], limit: float | None) -> tuple[ScalarMappable, float]:
    """The colours of errors, and the largest magnitude of an error."""
    magnitudes = np.concatenate([np.abs(one.error[np.isfinite(one.error)]) for one in comparisons])
    largest = float(magnitudes.max(initial=0))
    if limit is None:
        limit = float(np.percentile(magnitudes, 99)) if largest else 0.0
    limit = limit or largest or 1.0  # where most or all is equal
    signed = comparisons[0].kind.error == "signed"
    colors = colormaps[SIGNED if signed else MAGNITUDE].with_extremes(bad=BACKGROUND)
    return ScalarMappable(Normalize(-limit if signed else 0, limit), colors), largest


def _bar(figure: Figure, mappable: ScalarMappable, largest: float, place: Axes, one: BufferComparison) -> None:
    beyond = largest > mappable.get_clim()[1] * (1 + 1e-6)  # type: ignore[operator]
    pointed = "both" if one.kind.error == "signed" else "max"
    bar = figure.colorbar(mappable, cax=place, extend=pointed if beyond else "neither")
    bar.ax.tick_params(labelsize=8)
    what = {"signed": "error", "angle": "angle", "norm": "norm of the error"}[one.kind.error]
    unit = f", {one.kind.unit}" if one.kind.unit else ""
    bar.set_label(f"{one.name}: {what}{unit}" + (f" (largest: {largest:.3g})" if beyond else ""), fontsize=8.5)


def _colored(error: np.ndarray, mappable: ScalarMappable) -> np.ndarray:
    return mappable.to_rgba(np.ma.masked_invalid(error), bytes=True)[..., :3]


def _seen(one: BufferComparison) -> list[np.ndarray]:
    """Result and reference (H, W, 3) uint8: their pictures. Kinds without a picture show their three channels, or the
    first one, over the range of the reference."""  # fmt: skip
    shown = [values if values.shape[2] == 3 else values[..., :1] for values in (one.result, one.reference)]
    if one.kind.picture:
        shown = [picture(np.nan_to_num(values), one.kind) for values in shown]
    else:
        known = shown[1][one.foreground]
        low, high = (-1.0, 1.0) if one.kind.error == "angle" else (float(known.min()), float(known.max()))
        shown = [((np.nan_to_num(values) - low) / max(high - low, 1e-30)).clip(0, 1) for values in shown]
    grey = float(BACKGROUND)
    return [
        np.rint(np.where(one.foreground[..., None], values, grey) * np.full(3, 255)).astype(np.uint8)
        for values in shown
    ]
