"""Ctrl-C, and the stop button of a notebook, at places that cannot bear an exception.

Some C code crashes on exceptions. Some libraries swallow every exception while they are imported, as trimesh does;
others stay broken if their import ends midway, as numpy does.
"""

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from IPython.core.interactiveshell import InteractiveShell

AGAIN = 0.02  # seconds until the next look whether the import has ended


@contextmanager
def postponed() -> Iterator[None]:
    """Within the block, an interrupt waits for the block's end. For calls of C code that crashes on exceptions."""
    former = signal.getsignal(signal.SIGINT)
    if not _is_main() or not callable(former):
        yield
        return
    came: list[tuple[int, FrameType | None]] = []
    signal.signal(signal.SIGINT, lambda number, frame: came.append((number, frame)))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, former)
        if came:
            former(*came[-1])


@contextmanager
def after_imports() -> Iterator[None]:
    """Within the block, an interrupt that comes while a library is imported is raised when the import has ended."""
    former = signal.getsignal(signal.SIGINT)
    has_timer = hasattr(signal, "setitimer")  # not on Windows
    if former is not signal.default_int_handler or not has_timer or not _is_main():
        yield
        return
    replaced = []  # handlers of alarms; a program may have alarms of its own, which stay if no interrupt comes

    def interrupt(_number: int, frame: FrameType | None) -> None:
        if _is_import(frame):
            if not replaced:
                replaced.append(signal.signal(signal.SIGALRM, interrupt))
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
        else:
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, former)
        if replaced:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, replaced[0])


def install(ipython: "InteractiveShell") -> None:
    """Run the cell that calls this, and all cells after it, within `after_imports`."""
    cell = ExitStack()

    def begin(*_: object) -> None:
        if _is_main():
            cell.enter_context(after_imports())

    def end(*_: object) -> None:
        if _is_main():  # callbacks of widgets end in other threads
            cell.close()

    begin()
    ipython.events.register("pre_run_cell", begin)
    ipython.events.register("post_run_cell", end)


def _is_main() -> bool:
    return threading.current_thread() is threading.main_thread()


def _is_import(frame: FrameType | None) -> bool:
    """Whether the frame, or a frame that called it, imports an installed library or a part of aolab."""
    while frame is not None:
        code = frame.f_code
        if code.co_name == "_find_and_load" and code.co_filename.startswith("<frozen importlib"):
            package = str(frame.f_locals.get("name")).partition(".")[0]
            file = getattr(sys.modules.get(package), "__file__", None) or ""
            # a file of one's own may compute for long while it is imported
            if package == __name__.partition(".")[0] or f"-packages{os.sep}" in file:
                return True
        frame = frame.f_back
    return False
