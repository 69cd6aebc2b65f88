"""Docstrings are written for the editor; this extension adds the syntax that reStructuredText needs."""

import re
from typing import Any

from sphinx.application import Sphinx

# `Instance`s: reStructuredText needs an escaped space between the end of a literal and the following letter
LITERAL_IN_WORD = re.compile(r"(`[^`]+`)(?=\w)")


def complete(app: Sphinx, what: str, name: str, thing: object, options: Any, lines: list[str]) -> None:
    lines[:] = [LITERAL_IN_WORD.sub(r"\1\\ ", line) for line in lines]


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", complete)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
