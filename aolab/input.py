"""Files that are read: kind and size are checked first, and a budget limits the memory of one scene or picture."""

import os
import re
import stat
from os import PathLike
from pathlib import Path

from .errors import FileError, ParameterError

DEFAULT_MEMORY = 2_000_000_000  # bytes: fits a laptop of 8 GB beside the driver's own copy of the textures
UNITS = {"": 1, "B": 1, "KB": 10**3, "MB": 10**6, "GB": 10**9, "TB": 10**12}


class TooLarge(FileError):
    """A file or picture that is larger than a limit: refused before it is read, even where it is only a part."""


class Budget:
    """The bytes that one scene or one picture may take: the files read, and the arrays decoded from them.

    `limit` is a number of bytes or a text such as "4GB"; None takes `AOLAB_MEMORY`, else 2 GB. Raises
    `ParameterError` for another text.
    """

    def __init__(self, limit: int | str | None = None) -> None:
        text = os.environ.get("AOLAB_MEMORY") or DEFAULT_MEMORY if limit is None else limit
        match = re.fullmatch(r"\s*(\d{1,15}(?:\.\d{1,9})?)\s*([KMGT]?B)?\s*", str(text), re.IGNORECASE)
        if match is None:
            source = "AOLAB_MEMORY" if limit is None else "memory"
            raise ParameterError(f"{source} = {text!r:.80} is no size; write bytes, or a number with MB or GB: 4GB")
        self.limit = int(float(match[1]) * UNITS[(match[2] or "").upper()])
        self.taken = 0

    def take(self, size: int, what: str) -> None:
        """Count `size` bytes for `what`. Raises `TooLarge` beyond the limit, before anything is read or decoded."""
        if self.taken + size > self.limit:
            held = f" beside the {_text(self.taken)} in use" if self.taken else ""
            raise TooLarge(
                f"{what} is refused: it needs {_text(size)} of memory{held}, and the limit is {_text(self.limit)}; "
                f"the environment variable AOLAB_MEMORY raises the limit (AOLAB_MEMORY={_enough(self.taken + size)})"
            )
        self.taken += size


def as_path(path: object, what: str = "path") -> Path:
    """`path` as a `Path`. Raises `ParameterError` for anything but a text or a path; errors call it `what`."""
    if isinstance(path, (str, os.PathLike)):
        return Path(path)
    raise ParameterError(f"{what} = {path!r:.80} is not a path: give a text or a pathlib.Path")


def read_file(path: str | PathLike[str], what: str, budget: Budget) -> bytes:
    """The bytes of the regular file `path`, which errors call `what`.

    Raises `FileError` for a file that is missing, is a directory, a pipe or a device, or does not fit the budget.
    """
    try:
        # a pipe without a writer would block on opening; the check is made on the open file, not on its name
        with open(path, "rb", opener=_without_blocking) as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise FileError(f"{what} is {kind(status.st_mode)}; give a regular file")
            budget.take(status.st_size, what)
            return file.read(status.st_size)
    except IsADirectoryError:
        raise FileError(f"{what} is a directory; give a regular file") from None
    except FileError:
        raise
    except FileNotFoundError:
        raise FileError(f"no file {path}") from None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        raise FileError(f"{what} cannot be read: {getattr(error, 'strerror', None) or error}") from None


def read_text(path: str | PathLike[str], what: str) -> str:
    """The text of a file in UTF-8, without the mark of byte order that some editors write.

    Raises `FileError` as `read_file` does, and for another encoding.
    """
    data = read_file(path, what, Budget())
    try:
        return data.decode().removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        raise FileError(f"{what} is no text in UTF-8: byte {error.start} is {data[error.start]:#x}") from None


def kind(mode: int) -> str:
    """A file that is no regular file, in words; `mode` as `os.stat` gives it."""
    kinds = {
        stat.S_IFDIR: "a directory",
        stat.S_IFIFO: "a named pipe",
        stat.S_IFCHR: "a device",
        stat.S_IFBLK: "a device",
        stat.S_IFSOCK: "a socket",
    }
    return kinds.get(stat.S_IFMT(mode), "no regular file")


def _without_blocking(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _text(size: int) -> str:
    """A size with three digits: 3.22 GB."""
    unit = next(unit for unit in ("TB", "GB", "MB", "KB", "B") if size >= UNITS[unit] or unit == "B")
    return f"{size / UNITS[unit]:.3g} {unit}"


def _enough(size: int) -> str:
    return f"{-(-size // 10**9)}GB"
