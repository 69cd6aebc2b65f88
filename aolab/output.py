"""Output files: the path is checked before the work, and the file is replaced atomically after it.

A link is followed: the file that it points to is replaced. A device, a pipe or a terminal is not replaced; the bytes
are written to it.
"""

import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import IO

from .errors import FileError
from .input import as_path

try:
    import fcntl
except ImportError:  # on Windows, where a file that is open cannot be removed anyway
    fcntl = None

LONGEST = 255  # bytes of a file's name, on all common file systems
PREFIX, SUFFIX = ".aolab.", ".part"  # of temporary files
_swept: set[Path] = set()


def check_writable(path: str | PathLike[str]) -> Path:
    """`path` as a `Path`, if a file can be written there; to be called before long work.

    Raises `FileError` that names the obstacle, and `ParameterError` for anything but a path.
    """
    target = as_path(path)
    folder = target.parent
    if len(os.fsencode(target.name)) > LONGEST:
        raise FileError(f"cannot write {target.name[:40]}...: the name has more than {LONGEST} bytes")
    try:
        if not folder.exists():
            raise FileError(f"cannot write {target}: the folder {folder} does not exist")
        if not folder.is_dir():
            raise FileError(f"cannot write {target}: {folder} is not a folder")
        if target.is_dir():
            raise FileError(f"cannot write {target}: it is a folder")
        if _writes_through(target):
            if not os.access(target, os.W_OK):
                raise FileError(f"cannot write {target}: no permission")
            return target
        behind = _behind_links(target).parent
    except (OSError, ValueError) as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"cannot write {str(target)[:80]}: {getattr(error, 'strerror', None) or error}") from error
    if not behind.is_dir():
        raise FileError(f"cannot write {target}: it links to a file in {behind}, which does not exist")
    if not os.access(behind, os.W_OK | os.X_OK):
        raise FileError(f"cannot write {target}: no permission to write in {behind}")
    return target


@contextmanager
def replacing(path: str | PathLike[str]) -> Iterator[IO[bytes]]:
    """A temporary file to write to. It replaces `path` when the block ends; after an error the old file is unchanged.

    A temporary file that a killed process left in the folder is removed. Raises `FileError` if `path` cannot be
    written.
    """
    target = check_writable(path)
    try:
        if _writes_through(target):
            yield from _written_through(target)
        else:
            yield from _replaced(_behind_links(target))
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"cannot write {target}: {error.strerror or error}") from error


def _replaced(target: Path) -> Iterator[IO[bytes]]:
    _remove_leftovers(target.parent)
    with _temporary(target.parent) as file:
        try:
            yield file
            file.close()
            os.chmod(file.name, 0o666 & ~_umask())
            os.replace(file.name, target)
        finally:
            file.close()
            with suppress(FileNotFoundError):
                os.unlink(file.name)


def _temporary(folder: Path) -> IO[bytes]:
    """A new file, locked as long as this process has it open: so another process sees that it is in use."""
    while True:
        file = tempfile.NamedTemporaryFile(dir=folder, prefix=PREFIX, suffix=SUFFIX, delete=False)  # noqa: SIM115
        if fcntl is None:
            return file
        with suppress(OSError):  # some file systems have no locks
            fcntl.flock(file, fcntl.LOCK_EX)
        if os.fstat(file.fileno()).st_nlink:
            return file
        file.close()  # another process removed it before it was locked


def _written_through(target: Path) -> Iterator[IO[bytes]]:
    """The bytes are collected first: some writers seek, and a pipe cannot."""
    collected = BytesIO()
    yield collected
    stream = _standard_stream(os.stat(target))
    if stream is not None and sys.stdout is not None:
        sys.stdout.flush()
    with open(target if stream is None else os.dup(stream), "wb") as file:
        file.write(collected.getbuffer())


def _writes_through(target: Path) -> bool:
    """Whether `target`, also behind a link, must not be replaced: it is no regular file, or standard output."""
    try:
        found = os.stat(target)
    except FileNotFoundError:
        return False
    return not stat.S_ISREG(found.st_mode) or _standard_stream(found) is not None


def _standard_stream(found: os.stat_result) -> int | None:
    """The number of the standard stream that goes to this file."""
    for stream in (1, 2):
        with suppress(OSError):  # it may be closed
            if os.path.samestat(found, os.fstat(stream)):
                return stream
    return None


def _behind_links(target: Path) -> Path:
    return Path(os.path.realpath(target)) if target.is_symlink() else target


def _remove_leftovers(folder: Path) -> None:
    """Remove the temporary files of processes that have ended; once for each folder."""
    if folder in _swept:
        return
    _swept.add(folder)
    for path in folder.glob(f"{PREFIX}*{SUFFIX}"):
        with suppress(OSError), open(path, "rb+") as file:  # a lock that another process has is an OSError
            if fcntl is not None:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            else:
                file.close()
            path.unlink()


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
