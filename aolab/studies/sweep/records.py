"""Records on disk: one JSON file a case, written atomically, and merged into one Parquet table."""

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import FileError
from ...output import replacing
from .case import plain

if TYPE_CHECKING:
    import pandas as pd

FOLDER, TABLE, PLAN = "records", "sweep.parquet", "sweep.json"


class Records:
    """The records of a folder. A record names its case by a hash, so a sweep resumes where it stopped."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        try:
            (folder / FOLDER).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileError(f"cannot make the folder {folder / FOLDER}: {error.strerror or error}") from error

    def path(self, name: str) -> Path:
        return self.folder / FOLDER / f"{name}.json"

    def load(self, name: str) -> dict[str, Any] | None:
        """The record of a case; None if there is none, or if the file is damaged."""
        try:
            record = json.loads(self.path(name).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return None
        except OSError as error:
            raise FileError(f"cannot read {self.path(name)}: {error.strerror or error}") from error
        return record if isinstance(record, dict) and "status" in record else None

    def store(self, name: str, record: dict[str, Any], files: dict[str, bytes]) -> None:
        """Write the files of a case, then its record; each is there whole or not at all.

        Raises `FileError`, say for a full disk; the records before it stay readable.
        """
        for place, content in files.items():
            target = self.folder / place
            target.parent.mkdir(exist_ok=True)
            with replacing(target) as file:
                file.write(content)
        with replacing(self.path(name)) as file:
            file.write((json.dumps(record, indent=1, ensure_ascii=False) + "\n").encode())

    def keep_plan(self, description: dict[str, Any]) -> None:
        """Write the description of the sweep beside its records."""
        with replacing(self.folder / PLAN) as file:
            file.write((json.dumps(plain({**description, "started": time.time()}), indent=2) + "\n").encode())

    def write_table(self, table: "pd.DataFrame") -> Path:
        """Write the table as Parquet."""
        path = self.folder / TABLE
        with replacing(path) as file:
            table.to_parquet(file)
        return path
