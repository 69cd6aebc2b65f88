"""Output files: the path is checked before the work, and the file is replaced atomically after it."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path
from typing import IO

from .errors import FileError


def check_writable(path: str | PathLike[str]) -> Path:
    """`path` as a `Path`, if a file can be written there; to be called before long work.

    Raises `FileError` that names the obstacle.
    """
    target = Path(path)
    folder = target.parent
    if not folder.exists():
        raise FileError(f"cannot write {target}: the folder {folder} does not exist")
    if not folder.is_dir():
        raise FileError(f"cannot write {target}: {folder} is not a folder")
    if target.is_dir():
        raise FileError(f"cannot write {target}: it is a folder")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise FileError(f"cannot write {target}: no permission to write in {folder}")
    return target


@contextmanager
def replacing(path: str | PathLike[str]) -> Iterator[IO[bytes]]:
    """A temporary file to write to. It replaces `path` when the block ends; after an error the old file is unchanged.

    Raises `FileError` if `path` cannot be written.
    """
    target = check_writable(path)
    temporary = None
    try:
        with tempfile.NamedTemporaryFile(dir=target.parent, prefix=f".{target.name}.", delete=False) as file:
            temporary = file.name
            yield file
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, target)
    except OSError as error:
        raise FileError(f"cannot write {target}: {error.strerror or error}") from error
    finally:
        if temporary:
            with suppress(FileNotFoundError):
                os.unlink(temporary)


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
