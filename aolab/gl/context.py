"""The one OpenGL context of this process: made when first needed, used by the thread that made it, released on exit."""

import atexit
import os
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import moderngl

from ..errors import ContextError
from ..interrupts import postponed
from . import egl

if TYPE_CHECKING:
    from asyncio import AbstractEventLoop

REQUIRED = 330  # OpenGL 3.3 core, which every machine of a course has (macOS stops at 4.1)
_SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swrast", "SwiftShader", "Microsoft Basic Render")


@dataclass
class _State:
    context: moderngl.Context | None = None
    binding: egl.Binding = egl.UNBOUND
    thread: int = 0
    process: int = 0
    loop: "AbstractEventLoop | None" = None  # of that thread, if it runs one


_state = _State()


def get() -> moderngl.Context:
    """The context of this process. Raises `ContextError` from another thread or a forked child, or if GL is missing."""
    if _state.context is None:
        with postponed():  # moderngl calls the loader of functions from C, and does not look for exceptions
            _state.context = _create()
            _state.binding = egl.bound()
            _state.thread, _state.process = threading.get_ident(), os.getpid()
            _state.loop = running_loop()
            atexit.register(release)
    elif os.getpid() != _state.process:
        raise ContextError(
            f"this process ({os.getpid()}) was forked from {_state.process}, which holds the OpenGL context, and a "
            "context does not survive a fork; start workers with multiprocessing.get_context('spawn')"
        )
    elif threading.get_ident() != _state.thread:
        raise ContextError(
            "aolab's OpenGL context belongs to the thread that rendered first; render and read buffers in that thread, "
            "or use a worker process (multiprocessing.get_context('spawn')) for each parallel render. In a notebook, "
            "render once in a cell before callbacks of widgets do"
        )
    return _state.context


@contextmanager
def current() -> Iterator[None]:
    """The context of this process is the thread's current one within the block; the former one comes back after it.

    A program may have OpenGL contexts of its own, through moderngl or pyrender: without this, their textures would be
    taken for ours. Nothing is done where the context is current already. Raises what `get` raises.
    """
    if egl.is_bound(_state.binding):
        get()  # raises in a forked process
        yield
        return
    former = egl.bound()
    context = get()
    own = _state.binding
    if own.context:
        egl.bind(own)
        try:
            yield
        finally:
            if former.context:
                with suppress(ContextError):  # its program may have ended it
                    egl.bind(former)
    else:  # not EGL: Windows, macOS
        with context:
            yield


def running_loop() -> "AbstractEventLoop | None":
    """The event loop of this thread, if it runs one; asyncio is imported by those who use it."""
    asyncio = sys.modules.get("asyncio")
    return asyncio._get_running_loop() if asyncio else None


def owner() -> _State | None:
    """The thread of this process's context, and its event loop; None if there is no context."""
    return _state if _state.context is not None and _state.process == os.getpid() else None


def release() -> None:
    """Free the context; the next use makes a new one. Everything made with the old one is void."""
    if _state.context is not None and os.getpid() == _state.process and threading.get_ident() == _state.thread:
        _state.context.release()
        _state.context, _state.binding = None, egl.UNBOUND
        atexit.unregister(release)


def renderer() -> str:
    """The driver's own name for what draws, for example 'llvmpipe (LLVM 15.0.6, 256 bits)'."""
    return get().info["GL_RENDERER"]


def is_software() -> bool:
    """Whether the CPU draws: there GPU time queries mean nothing, and time is wall clock around `finish()`."""
    return any(name in renderer() for name in _SOFTWARE_RENDERERS)


def _create() -> moderngl.Context:
    if not sys.platform.startswith("linux"):
        try:
            return _checked(moderngl.create_context(standalone=True, require=REQUIRED))
        except Exception as error:
            raise ContextError(f"no OpenGL {REQUIRED / 100:.1f} context: {error}; see `aolab doctor`") from error
    reasons = []
    for index in _preferred_devices():
        try:
            own: dict[str, Any] = {"context": egl.Context(index, REQUIRED)}
            return _checked(moderngl.create_context(standalone=True, require=REQUIRED, **own))
        except Exception as error:
            reasons.append(f"device {index}: {error}")
    raise ContextError(
        f"no OpenGL {REQUIRED / 100:.1f} context through EGL ({'; '.join(reasons)}); `aolab doctor` names the remedy"
    )


def _preferred_devices() -> list[int]:
    """Device indices to try: the one of `AOLAB_DEVICE`, else hardware first."""
    listed = egl.devices()
    if wanted := os.environ.get("AOLAB_DEVICE"):
        if not wanted.isdigit() or (listed and int(wanted) >= len(listed)):
            choices = ", ".join(f"{i}: {name}" for i, name in enumerate(listed)) or "0"
            raise ContextError(f"AOLAB_DEVICE = '{wanted}' is not a device of this machine ({choices})")
        return [int(wanted)]
    return sorted(range(max(len(listed), 1)), key=lambda index: bool(listed) and listed[index] == "software")


def _checked(context: moderngl.Context) -> moderngl.Context:
    context.gc_mode = "context_gc"  # objects that die in any thread are freed by `collect()` in this one
    return context


def collect() -> None:
    """Free the GL objects that Python has let go of."""
    get().gc()
