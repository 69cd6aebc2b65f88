"""A runner of commands in an empty folder, for all tests of commands."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from aolab.shell import cli


@dataclass
class Outcome:
    code: int
    out: str
    err: str


@pytest.fixture
def aolab(gl, monkeypatch, capsys, tmp_path) -> Callable[..., Outcome]:
    """Runs a command in an empty folder: `aolab("render", "boxes")`."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str | Path) -> Outcome:
        monkeypatch.setattr(sys, "argv", ["aolab", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        code = ended.value.code
        captured = capsys.readouterr()
        return Outcome(0 if code is None else int(code), captured.out, captured.err)

    return run
