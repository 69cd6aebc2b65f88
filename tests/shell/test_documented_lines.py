"""The command lines of the docs, of README and of CONTRIBUTING have commands, options and values that exist."""

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
import typer

from aolab.shell.app import app

CHECKOUT = Path(__file__).parents[2]
PAGES = [
    *sorted(path for path in (CHECKOUT / "docs").rglob("*.md") if "_build" not in path.parts),
    CHECKOUT / "README.md",
    CHECKOUT / "CONTRIBUTING.md",
]
LINE = re.compile(r"^(?:[A-Z_]+=\S+ )*(?:\.venv/bin/)?aolab (?P<words>[a-z].*)$", re.MULTILINE)
LINES = [
    (page.relative_to(CHECKOUT).as_posix(), match["words"].partition(" #")[0].partition("; ")[0].strip())
    for page in PAGES
    for block in re.findall(r"^```sh\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    for match in LINE.finditer(block.replace("\\\n", " "))
]


def test_the_pages_have_lines():
    assert len(LINES) > 40


@pytest.mark.parametrize(("page", "line"), LINES, ids=lambda text: text)
def test_a_line_is_understood(page, line):
    name, *words = shlex.split(line)
    command: Any = typer.main.get_command(app())
    assert name in command.commands, f"{page}: no command '{name}'"
    command.commands[name].make_context(name, words).close()  # raises for an unknown option or a missing argument
