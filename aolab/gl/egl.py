"""EGL, the maker of contexts on Linux: its devices, contexts of our own, and the context that is current.

A program beside aolab may end EGL's display, and all contexts with it: pyrender's `OffscreenRenderer.delete()` calls
`eglTerminate`. A context is therefore made on a display that other programs have no handle of, where EGL can give one.
"""

import ctypes
import sys
from collections.abc import Iterator
from functools import cache
from typing import Any, NamedTuple

from ..errors import ContextError

# by their loader names: a search by linker name misses libraries in private folders (conda, LD_LIBRARY_PATH)
_LIBRARY, _GL = "libEGL.so.1", "libGL.so.1"
_NONE, _TRUE = 0x3038, 1
_EXTENSIONS, _DRM_DEVICE_FILE, _DEVICE = 0x3055, 0x3233, 0x322C
_PLATFORM_DEVICE, _PLATFORM_SURFACELESS, _TRACK_REFERENCES = 0x313F, 0x31DD, 0x3352
_SURFACE_TYPE, _PBUFFER_BIT, _RENDERABLE_TYPE, _OPENGL_BIT, _OPENGL_API = 0x3033, 0x0001, 0x3040, 0x0008, 0x30A2
_MAJOR, _MINOR, _PROFILE_MASK, _CORE_PROFILE = 0x3098, 0x30FB, 0x30FD, 0x0001
_DRAW, _READ = 0x3059, 0x305A
_MOST_DEVICES = 32


class Binding(NamedTuple):
    """The EGL handles of a context that is current in a thread; all are 0 where none is."""

    display: int = 0
    draw: int = 0
    read: int = 0
    context: int = 0


UNBOUND = Binding()


@cache
def _egl() -> ctypes.CDLL | None:
    """The library, with the types of the functions below; None without EGL."""
    if not sys.platform.startswith("linux"):
        return None
    try:
        egl = ctypes.CDLL(_LIBRARY)
    except OSError:
        return None
    pointer, number = ctypes.c_void_p, ctypes.c_int
    for name, result, *arguments in (
        ("eglGetCurrentDisplay", pointer),
        ("eglGetCurrentContext", pointer),
        ("eglGetCurrentSurface", pointer, number),
        ("eglMakeCurrent", number, pointer, pointer, pointer, pointer),
        ("eglGetProcAddress", pointer, ctypes.c_char_p),
        ("eglInitialize", number, pointer, pointer, pointer),
        ("eglBindAPI", number, number),
        ("eglChooseConfig", number, pointer, pointer, pointer, number, pointer),
        ("eglCreateContext", pointer, pointer, pointer, pointer, pointer),
        ("eglDestroyContext", number, pointer, pointer),
    ):
        function = getattr(egl, name)
        function.restype, function.argtypes = result, arguments
    return egl


def _extension(name: str, result: Any, *arguments: Any) -> Any:
    """A function that only an extension has; None where EGL lacks it."""
    egl = _egl()
    address = egl.eglGetProcAddress(name.encode()) if egl else None
    return ctypes.CFUNCTYPE(result, *arguments)(address) if address else None


def bound() -> Binding:
    """The context that is current in this thread."""
    egl = _egl()
    if egl is None:
        return UNBOUND
    draw, read = (egl.eglGetCurrentSurface(which) or 0 for which in (_DRAW, _READ))
    return Binding(egl.eglGetCurrentDisplay() or 0, draw, read, egl.eglGetCurrentContext() or 0)


def is_bound(binding: Binding) -> bool:
    """Whether the context of `binding` is current in this thread: the quick form of a comparison with `bound()`."""
    egl = _egl()
    return egl is not None and binding.context != 0 and egl.eglGetCurrentContext() == binding.context


def bind(binding: Binding) -> None:
    """Make a context current in this thread, or none. Raises `ContextError` where the context has been ended."""
    egl = _egl()
    assert egl is not None  # a binding was found by it
    display = binding.display or egl.eglGetCurrentDisplay()  # to unbind, a display is named
    if not egl.eglMakeCurrent(display, binding.draw, binding.read, binding.context):
        raise ContextError(
            f"EGL does not make the context current (error {egl.eglGetError():#x}). A program that calls eglTerminate, "
            "as pyrender's OffscreenRenderer.delete() does, ends the contexts of its display, and this driver gives "
            "aolab no display of its own; use a process for each"
        )


