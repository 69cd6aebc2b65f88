"""Docstrings are written to be read in an editor; what reStructuredText asks for beyond that is added here."""

import re
from typing import Any

from sphinx.application import Sphinx

# `Instance`s: the end of a literal has to be told apart from the word that goes on
LITERAL_IN_WORD = re.compile(r"(`[^`]+`)(?=\w)")


def complete(app: Sphinx, what: str, name: str, thing: object, options: Any, lines: list[str]) -> None:
    lines[:] = [LITERAL_IN_WORD.sub(r"\1\\ ", line) for line in lines]


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", complete)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
