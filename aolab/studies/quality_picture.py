"""The picture of a quality curve: error against milliseconds, one colour a module, the Pareto front numbered."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, StrMethodFormatter

from .curve import Curve

# Okabe and Ito 2008, distinguishable by all kinds of colour vision, yellow left out: it vanishes on white
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")


def draw(curve: Curve) -> Figure:
    """Both axes logarithmic. Stars are the modules' defaults; a dotted line, if in reach, is the truth's own error."""
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
    if curve.noise > axes.get_ylim()[0]:  # else it is far below, and the foot of the picture says how far
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
    """The front as a stair - what one must pay at least for an error - its points numbered, the numbers listed."""
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
    width = max(len(point.label) for point in front)
    lines = [f"{'':<{width + 4}}{'ms':>7}{'RMSE':>8}"]
    lines += [
        f"{number:>2}  {point.label:<{width}}{point.milliseconds:7.2f}{point.rmse:8.4f}{' *' if point.default else ''}"
        for number, point in enumerate(front, 1)
    ]
    axes.text(
        1.03, 1, "\n".join(lines), transform=axes.transAxes, va="top", family="monospace", fontsize=8, linespacing=1.4
    )