@cache
def _handles() -> tuple[int, ...]:
    query = _extension("eglQueryDevicesEXT", ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
    handles, count = (ctypes.c_void_p * _MOST_DEVICES)(), ctypes.c_int()
    if query is None or not query(_MOST_DEVICES, handles, ctypes.byref(count)):
        return ()
    return tuple(handle or 0 for handle in handles[: count.value])


def devices() -> list[str]:
    """The EGL devices of this machine, in the order of `AOLAB_DEVICE`; empty where EGL cannot list them."""
    string = _extension("eglQueryDeviceStringEXT", ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int)
    if string is None:
        return []
    names = []
    for handle in _handles():
        extensions = (string(handle, _EXTENSIONS) or b"").decode()
        if "EGL_MESA_device_software" in extensions:
            names.append("software")
        elif "EGL_EXT_device_drm" in extensions:
            names.append(f"hardware {(string(handle, _DRM_DEVICE_FILE) or b'').decode()}".rstrip())
        else:
            names.append("hardware")
    return names


class Context:
    """A new OpenGL core context of the device `index`, current in this thread; `moderngl` draws with it.

    `version` is 330 for OpenGL 3.3. Raises `ContextError` where EGL makes none.
    """

    def __init__(self, index: int, version: int) -> None:
        egl = _egl()
        if egl is None:
            raise ContextError(f"no {_LIBRARY}")
        self._egl = egl
        reasons = []
        for display in _displays(index):
            context = self._made(display, version) if display else None
            if display and context:
                self.binding = Binding(display, 0, 0, context)
                break
            reasons.append(f"{egl.eglGetError():#x}")
        else:
            raise ContextError(f"EGL error {', '.join(dict.fromkeys(reasons)) or 'none: no such device'}")

    def _made(self, display: int, version: int) -> int | None:
        """A context of the display, current in this thread."""
        egl, count, config = self._egl, ctypes.c_int(), ctypes.c_void_p()
        wanted = (ctypes.c_int * 5)(_SURFACE_TYPE, _PBUFFER_BIT, _RENDERABLE_TYPE, _OPENGL_BIT, _NONE)
        kind = (ctypes.c_int * 7)(
            _MAJOR, version // 100, _MINOR, version // 10 % 10, _PROFILE_MASK, _CORE_PROFILE, _NONE
        )  # fmt: skip
        if not egl.eglInitialize(display, None, None) or not egl.eglBindAPI(_OPENGL_API):
            return None
        if not egl.eglChooseConfig(display, wanted, ctypes.byref(config), 1, ctypes.byref(count)) or not count.value:
            return None
        context = egl.eglCreateContext(display, config, None, kind)
        if context and not egl.eglMakeCurrent(display, None, None, context):
            egl.eglDestroyContext(display, context)
            return None
        return context

    def load_opengl_function(self, name: str) -> int:
        """The address of a function of OpenGL; 0 if there is none."""
        address = self._egl.eglGetProcAddress(name.encode())
        found = None if address else getattr(_gl(), name, None)
        return address or (ctypes.cast(found, ctypes.c_void_p).value if found else None) or 0

    def __enter__(self) -> None:
        bind(self.binding)

    def __exit__(self, *_: object) -> None:
        pass

    def release(self) -> None:
        """End the context. EGL keeps a context that is current."""
        if bound() == self.binding:
            bind(UNBOUND)
        self._egl.eglDestroyContext(self.binding.display, self.binding.context)


@cache
def _gl() -> ctypes.CDLL | None:
    try:
        return ctypes.CDLL(_GL)
    except OSError:
        return None


def _displays(index: int) -> Iterator[int | None]:
    """Displays of a device, first those that no other program can end.

    NVIDIA's driver gives a display of its own to those who ask for one that counts its references. Mesa has a display
    without a window system, of the device that Mesa chooses. The last is the device's common display.
    """
    display = _extension("eglGetPlatformDisplayEXT", *[ctypes.c_void_p, ctypes.c_int] + [ctypes.c_void_p] * 2)
    handles = _handles()
    if display is None:
        return
    if not handles:  # EGL cannot list devices
        yield display(_PLATFORM_SURFACELESS, None, None)
        return
    if index < len(handles):
        yield display(_PLATFORM_DEVICE, handles[index], (ctypes.c_int * 3)(_TRACK_REFERENCES, _TRUE, _NONE))
        surfaceless = display(_PLATFORM_SURFACELESS, None, None)
        if surfaceless and _device(surfaceless) == handles[index]:
            yield surfaceless
        yield display(_PLATFORM_DEVICE, handles[index], None)


def _device(display: int) -> int | None:
    """The device of a display, once that is initialised."""
    egl, found = _egl(), ctypes.c_void_p()
    query = _extension("eglQueryDisplayAttribEXT", ctypes.c_uint, ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p)
    if egl is None or query is None or not egl.eglInitialize(display, None, None):
        return None
    return found.value if query(display, _DEVICE, ctypes.byref(found)) else None
