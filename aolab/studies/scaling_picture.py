"""The picture of a frame's growth: milliseconds of its parts against each number, on logarithmic axes."""

from collections.abc import Mapping
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, StrMethodFormatter

from .quality_picture import COLORS, MARKERS
from .scaling import FRAME, LIGHTING, PARTS


def draw(result: Mapping[str, Any]) -> Figure:
    """A panel for each number of `scaling`. The legend of a line has the exponent of its power law."""
    growth = result["growth"]
    figure = Figure((13, 7.6), dpi=110, facecolor="white", layout="constrained")
    for panel, (axes, (what, found)) in enumerate(zip(figure.subplots(2, 3).flat, growth.items(), strict=True)):
        counts = list(found["milliseconds"])
        for index, name in enumerate((*PARTS, LIGHTING, FRAME)):
            if name not in found["exponents"]:
                continue
            times = [found["milliseconds"][count][name] for count in counts]
            color, marker = COLORS[index % len(COLORS)], MARKERS[index % len(MARKERS)]
            text = f"{name}  {found['exponents'][name]:+.2f}"
            axes.plot(counts, times, color=color, marker=marker, markersize=5, linewidth=1.4, label=text)
        axes.set(xscale="log", yscale="log", xlabel=what, ylabel="milliseconds" if panel % 3 == 0 else None)
        axes.set_xticks(counts, [f"{count:,}" for count in counts])
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.grid(color="0.92")
        axes.legend(fontsize=7.5, title="part, exponent", title_fontsize=7.5)
    width, height = result["size"]
    place = f"{result['renderer']}; {result['machine']}; {width}×{height}, medians of {result['frames']} frames"
    figure.suptitle(f"Milliseconds ≈ c · xᵏ: the parts of a frame with ssao, and k\n{place}", fontsize=10)
    return figure
