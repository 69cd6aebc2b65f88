"""Ctrl-C while a library is imported: some libraries, as trimesh, swallow every exception there."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

AGAIN = 0.02  # seconds until the next look whether the import has ended


@contextmanager
def after_imports() -> Iterator[None]:
    """Within the block, an interrupt that comes during an import is raised when the import has ended."""
    former = signal.getsignal(signal.SIGINT)
    has_timer = hasattr(signal, "setitimer")  # not on Windows
    is_main = threading.current_thread() is threading.main_thread()
    if former is not signal.default_int_handler or not has_timer or not is_main:
        yield
        return

    def interrupt(_number: int, frame: FrameType | None) -> None:
        if _is_import(frame):
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
        else:
            raise KeyboardInterrupt

    alarm = signal.signal(signal.SIGALRM, interrupt)
    signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGINT, former)
        signal.signal(signal.SIGALRM, alarm)


def _is_import(frame: FrameType | None) -> bool:
    """Whether the frame, or a frame that called it, is an import statement."""
    while frame is not None:
        if frame.f_code.co_name == "_find_and_load" and frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False
