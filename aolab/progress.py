"""Progress of long work on standard error, with the time left: a bar in terminals and notebooks, lines in logs."""

import os
import sys
from typing import Any, ClassVar, TextIO
from weakref import WeakSet

from tqdm import tqdm

PATIENCE = 0.5  # seconds: shorter work shows no bar
SMOOTHING = 0.1  # weight of the last step in the rate: threads end their steps in pairs, and then wait
LOG_EVERY = 30.0  # seconds between two lines where standard error is no terminal; shorter work writes none


class _Bar(tqdm):
    """A bar that leaves room for the `^C` that a terminal shows behind it: a longer line would break there."""

    @property
    def format_dict(self) -> Any:
        self.ncols = _columns(self.fp) - 3
        return super().format_dict


def _columns(stream: Any) -> int:
    """The width of a terminal; 80 where it reports none, as in some containers."""
    try:
        return os.get_terminal_size(stream.fileno()).columns or 80
    except (OSError, ValueError):
        return 80


class _Lines(tqdm):
    """A line of its own for each report, for files that are read later."""

    monitor_interval = 0  # a line is written when work has been done, not by a thread in between
    _instances: ClassVar[WeakSet] = WeakSet()  # apart from the bars, which `write_line` draws again below the line

    def display(self, msg: str | None = None, pos: int | None = None) -> None:
        self.fp.write(f"{msg or self}\n")
        self.fp.flush()


def progress_bar(what: str, total: int, unit: str = "", *, shown: bool | None = None, **options: Any) -> Any:
    """A bar of `total` steps of work, a context manager: `bar.update(n)` after each n steps.

    `shown`: None shows a bar in a terminal or a notebook, and in a log a line every 30 seconds; True and False force
    or forbid it, as does the environment variable TQDM_DISABLE=1. `unit` stands behind the count. `options` are tqdm's.
    """
    usual = {"desc": what, "total": total, "unit": unit or "it", "leave": False, "smoothing": SMOOTHING, "miniters": 0}
    usual |= options
    # a program without a console has no standard error on Windows; tqdm's notebook ignores the variable
    if shown is False or sys.stderr is None or os.environ.get("TQDM_DISABLE"):
        usual["disable"] = True
    if "ipykernel" in sys.modules:
        from tqdm.auto import tqdm as in_notebook

        return in_notebook(**usual, delay=PATIENCE)
    if shown or (sys.stderr is not None and sys.stderr.isatty()):
        return _Bar(**usual, delay=0 if shown else PATIENCE, ncols=80, nrows=24)
    layout = "{desc}: {percentage:.0f} %, {elapsed} elapsed, {remaining} left"
    return _Lines(**usual, bar_format=layout, delay=LOG_EVERY, mininterval=LOG_EVERY)


def write_line(text: str, file: TextIO | None = None) -> None:
    """Write a line to standard output, or to `file`, above the bars that are shown."""
    tqdm.write(text, file=file)
