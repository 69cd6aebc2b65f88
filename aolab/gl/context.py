"""The one OpenGL context of this process: made when first needed, used by the thread that made it, released on exit."""

import atexit
import ctypes
import os
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import moderngl

from ..errors import ContextError

if TYPE_CHECKING:
    from asyncio import AbstractEventLoop

REQUIRED = 330  # OpenGL 3.3 core, which every machine of a course has (macOS stops at 4.1)
_SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swrast", "SwiftShader", "Microsoft Basic Render")

# by their loader names: a search by linker name misses libraries in private folders (conda, LD_LIBRARY_PATH)
_LINUX = {"backend": "egl", "libegl": "libEGL.so.1", "libgl": "libGL.so.1"}


class _Binding(NamedTuple):
    """The EGL handles of a context that is current in a thread; all are 0 where none is."""

    display: int = 0
    draw: int = 0
    read: int = 0
    context: int = 0


_NONE = _Binding()


@dataclass
class _State:
    context: moderngl.Context | None = None
    binding: _Binding = _NONE
    thread: int = 0
    process: int = 0
    loop: "AbstractEventLoop | None" = None  # of that thread, if it runs one


_state = _State()


def get() -> moderngl.Context:
    """The context of this process. Raises `ContextError` from another thread or a forked child, or if GL is missing."""
    if _state.context is None:
        _state.context = _create()
        _state.binding = _bound()
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
    former = _bound()
    context = get()
    own = _state.binding
    if former == own and former.context:
        yield
        return
    if own.context:
        _bind(own)
        try:
            yield
        finally:
            if former.context:
                with suppress(ContextError):  # its program may have ended it
                    _bind(former)
    else:  # not EGL: Windows, macOS
        with context:
            yield


@cache
def _egl() -> ctypes.CDLL | None:
    """The library whose context is current, with the argument types of the functions below; None without EGL."""
    if not sys.platform.startswith("linux"):
        return None
    try:
        egl = ctypes.CDLL(_LINUX["libegl"])
    except OSError:
        return None
    for name in ("eglGetCurrentDisplay", "eglGetCurrentContext", "eglGetCurrentSurface"):
        getattr(egl, name).restype = ctypes.c_void_p
    egl.eglMakeCurrent.argtypes = [ctypes.c_void_p] * 4
    return egl


def _bound() -> _Binding:
    """The context that is current in this thread."""
    egl = _egl()
    if egl is None:
        return _NONE
    draw, read = (egl.eglGetCurrentSurface(which) or 0 for which in (0x3059, 0x305A))  # EGL_DRAW, EGL_READ
    return _Binding(egl.eglGetCurrentDisplay() or 0, draw, read, egl.eglGetCurrentContext() or 0)


def _bind(binding: _Binding) -> None:
    egl = _egl()
    assert egl is not None  # a binding was found by it
    display = binding.display or egl.eglGetCurrentDisplay()  # to unbind, a display is named
    if not egl.eglMakeCurrent(display, binding.draw, binding.read, binding.context):
        raise ContextError(
            f"EGL does not make the context current (error {egl.eglGetError():#x}). A program that calls eglTerminate, "
            "as pyrender's OffscreenRenderer.delete() does, ends all contexts of the process; use a process for each"
        )


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
        if _state.binding.context and _bound() == _state.binding:
            _bind(_NONE)  # EGL keeps a context that is current
        _state.context.release()
        _state.context, _state.binding = None, _NONE
        atexit.unregister(release)


def renderer() -> str:
    """The driver's own name for what draws, for example 'llvmpipe (LLVM 15.0.6, 256 bits)'."""
    return get().info["GL_RENDERER"]


def is_software() -> bool:
    """Whether the CPU draws: there GPU time queries mean nothing, and time is wall clock around `finish()`."""
    return any(name in renderer() for name in _SOFTWARE_RENDERERS)


def devices() -> list[str]:
    """The EGL devices of this machine, in the order of `AOLAB_DEVICE`; empty where EGL cannot list them."""
    if not sys.platform.startswith("linux"):
        return []
    try:
        egl = ctypes.CDLL(_LINUX["libegl"])
    except OSError:
        return []
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    query_devices = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    query_string = egl.eglGetProcAddress(b"eglQueryDeviceStringEXT")
    if not query_devices or not query_string:
        return []
    handles, count = (ctypes.c_void_p * 32)(), ctypes.c_int()
    devices_of = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)(query_devices)
    if not devices_of(32, handles, ctypes.byref(count)):
        return []
    string_of = ctypes.CFUNCTYPE(ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int)(query_string)
    egl_extensions, egl_drm_device_file = 0x3055, 0x3233  # EGL_EXTENSIONS, EGL_DRM_DEVICE_FILE_EXT
    names = []
    for handle in handles[: count.value]:
        extensions = (string_of(handle, egl_extensions) or b"").decode()
        if "EGL_MESA_device_software" in extensions:
            names.append("software")
        elif "EGL_EXT_device_drm" in extensions:
            names.append(f"hardware {(string_of(handle, egl_drm_device_file) or b'').decode()}".rstrip())
        else:
            names.append("hardware")
    return names


def _create() -> moderngl.Context:
    if not sys.platform.startswith("linux"):
        try:
            return _checked(moderngl.create_context(standalone=True, require=REQUIRED))
        except Exception as error:
            raise ContextError(f"no OpenGL {REQUIRED / 100:.1f} context: {error}; see `aolab doctor`") from error
    reasons = []
    for index in _preferred_devices():
        try:
            settings: dict[str, Any] = {**_LINUX, "device_index": index}
            return _checked(moderngl.create_context(standalone=True, require=REQUIRED, **settings))
        except Exception as error:
            reasons.append(f"device {index}: {error}")
    raise ContextError(
        f"no OpenGL {REQUIRED / 100:.1f} context through EGL ({'; '.join(reasons)}); `aolab doctor` names the remedy"
    )


def _preferred_devices() -> list[int]:
    """Device indices to try: the one of `AOLAB_DEVICE`, else hardware first."""
    listed = devices()
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
