"""The folders of shaders, scenes and exercises: from an environment variable, else the package or the checkout."""

import os
from functools import cache
from pathlib import Path

from .errors import FileError

_PACKAGE = Path(__file__).resolve().parent


@cache
def _find(folder: str, variable: str) -> Path:
    candidates = [
        _PACKAGE / folder,
        _PACKAGE.parent / folder,
        _PACKAGE.parent / "examples" / folder,
    ]  # the installed package; the checkout, which has no aolab/glsl
    if override := os.environ.get(variable):
        candidates = [Path(override).resolve()]
    for candidate in candidates:
        if candidate.is_dir():
            return candidate
    raise FileError(f"no folder {' or '.join(map(str, candidates))}; set {variable} to the path of a folder {folder}/")


def glsl() -> Path:
    """The folder of the shaders; `AOLAB_GLSL` overrides it."""
    return _find("glsl", "AOLAB_GLSL")


def scenes() -> Path:
    """The folder of the scenes; `AOLAB_SCENES` overrides it."""
    return _find("scenes", "AOLAB_SCENES")


def exercises() -> Path:
    """The folder of the exercises; `AOLAB_EXERCISES` overrides it."""
    return _find("exercises", "AOLAB_EXERCISES")
