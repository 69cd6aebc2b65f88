"""The folder that a student starts with: the task, the shaders with holes, and a notebook."""

import json
import os
import shutil
from pathlib import Path
from typing import Any

from .. import paths
from ..errors import FileError
from . import otter
from .check import MARK
from .exercise import TASK, Exercise, exercise

NOTEBOOK = "exercise.ipynb"


def start(name: str | Path, folder: str | Path | None = None) -> Path:
    """Make the folder of an exercise, by default one of its name here, and return its path.

    Raises `FileError` if the folder has files already, and `ParameterError` for an unknown exercise.
    """
    one = exercise(name)
    target = Path(one.name if folder is None else folder)
    try:
        if target.exists() and (not target.is_dir() or any(target.iterdir())):
            raise FileError(f"{target} exists already and is not an empty folder; name another one")
        target.mkdir(parents=True, exist_ok=True)
        for path, text in files(one, target).items():
            (target / path).parent.mkdir(exist_ok=True)
            (target / path).write_text(text, encoding="utf-8")
        for further in one.spec.files:
            shutil.copy(one.folder / further, target / further)
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"cannot write {target}: {error.strerror or error}") from error
    return target


def files(one: Exercise, target: Path) -> dict[str, str]:
    """{path: text} of the files in a student's folder, without those that are copied."""
    built_in = one.folder.parent == paths.exercises().resolve()
    named = one.name if built_in else Path(os.path.relpath(one.folder, target.resolve())).as_posix()
    return {
        MARK: f"exercise = {json.dumps(named)}\n",
        TASK: page(one),
        NOTEBOOK: json.dumps(notebook(one), indent=1, ensure_ascii=False) + "\n",
        **{Path(file).name: text for file, text in one.holes.items()},
        **otter.files(one),
    }


def page(one: Exercise) -> str:
    """task.md, with a table of the steps and their points."""
    rows = ["| Step | Functions | Points | The expected picture |", "|---|---|---|---|"]
    for step in one.spec.steps:
        holes = ", ".join(f"`{hole.partition('(')[0]}`" for hole in step.holes)
        points = sum(check.points for check in step.checks)
        rows.append(f"| `{step.name}`: {step.title} | {holes} | {points:g} | {step.expect} |")
    about = f"About {one.spec.minutes} minutes. {one.spec.paper}."
    text = (one.folder / TASK).read_text(encoding="utf-8")
    return f"# {one.spec.title}\n\n{about}\n\n{text.strip()}\n\n## Steps\n\n" + "\n".join(rows) + "\n"


def notebook(one: Exercise) -> dict[str, Any]:
    """A notebook with a cell that checks each step. nbgrader takes a cell's last value as its points."""
    files = ", ".join(f"`{Path(shader.file).name}`" for shader in one.spec.shaders) or "the files of this folder"
    cells = [
        _cell(
            "markdown", f"# {one.spec.title}\n\n`{TASK}` has the task. Edit {files} in an editor, save, and run a cell."
        ),
        _cell("code", "from aolab import course"),
    ]
    for step in one.spec.steps:
        expect = f"\n\nExpected: {step.expect}." if step.expect else ""
        cells.append(_cell("markdown", f"## {step.title}\n\n{step.task[:1].upper()}{step.task[1:]}.{expect}"))
        cells.append(_graded(step.name, sum(check.points for check in step.checks)))
    if one.spec.shaders:
        cells.append(_cell("code", "course.show()"))
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return {
        "cells": [_numbered(n, cell) for n, cell in enumerate(cells)],
        "metadata": metadata,
        "nbformat": 4,
        "nbformat_minor": 5,
    }


def _cell(kind: str, text: str) -> dict[str, Any]:
    code = {"execution_count": None, "outputs": []} if kind == "code" else {}
    return {"cell_type": kind, "metadata": {}, "source": text, **code}


def _graded(step: str, points: float) -> dict[str, Any]:
    cell = _cell("code", f'result = course.check(only="{step}")\nprint(result)\nresult["{step}"].score')
    cell["metadata"] = {
        "nbgrader": {
            "grade": True,
            "grade_id": step,
            "locked": True,
            "points": points,
            "schema_version": 3,
            "solution": False,
            "task": False,
            "cell_type": "code",
        }
    }
    return cell


def _numbered(number: int, cell: dict[str, Any]) -> dict[str, Any]:
    return {**cell, "id": f"cell-{number}"}
