"""The files that a picture's command writes: picture, buffers, statistics."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import FileError
from ..output import check_writable, replacing
from ..pictures.buffer_files import check_suffix
from ..pictures.buffers import scale_in_words
from ..pictures.display import frame_pixels
from ..pictures.metadata import save_png
from ..pipeline.frame import Frame


@dataclass(frozen=True)
class Files:
    """`picture` shows `buffer`; `buffers` and `stats` are written if they are not None."""

    picture: Path
    buffer: str = "image"
    buffers: Path | None = None
    stats: Path | None = None

    def check(self) -> None:
        """Raise `FileError` if a file cannot be written; to be called before the work."""
        check_picture(self.picture)
        if self.buffers:
            check_suffix(self.buffers)
        paths = [path for path in (self.picture, self.buffers, self.stats) if path is not None]
        for path in paths:
            check_writable(path)
        if len({path.resolve() for path in paths}) < len(paths):
            raise FileError(f"cannot write two things to one file: {', '.join(map(str, paths))}")

    def write(self, frame: Frame) -> str:
        """Write the files, and return a line about the picture."""
        line = str(self.picture)
        if self.buffer == "image":
            frame.save(self.picture)
        else:
            scale = scale_in_words(self.buffer, frame[self.buffer])
            save_png(
                self.picture, frame_pixels(frame, self.buffer), frame.info | {"buffer": self.buffer, "scale": scale}
            )
            line += f": {self.buffer}, {scale}"
        if self.buffers:
            frame.save_buffers(self.buffers)
        if self.stats:
            write_json(self.stats, frame.stats())
        return line


def check_picture(path: Path) -> None:
    """Raise `FileError` if a picture cannot be written to `path`."""
    if path.suffix.lower() != ".png":
        raise FileError(f"cannot write {path}: images are written as .png")
    check_writable(path)


def write_json(path: Path, value: Any) -> None:
    """Write a value as JSON; replaces the file atomically."""
    with replacing(path) as file:
        file.write((json.dumps(value, indent=2) + "\n").encode())
