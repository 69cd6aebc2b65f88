"""`aolab reproduce`: a paper's figures and tables, drawn and judged, each as FIGURE.png and FIGURE.json."""

import json
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from .errors import FileError, ParameterError, suggestion
from .gl import context
from .gl.texture import Size, check_size
from .output import check_writable, replacing
from .papers import PAPERS
from .papers.figure import Figure
from .version import __version__


def figures(paper: str) -> dict[str, Callable[..., Figure]]:
    """{name: function} of a paper's figures and tables. Raises `ParameterError` for an unknown paper."""
    if paper not in PAPERS:
        raise ParameterError(f"no paper '{paper}'{suggestion(paper, PAPERS)}")
    return import_module(f"{__package__}.papers.{paper}").FIGURES


def reproduce(paper: str, figure: str | None = None, *, size: Size | None = None) -> Iterator[tuple[str, Figure]]:
    """Draw `figure` of `paper`, or all of them, one after the other: (name, Figure).

    `size` (width, height) is that of one picture, or of a table's largest measurement; None takes each figure's own.
    Raises `ParameterError` for an unknown paper or figure, before anything is drawn.
    """
    known = figures(paper)
    if figure is not None and figure not in known:
        raise ParameterError(f"paper '{paper}' has no '{figure}' here{suggestion(figure, known)}")
    arguments = {} if size is None else {"size": check_size(size)}
    chosen = known if figure is None else {figure: known[figure]}
    return ((name, draw(**arguments)) for name, draw in chosen.items())


def reproduce_command(
    paper: str, figure: str | None, folder: Path, size: Size | None
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Draw, and write FIGURE.png and FIGURE.json into `folder`, which is made; yields (name, the JSON's content)."""
    drawn = reproduce(paper, figure, size=size)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"cannot make the folder {folder}: {error.strerror or error}") from error
    check_writable(folder / f"{figure or 'figure'}.png")
    for name, result in drawn:
        content = {
            "paper": paper,
            "figure": name,
            "claim": result.claim,
            "holds": result.holds,
            "numbers": result.numbers,
            "renderer": context.renderer(),
            "aolab": __version__,
        }
        with replacing(folder / f"{name}.png") as file:
            result.picture.save(file, "PNG")
        with replacing(folder / f"{name}.json") as file:
            file.write((json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode())
        yield name, content
