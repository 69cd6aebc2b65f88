"""The table of a sweep: a tidy pandas DataFrame, a row a case, with a plot a call."""

from collections.abc import Sequence
from itertools import count
from typing import Any

from ...errors import ParameterError
from ...extras import missing
from ...pictures import html

try:
    import pandas as pd
except ImportError as error:
    raise missing("sweep", error) from error

LAST = ("ms", "frame_ms", "seconds", "renderer", "aolab", "status", "error", "notes", "case")
NOT_IN_TABLE = ("timings", "values")
_page = count()  # a number for each output: names on one page must differ


class SweepTable(pd.DataFrame):
    """A row a case: inputs, measures, times (milliseconds), renderer, version, status and error.

    `case` is the name of the case's record. `.attrs` holds how the sweep was made. Its methods draw:
    `pareto`, `heat_map` and `lines` return matplotlib figures, `small_multiples` returns a Pillow image.
    """

    @property
    def _constructor(self) -> Any:
        return SweepTable

    @classmethod
    def of(cls, records: Sequence[dict[str, Any]], about: dict[str, Any]) -> "SweepTable":
        """The table of these records; `about` becomes `.attrs`."""
        names = list(dict.fromkeys(name for record in records for name in record if name not in NOT_IN_TABLE))
        ordered = [*(name for name in names if name not in LAST), *(name for name in LAST if name in names)]
        table = cls([{name: _cell(record.get(name)) for name in ordered} for record in records], columns=ordered)
        for name in table.select_dtypes("float").columns:  # an input that some modules lack keeps whole numbers
            known: Any = table[name].dropna()
            if name in about.get("inputs", ()) and (known % 1 == 0).all():
                table[name] = table[name].astype("Int64")
        for name in ordered:  # Parquet holds one type a column: radius may be 0.2 here and 'auto' there
            kinds = {type(value) for value in table[name].dropna()}
            if len(kinds) > 1 and kinds - {int, float}:
                table[name] = table[name].map(lambda value: value if pd.isna(value) else str(value))
        table.attrs.update(about)
        return table

    @property
    def good(self) -> Any:
        """The rows whose case succeeded."""
        return self[self["status"] == "ok"]

    @property
    def varied(self) -> list[str]:
        """The inputs with more than one value, in their order."""
        inputs = [name for name in self.attrs.get("inputs", ()) if name in self.columns]
        columns: dict[str, Any] = {name: self[name] for name in inputs}
        return [name for name, values in columns.items() if len(values.drop_duplicates()) > 1]

    def _repr_html_(self) -> str:
        """The rows, with the plots below them."""
        from .plots import overview

        pictures = [(caption, html.img(plot._repr_png_(), caption)) for caption, plot in overview(self)]
        rows = html.scrolling(super()._repr_html_() or "")
        return rows + html.tabs(pictures, f"aolab-sweep-{id(self)}-{next(_page)}")

    def to_xarray(self, *measures: str) -> Any:  # pyright: ignore[reportIncompatibleMethodOverride]
        """An xarray Dataset: a dimension an input with more than one value, a variable a measure (default: all).

        Raises `ParameterError` where two rows agree in all inputs.
        """
        axes, good = self.varied, self.good
        if not axes:
            raise ParameterError("to_xarray: no input of this sweep has more than one value")
        chosen = [*(measures or (*self.attrs.get("measures", ()), "ms"))]
        plain = pd.DataFrame(good)
        if plain.duplicated(axes).any():
            raise ParameterError(
                f"to_xarray: several rows agree in {', '.join(axes)}; drop the rows that do not belong"
            )
        try:
            return plain.set_index(axes)[[name for name in chosen if name in plain.columns]].to_xarray()
        except ImportError as error:
            raise missing("xarray", error) from error

    def pareto(self, error: str | None = None, time: str = "ms") -> Any:
        """Error against time with its Pareto front; see `plots.error_against_time`."""
        from .plots import error_against_time

        return error_against_time(self, error, time)

    def heat_map(self, x: str, y: str, measure: str | None = None) -> Any:
        """A measure over two inputs; see `plots.heat_map`."""
        from .plots import heat_map

        return heat_map(self, x, y, measure)

    def lines(self, x: str, measure: str | None = None, by: str = "module") -> Any:
        """A line a module with its confidence band; see `plots.lines`."""
        from .plots import lines

        return lines(self, x, measure, by)

    def small_multiples(self, folder: Any, along: str, columns: int = 4) -> Any:
        """The images along an input; see `plots.small_multiples`."""
        from .plots import small_multiples

        return small_multiples(self, folder, along, columns)


def _cell(value: Any) -> Any:
    return str(value) if isinstance(value, (list, tuple, dict)) else value
