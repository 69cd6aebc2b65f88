"""Calls from other threads, handed to the thread of the OpenGL context.

JupyterLab runs the callbacks of widgets in threads of their own (subshells, ipykernel 7), but a context belongs to one
thread. If that thread runs an event loop, as a kernel's main thread does, the loop makes the call and the caller waits.
"""

import sys
import threading
from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from ..errors import ContextError
from . import context

if TYPE_CHECKING:
    from asyncio import AbstractEventLoop

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

PATIENCE = 10.0  # seconds in which the thread of the context must begin the call: a cell may wait for this very call


def handed(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, run in the thread of the context whichever thread calls it, with this context current.

    The caller waits for the result.

    Raises `ContextError` if the context's thread runs no event loop, or if the loop is busy for `PATIENCE` seconds.
    """

    @wraps(function)
    def call(*args: Arguments.args, **named: Arguments.kwargs) -> Result:
        loop = _other_loop()
        if loop is None:
            with context.current():  # raises if this is the wrong thread
                return function(*args, **named)
        from concurrent.futures import Future  # with asyncio, it takes a part of the start-up

        future: Future[Result] = Future()
        started = threading.Event()

        def run() -> None:
            if not future.set_running_or_notify_cancel():
                return  # the caller has given up
            started.set()
            try:
                with context.current():
                    future.set_result(function(*args, **named))
            except BaseException as error:  # KeyboardInterrupt too: it is the caller's
                future.set_exception(error)

        loop.call_soon_threadsafe(run)
        if not started.wait(PATIENCE) and future.cancel():
            raise ContextError(
                f"{function.__qualname__}: the thread of aolab's OpenGL context did not take this call of the thread "
                f"'{threading.current_thread().name}' within {PATIENCE:g} s. In a notebook: wait until the running "
                "cell ends, and do not wait in a cell for a thread that renders"
            )
        return future.result()

    return call


def post(function: Callable[[], object]) -> None:
    """Run the function in the thread of the context: at once in this thread, else soon, and do not wait."""
    loop = _other_loop()
    if loop is None:
        function()
    else:
        loop.call_soon_threadsafe(function)


def _other_loop() -> "AbstractEventLoop | None":
    """The running loop of the context's thread, if that is another thread than this one."""
    owner = context.owner()
    if owner is None:  # no context yet: in a notebook, the kernel's main thread shall make it, since it never ends
        loop = _kernel_loop() if threading.current_thread() is not threading.main_thread() else None
    elif owner.thread == threading.get_ident():
        owner.loop = context.running_loop() or owner.loop  # a thread may start its loop after the first render
        return None
    else:
        loop = owner.loop
    return loop if loop is not None and loop.is_running() else None


def _kernel_loop() -> "AbstractEventLoop | None":
    ipython = sys.modules.get("IPython")
    kernel = getattr(ipython.get_ipython(), "kernel", None) if ipython else None
    return getattr(getattr(kernel, "io_loop", None), "asyncio_loop", None)
