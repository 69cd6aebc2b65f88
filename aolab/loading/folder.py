"""What a model file may read besides itself: files inside its own folder, nothing else."""

import re
from pathlib import Path
from urllib.parse import unquote

from ..errors import FileError

_URL = re.compile(r"[a-z][a-z0-9+.-]*:", re.IGNORECASE)  # also the drive letter of a Windows path


def decoded(data: bytes) -> str:
    """The text of an OBJ or MTL file, whose encoding nothing says: UTF-8, or else Latin-1, as old exporters write."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


class Folder:
    """The folder of the model file `model`, with the part of trimesh's resolver interface that its loaders use.

    trimesh swallows what a resolver raises, so it is kept: `refused` (errors), `missing` (names), and what was `read`.
    """

    def __init__(self, model: Path) -> None:
        self.model = model
        self.file_name = model.stem  # trimesh names the meshes of an OBJ after it
        self.root = model.parent.resolve()
        self.refused: list[FileError] = []
        self.missing: list[str] = []
        self.read: dict[str, bytes] = {}

    def get(self, name: str) -> bytes:
        """The contents of the file `name`, a path relative to the folder, `/` or `\\` between its parts.

        Raises `FileError` for a name that leaves the folder or is a URL, `FileNotFoundError` for a missing file.
        """
        try:
            path = self._find(name)
        except FileError as error:
            self.refused.append(error)
            raise
        if path is None:
            self.missing.append(name)
            raise FileNotFoundError(name)
        data = path.read_bytes()
        self.read[name] = decoded(data).encode() if path.suffix.lower() == ".mtl" else data
        return self.read[name]

    __getitem__ = get

    def _find(self, name: str) -> Path | None:
        # glTF percent-encodes its URIs, and MTL does not: what is on the disk decides
        candidates = [candidate.strip().replace("\\", "/") for candidate in (name, unquote(name))]
        for candidate in candidates:
            if _URL.match(candidate):
                raise FileError(f"{self.model} refers to '{name}', a URL or absolute path; it is not fetched")
            try:
                path = (self.root / candidate).resolve()
                inside = path.is_relative_to(self.root)
            except (OSError, ValueError, RuntimeError) as error:  # a loop of links, a NUL, too long a name
                raise FileError(f"{self.model} refers to '{name}', which is no file name: {error}") from error
            if not inside:
                raise FileError(f"{self.model} refers to '{name}', outside its folder {self.root}; it is not read")
            if path.is_file():
                return path
        return None
