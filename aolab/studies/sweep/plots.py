"""Pictures of a sweep, one call each, from its `SweepTable`: error against time, heat map, lines with bands, images."""

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from scipy.stats import t as student

from ...errors import ParameterError, suggestion
from ...extras import missing
from ...pictures.sheet import contact_sheet
from ..quality_picture import COLORS, MARKERS

try:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, StrMethodFormatter
except ImportError as error:
    raise missing("pictures", error) from error

CONFIDENCE = 0.95  # of a band


class Plot(Figure):
    """A figure that shows itself in notebooks, whether or not pyplot is imported there."""

    def _repr_png_(self) -> bytes:
        data = BytesIO()
        self.savefig(data, format="png")
        return data.getvalue()


def error_against_time(table: Any, error: str | None = None, time: str = "ms") -> Plot:
    """A panel a scene, a point a case, a colour a module, and the Pareto front: the cases that no other case beats in
    error and in time.

    `error` is a measure of the table; the first by default.
    """
    error = _measure(table, error)
    _known(table, time)
    scenes = list(table.good.groupby("scene", sort=False))
    figure = Plot((7 if len(scenes) == 1 else 5 * len(scenes), 4.5), layout="constrained")
    looks = dict(zip(table["module"].drop_duplicates(), _looks(), strict=False))
    for (scene, rows), axes in zip(scenes, figure.subplots(1, len(scenes), squeeze=False)[0], strict=True):
        for module, own in rows.groupby("module", sort=False):
            axes.scatter(own[time], own[error].abs(), s=18, alpha=0.7, lw=0, label=str(module), **looks[module])
        ordered = rows.assign(_error=rows[error].abs()).sort_values([time, "_error"])
        front = ordered[ordered["_error"] < ordered["_error"].cummin().shift(fill_value=np.inf)]
        axes.plot(front[time], front["_error"], color="0.3", lw=1, drawstyle="steps-post", label="Pareto front")
        axes.set(xscale="log", yscale="log", title=scene, xlabel=f"{time} (milliseconds, {_renderer(table)})")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5), numticks=99))
            axis.set_major_formatter(StrMethodFormatter("{x:g}"))
            axis.set_minor_formatter("")
        axes.set_ylabel(f"|{error}|" if (rows[error] < 0).any() else error)
        _finished(figure, axes)
    return figure


def heat_map(table: Any, x: str, y: str, measure: str | None = None) -> Plot:
    """The mean of a measure over two inputs; all other inputs are averaged."""
    measure = _measure(table, measure)
    _known(table, x, y)
    grid = table.good.pivot_table(index=y, columns=x, values=measure, aggfunc="mean", sort=True)
    figure, axes = _empty()
    picture = axes.pcolormesh(np.arange(grid.shape[1] + 1), np.arange(grid.shape[0] + 1), grid.to_numpy(float))
    axes.set_xticks(np.arange(grid.shape[1]) + 0.5, _labels(grid.columns))
    axes.set_yticks(np.arange(grid.shape[0]) + 0.5, _labels(grid.index))
    axes.set(xlabel=x, ylabel=y)
    figure.colorbar(picture, label=measure)
    return figure


def lines(table: Any, x: str, measure: str | None = None, by: str = "module") -> Plot:
    """A line a module over the input `x`: the mean of all cases, and its band of 95 % confidence over the seeds."""
    measure = _measure(table, measure)
    _known(table, x, by)
    figure, axes = _empty()
    for (name, rows), look in zip(table.good.dropna(subset=[x]).groupby(by, sort=False), _looks(), strict=False):
        by_seed: Any = rows.groupby([x, "seed"])[measure].mean().groupby(level=0)
        mean, count = by_seed.mean(), by_seed.count()
        half = student.ppf((1 + CONFIDENCE) / 2, count - 1) * by_seed.std() / np.sqrt(count)  # NaN for one seed
        (line,) = axes.plot(mean.index, mean, ms=4, label=str(name), **look)
        if (count > 1).any():
            axes.fill_between(mean.index, mean - half, mean + half, color=line.get_color(), alpha=0.15, lw=0)
    axes.set(xlabel=x, ylabel=measure)
    return _finished(figure, axes)


def small_multiples(table: Any, folder: str | Path, along: str, columns: int = 4) -> Image.Image:
    """The images of a sweep with `images=True`, side by side along one input; a caption gives the inputs that vary."""
    _known(table, along)
    pictures = []
    row: Any
    for _, row in table.good.sort_values([along]).iterrows():
        path = Path(folder) / "images" / f"{row['case']}.png"
        if not path.is_file():
            raise ParameterError(f"no image {path}: a sweep with images=True and folder={str(folder)!r} writes it")
        caption = ", ".join(f"{name} {row[name]}" for name in table.varied if row[name] == row[name])
        pictures.append((caption, np.asarray(Image.open(path).convert("RGB"))))
    return contact_sheet(pictures, min(columns, len(pictures)))


def overview(table: Any) -> list[tuple[str, Plot]]:
    """The plots that a notebook shows below the table, with their captions: none for a table without measures."""
    measures = [name for name in table.attrs.get("measures", ()) if name in table.columns]
    if not measures or not len(table.good) or not {"module", "seed", "ms"} <= set(table.columns):
        return []
    numbers = [name for name in table.varied if name != "seed" and table[name].dtype.kind in "if"]
    found = [(f"{measures[0]} over {name}", lines(table, name, measures[0])) for name in numbers[:1]]
    return [*found, (f"{measures[0]} against time", error_against_time(table, measures[0]))]


def _measure(table: Any, name: str | None) -> str:
    if not len(table.good):
        raise ParameterError("no case of this table succeeded; its column 'error' has the reasons")
    known = [*table.attrs.get("measures", ()), "ms", "frame_ms", "seconds"]
    if name is None:
        return known[0]
    _known(table, name)
    return name


def _known(table: Any, *names: str) -> None:
    for name in names:
        if name not in table.columns:
            raise ParameterError(f"the table has no column '{name}'{suggestion(name, list(table.columns))}")


def _labels(values: Any) -> list[str]:
    return [f"{value:.4g}" if isinstance(value, (float, np.floating)) else str(value) for value in values]


def _renderer(table: Any) -> str:
    return str(table.attrs.get("renderer", "unknown renderer"))


def _empty() -> tuple[Plot, Axes]:
    figure = Plot((7, 4.5), layout="constrained")
    return figure, figure.add_subplot()


def _looks() -> Iterator[dict[str, Any]]:
    """A colour and a marker for each line: no two of the first 49 look alike."""
    for turn in range(len(MARKERS)):
        for index, color in enumerate(COLORS):
            yield {"color": color, "marker": MARKERS[(index + turn) % len(MARKERS)]}


def _finished(figure: Plot, axes: Axes) -> Plot:
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    return figure
