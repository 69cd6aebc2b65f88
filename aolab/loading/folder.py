"""The files that a model file may read besides itself: those inside its own folder, nothing else."""

import codecs
import re
from pathlib import Path
from urllib.parse import unquote

from ..errors import FileError, shorten
from ..input import Budget, read_file

_URL = re.compile(r"[a-z][a-z0-9+.-]*:", re.IGNORECASE)  # also the drive letter of a Windows path
BEGINNING = 64  # bytes of a file that show its encoding
UTF_16 = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}


def decoded(data: bytes) -> str:
    """The text of an OBJ or MTL file, which does not state its encoding, with "\\n" between its lines.

    UTF-8, UTF-16 where a byte order mark or every second byte of the beginning shows it, or else Latin-1, as old
    exporters write.
    """
    try:
        text = data.decode(utf_16(data) or "utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def utf_16(data: bytes) -> str | None:
    """The name of the encoding of a text in UTF-16; None for another one."""
    low, high = data[:BEGINNING:2], data[1:BEGINNING:2]
    if all(low) and not any(high) and high:  # a text in a Latin alphabet: every second byte is 0
        return "utf-16-le"
    if all(high) and not any(low) and high:
        return "utf-16-be"
    return UTF_16.get(data[:2])


class Folder:
    """The folder of the model file `model`; `budget` counts all that is read from it."""

    def __init__(self, model: Path, budget: Budget) -> None:
        self.model, self.budget = model, budget
        self.root = model.parent.resolve()

    def get(self, name: str) -> bytes:
        """The contents of the file `name`, a path relative to the folder, `/` or `\\` between its parts.

        Raises `FileError` for a name that leaves the folder or is a URL, `FileNotFoundError` for a missing file.
        """
        path = self._find(name)
        if path is None:
            raise FileNotFoundError(name)
        return read_file(path, f"'{shorten(name)}'", self.budget)

    def _find(self, name: str) -> Path | None:
        shown = f"'{shorten(name)}'"
        # glTF percent-encodes its URIs, and MTL does not: the file that exists decides
        candidates = [candidate.strip().replace("\\", "/") for candidate in (name, unquote(name))]
        for candidate in candidates:
            if _URL.match(candidate):
                raise FileError(f"{shown} is a URL or absolute path; it is not fetched")
            try:
                path = (self.root / candidate).resolve()
                inside = path.is_relative_to(self.root)
                found = inside and path.exists() and not path.is_dir()
            except (OSError, ValueError, RuntimeError):  # a loop of links, a NUL, too long a name
                raise FileError(f"{shown} is no file name") from None
            if not inside:
                raise FileError(f"{shown} lies outside its folder {self.root}; it is not read")
            if found:
                return path
        return None
