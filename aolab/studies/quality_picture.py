"""The picture of a curve: error against milliseconds, a colour for each module, the Pareto front numbered."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, StrMethodFormatter

from ..table import table
from .curve import Curve

# Okabe and Ito 2008, distinct for all kinds of colour vision; without their yellow, which is faint on white
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")


def draw(curve: Curve) -> Figure:
    """Draw the curve on logarithmic axes. Stars are defaults; a dotted line is the truth's standard error."""
    figure = Figure((12.5, 6.2), dpi=110, facecolor="white")
    axes = figure.add_axes((0.065, 0.125, 0.59, 0.79))
    names = list(dict.fromkeys(point.module for point in curve.points))
    for index, name in enumerate(names):
        color, marker = COLORS[index % len(COLORS)], MARKERS[index % len(MARKERS)]
        own = [point for point in curve.points if point.module == name]
        x, y = [point.milliseconds for point in own], [point.rmse for point in own]
        axes.scatter(x, y, s=26, color=color, marker=marker, alpha=0.55, linewidths=0, label=name)
        defaults = [point for point in own if point.default]
        x, y = [point.milliseconds for point in defaults], [point.rmse for point in defaults]
        axes.scatter(x, y, s=190, color=color, marker="*", edgecolors="black", linewidths=0.8, zorder=4)
    _front(axes, curve)
    axes.scatter([], [], s=120, color="white", marker="*", edgecolors="black", linewidths=0.8, label="default")

    axes.set(
        xscale="log", yscale="log", xlabel="milliseconds that the module adds to a frame", ylabel="RMSE of visibility"
    )
    if curve.noise > axes.get_ylim()[0]:  # else it is far below; the foot of the picture has the number
        axes.axhline(curve.noise, color="0.4", linestyle=":", linewidth=1, label="the truth's standard error")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_locator(LogLocator(subs=(3, 4, 6, 7, 8, 9)))
        axis.set_minor_formatter("")
    axes.grid(which="major", color="0.9")
    axes.set_axisbelow(True)
    axes.legend(fontsize=9, loc="lower left", bbox_to_anchor=(1.02, -0.01), borderaxespad=0, frameon=False)
    axes.set_title(f"Error against time: {curve.title}", fontsize=11, loc="left")
    figure.text(
        0.065, 0.02, f"{curve.place}; the truth's standard error is {curve.noise:.4f}", fontsize=8.5, color="0.3"
    )
    return figure


def _front(axes: Axes, curve: Curve) -> None:
    """The front as a staircase, the least time for an error; its points are numbered, and the list explains them."""
    front = curve.front
    x, y = [point.milliseconds for point in front], [point.rmse for point in front]
    axes.plot(x, y, drawstyle="steps-post", color="black", linewidth=1.2, zorder=2, label="Pareto front")
    for number, point in enumerate(front, 1):
        axes.annotate(
            str(number),
            (point.milliseconds, point.rmse),
            xytext=(-6, -6),
            textcoords="offset points",
            ha="right",
            va="top",
            fontsize=8,
            weight="bold",
            zorder=5,
        )
    rows = [
        (number, point.label, point.milliseconds, point.rmse, "*" if point.default else "")
        for number, point in enumerate(front, 1)
    ]
    listed = table({" ": "d", "": "", "ms": ".2f", "RMSE": ".4f", "  ": ""}, rows)
    axes.text(1.03, 1, listed, transform=axes.transAxes, va="top", family="monospace", fontsize=8, linespacing=1.4)
