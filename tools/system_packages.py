"""Print what this machine lacks, one Debian package a line: `python3 tools/system_packages.py`.

Found by trying rather than by asking a package manager, so that drivers from any source count. It runs on a bare
system Python, before anything is installed: standard library only.
"""

import ctypes
import importlib.util
import platform

EGL_PLATFORM_DEVICE_EXT = 0x313F
MOST_DEVICES = 16


def venv_can_be_made() -> bool:
    return all(importlib.util.find_spec(name) for name in ("venv", "ensurepip"))


def loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def an_egl_device_starts() -> bool:
    """Whether any of EGL's devices, graphics card or software, can be initialised: the way moderngl's `egl` goes."""
    egl = ctypes.CDLL("libEGL.so.1")
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    egl.eglGetPlatformDisplay.restype = ctypes.c_void_p
    address = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    if not address:
        return False
    count = ctypes.c_int()
    devices = (ctypes.c_void_p * MOST_DEVICES)()
    ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)(address)(
        MOST_DEVICES, devices, ctypes.byref(count)
    )
    for device in devices[: count.value]:
        display = egl.eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, ctypes.c_void_p(device), None)
        if display and egl.eglInitialize(ctypes.c_void_p(display), None, None):
            return True
    return False


def missing() -> list[str]:
    packages = []
    if not venv_can_be_made():
        packages.append("python3-venv")
    if platform.system() == "Linux":  # Windows and macOS bring their own OpenGL
        packages += [name for name, file in (("libegl1", "libEGL.so.1"), ("libgl1", "libGL.so.1")) if not loads(file)]
        if "libegl1" in packages or not an_egl_device_starts():
            packages.append("libgl1-mesa-dri")
    return packages


if __name__ == "__main__":
    print(*missing(), sep="\n")
