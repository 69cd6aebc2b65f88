"""Progress of long work on standard error, with the time left: a bar in terminals and notebooks, lines in logs."""

import os
import sys
from typing import Any

from tqdm import tqdm

PATIENCE = 0.5  # seconds: shorter work shows no bar
LOG_EVERY = 30.0  # seconds between two lines where standard error is no terminal; shorter work writes none


class _Lines(tqdm):
    """A line of its own for each report, for files that are read later."""

    monitor_interval = 0  # a line is written when work has been done, not by a thread in between

    def display(self, msg: str | None = None, pos: int | None = None) -> None:
        self.fp.write(f"{msg or self}\n")
        self.fp.flush()


def progress_bar(what: str, total: int, unit: str = "", *, shown: bool | None = None, **options: Any) -> Any:
    """A bar of `total` steps of work, a context manager: `bar.update(n)` after each n steps.

    `shown`: None shows a bar in a terminal or a notebook, and in a log a line every 30 seconds; True and False force
    or forbid it, as does the environment variable TQDM_DISABLE=1. `unit` stands behind the count. `options` are tqdm's.
    """
    usual = {"desc": what, "total": total, "unit": unit or "it", "leave": False, **options}
    # a program without a console has no standard error on Windows; tqdm's notebook ignores the variable
    if shown is False or sys.stderr is None or os.environ.get("TQDM_DISABLE"):
        usual["disable"] = True
    if "ipykernel" in sys.modules:
        from tqdm.auto import tqdm as in_notebook

        return in_notebook(**usual, delay=PATIENCE)
    if shown or (sys.stderr is not None and sys.stderr.isatty()):
        return tqdm(**usual, delay=0 if shown else PATIENCE, **_width())
    layout = "{desc}: {percentage:.0f} %, {elapsed} elapsed, {remaining} left"
    return _Lines(**usual, bar_format=layout, delay=LOG_EVERY, mininterval=LOG_EVERY, miniters=1)


def _width() -> dict[str, Any]:
    """tqdm's options for the width: of the terminal, or 80 columns where it reports none, as in some containers."""
    try:
        known = os.get_terminal_size(sys.stderr.fileno()).columns > 0
    except (OSError, ValueError):
        known = False
    return {"dynamic_ncols": True} if known else {"ncols": 80, "nrows": 24}
