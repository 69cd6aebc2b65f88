"""The exceptions of aolab. Every exception that aolab raises on purpose is an `aolab.Error`."""

import difflib
import re
import sys
import warnings
from collections.abc import Callable, Iterable

LONG_WORD = 1000  # characters: longer ones, as of names in a damaged file, are shortened in messages


class Error(Exception):
    """The base class of aolab's exceptions. The message names the value, the place and the alternatives."""

    def __init__(self, message: str = "") -> None:
        super().__init__(_with_short_words(message))


class SceneError(Error, ValueError):
    """A scene, mesh, material, light, camera or environment that cannot be drawn."""


class FileError(Error, OSError):
    """A file that is missing, unreadable, corrupt, refused, or cannot be written."""


class ParameterError(Error, ValueError):
    """An unknown module, parameter, buffer or option, or a value out of its range."""


class ShaderError(Error):
    """A shader that cannot be assembled or compiled. The message names `glsl/FILE:LINE`."""


class ContextError(Error, RuntimeError):
    """No OpenGL context can be created, or the context is used from another thread or process."""


class GpuMemoryError(Error, MemoryError):
    """The driver could not provide the memory for a texture or buffer."""


class Notice(UserWarning):
    """A warning: input was repaired or left out, and the result is still usable. The shell prints it as a note."""

    def __init__(self, message: str = "") -> None:
        super().__init__(_with_short_words(message))


def notice(message: str) -> None:
    """Issue a `Notice`, at the line of the caller's own code that has led to it."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "aolab":
        frame, level = frame.f_back, level + 1
    warnings.warn(message, Notice, stacklevel=level)


LISTED = 32  # names in a message


def shorten(name: str, limit: int = 80) -> str:
    """A name from a file on one line, in printable characters; of a longer one than `limit`, both ends."""
    line = "".join(character if character.isprintable() else "�" for character in name)
    return line if len(line) <= limit else f"{line[: limit // 2]}...{line[-(limit // 2 - 3) :]}"


def _with_short_words(message: str) -> str:
    return re.sub(rf"\S{{{LONG_WORD},}}", lambda word: shorten(word[0]), message)


def suggestion(name: object, known: Iterable[str]) -> str:
    """The end of a message about an unknown `name`: the nearest known name, if any, and the list of known names.

    Of more than `LISTED` names the nearest are listed.
    """
    names = sorted(known)
    shown = names if len(names) <= LISTED else sorted(sorted(names, key=_nearness(name))[-LISTED // 4 :])
    more = f", and {len(names) - len(shown)} more" if len(shown) < len(names) else ""
    listed = f"{', '.join(shown)}{more}" if names else "none"
    if (one := nearest(name, names)) is not None:
        return f"; did you mean '{one}'? (known: {listed})"
    return f"; known: {listed}"


def nearest(name: object, known: Iterable[str]) -> str | None:
    """The known name that `name` is probably meant to be; None if no name is near.

    Case does not count, and the same letters in another order are nearest: `ssoa` is `ssao` rather than `ssdo`.
    """
    nearness = _nearness(name)
    found = max(sorted(known), key=nearness, default="")
    return found if found and nearness(found) >= 0.6 else None


def _nearness(name: object) -> Callable[[str], float]:
    written = str(name).lower()
    matcher = difflib.SequenceMatcher(b=written)

    def nearness(candidate: str) -> float:
        matcher.set_seq1(candidate.lower())
        return matcher.ratio() + (sorted(candidate.lower()) == sorted(written))

    return nearness
