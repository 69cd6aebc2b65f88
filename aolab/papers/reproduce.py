"""`aolab reproduce`: a paper's figures and tables, and whether their claims hold, as FIGURE.png and FIGURE.json."""

import json
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from ..errors import FileError, ParameterError, suggestion
from ..gl import context
from ..gl.texture import Size, check_size
from ..output import check_writable, replacing
from ..version import __version__
from . import PAPERS
from .figure import Figure

LEAST_SIZE = (96, 54)  # pixels: smaller pictures have no pixels on the surfaces that some figures measure


def figures(paper: str, figure: str | None = None) -> dict[str, Callable[..., Figure]]:
    """{name: function} of a paper's figures and tables, or of one of them.

    Each function takes `size`, (width, height) in pixels of one picture, or of a table's largest measurement; it has
    a default. Raises `ParameterError` for an unknown paper or figure.
    """
    if paper not in PAPERS:
        raise ParameterError(f"no paper '{paper}'{suggestion(paper, PAPERS)}")
    known: dict[str, Callable[..., Figure]] = import_module(f"{__package__}.{paper}").FIGURES
    if figure is None:
        return known
    if figure not in known:
        likely = [name for name in known if figure.isdigit() and name == f"fig{figure}"]
        if likely:
            raise ParameterError(f"paper '{paper}' has no '{figure}' here; did you mean '{likely[0]}'?")
        raise ParameterError(f"paper '{paper}' has no '{figure}' here{suggestion(figure, known)}")
    return {figure: known[figure]}


def reproduce(
    paper: str, figure: str | None, folder: Path, size: Size | None = None
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Draw a paper's figures, or one of them, and write FIGURE.png and FIGURE.json into `folder`; make it if need be.

    Yields (name, the JSON's content) after each is written. Raises `ParameterError` and `FileError` before the work.
    """
    chosen = figures(paper, figure)
    arguments = {} if size is None else {"size": _checked(size)}
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"cannot make the folder {folder}: {error.strerror or error}") from error
    for name in chosen:
        for suffix in ("png", "json"):
            check_writable(folder / f"{name}.{suffix}")
    for name, draw in chosen.items():
        result = draw(**arguments)
        content = {
            "paper": paper,
            "figure": name,
            "claim": result.claim,
            "holds": result.holds,
            "verdict": result.verdict,
            "finding": result.finding,
            "needs": [need.to_dict() for need in result.needs],
            "numbers": result.numbers,
            "renderer": context.renderer(),
            "aolab": __version__,
        }
        with replacing(folder / f"{name}.png") as file:
            result.picture.save(file, "PNG")
        with replacing(folder / f"{name}.json") as file:
            file.write((json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode())
        yield name, content


def _checked(size: Size) -> Size:
    if size[0] < LEAST_SIZE[0] or size[1] < LEAST_SIZE[1]:
        raise ParameterError(
            f"size = {size[0]}x{size[1]} is too small for a figure: at least {LEAST_SIZE[0]}x{LEAST_SIZE[1]}"
        )
    return check_size(size)
