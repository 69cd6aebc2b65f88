"""Libraries that aolab imports only for some work: their purpose, and the command that installs them here."""

import importlib
import importlib.util
import os
import shlex
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .errors import ParameterError


@dataclass(frozen=True)
class Extra:
    """`module` is imported for `purpose`; `package` is the name that the package index has for it."""

    module: str
    package: str
    purpose: str


# The libraries of the first three are dependencies, but not every platform has a wheel of them.
EXTRAS = {
    "embree": Extra("embreex", "embreex", "ray tracing"),
    "flip": Extra("flip_evaluator", "flip-evaluator", "the error measure FLIP"),
    "pictures": Extra("matplotlib", "matplotlib", "a picture with a colour map"),
    "sweep": Extra("distributed", "pandas pyarrow distributed", "a parameter sweep"),
    "xarray": Extra("xarray", "xarray", "the array of a sweep"),
    "film": Extra("av", "av", "a film in .mp4"),
    "view": Extra("glfw", "glfw", "a window"),
    "tune": Extra("optuna", "optuna", "fitting parameters"),
    "mitsuba": Extra("mitsuba", "mitsuba", "a path tracer as second opinion"),
    "draco": Extra("DracoPy", "DracoPy", "a glTF file that Draco compressed"),
    "meshopt": Extra("meshopt", "meshopt", "a glTF file that meshoptimizer compressed"),
    "notebook": Extra("anywidget", "anywidget", "a widget in a notebook"),
    "jupyter": Extra("IPython", "jupyterlab", "a frame shown in a notebook"),
    "pyvista": Extra("pyvista", "pyvista", "a race against VTK's ambient occlusion"),
    "open3d": Extra("open3d", "open3d", "a race against Open3D's ambient occlusion"),
    "pyrender": Extra("pyrender", "scikit-robot-pyrender", "a pyrender scene as input"),
}


def is_installed(name: str) -> bool:
    """Whether the library of `EXTRAS[name]` is found; the library is not imported."""
    return importlib.util.find_spec(EXTRAS[name].module) is not None


def need(name: str, otherwise: str = "") -> Any:
    """Import the library of `EXTRAS[name]` and return it; `otherwise` as for `missing`, which is raised without it."""
    try:
        return importlib.import_module(EXTRAS[name].module)
    except ImportError as error:
        raise missing(name, error, otherwise) from error


def missing(name: str, error: ImportError, otherwise: str = "") -> ParameterError:
    """The exception for a library that cannot be imported. `otherwise` ends its message: a way without the library."""
    extra = EXTRAS[name]
    return ParameterError(
        f"{extra.purpose} needs {extra.package}: {install_command(extra.package)}{otherwise} ({error})"
    )


def install_command(package: str) -> str:
    """The command that installs `package` into the environment of this process: notebook, pipx, pip or uv."""
    if "ipykernel" in sys.modules:
        return f"%pip install {package}"
    if (Path(sys.prefix) / "pipx_metadata.json").exists():
        return f"pipx inject aolab {package}"
    python = _quoted(sys.executable)
    if importlib.util.find_spec("pip") is None and shutil.which("uv"):
        return f"uv pip install --python {python} {package}"
    return f"{python} -m pip install {package}"


def _quoted(path: str) -> str:
    return f'"{path}"' if os.name == "nt" else shlex.quote(path)
