"""Tables of text that read well in terminals, pipes and logs: aligned by spaces, without borders and colours."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

MISSING = "-"
GAP = "  "


def table(columns: Mapping[str, str], rows: Iterable[Sequence[Any]]) -> str:
    """Lines of text: the heads, then a line for each row.

    `columns` maps each head to the format specification of its cells (".4f"). An empty specification means text, which
    is aligned to the left; numbers are aligned to the right. None and NaN become "-", and text stays as it is.
    """
    cells = [list(columns)]
    cells += [[_cell(value, spec) for value, spec in zip(row, columns.values(), strict=True)] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    signs = [">" if spec else "<" for spec in columns.values()]
    lines = [GAP.join(map("{:{}{}}".format, line, signs, widths)) for line in cells]
    return "\n".join(line.rstrip() for line in lines)


def _cell(value: Any, spec: str) -> str:
    if value is None or value != value:  # NaN is the only value that differs from itself
        return MISSING
    return value if isinstance(value, str) else format(value, spec)
