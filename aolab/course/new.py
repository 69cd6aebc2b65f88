"""A folder for an exercise of a lecturer's own: a small one that works, or a copy of one of the package's."""

import shutil
from pathlib import Path

from ..errors import FileError
from .exercise import SPEC, TASK, exercise

TEMPLATE = """title = "My exercise"
learn = "One sentence: the idea that a student understands afterwards."
minutes = 30
paper = "Author year, section"
# a module as text, with the parameters of all checks; `aolab modules` lists them
module = "ssao?radius=0.5&directions=16&falloff=0.0&filter=none"

# A file that students get. `file` is a shader beside this file, or else one of aolab's; `inline` are includes whose
# functions they can see and edit, too. `replaces` is the shader of the pass, if that has another name than `file`.
[[shader]]
file = "ssao.frag"

# A step: functions to write, and their checks. The order is that of the work.
[[step]]
name = "mean"
title = "The open share of the hemisphere"
task = "the visibility is the share of directions that are open; 1 in the background"
expect = "dark creases, and noise"
set = {}  # parameters of the module for this step, as in { directions = 4 }

# function = the body that students find; a signature, as in "firstBlocked(Receiver, int)", chooses one of several
[step.holes]
main = "visibility = 1.0;"

# kinds: range (low, high) · exact (scene = plane with a `value`, wall, ball) · solution · truth (rays) · hidden
[[step.check]]
kind = "range"
points = 1

[[step.check]]
kind = "solution"
tolerance = 0.05  # of the picture's contrast
points = 3

[[step.check]]
kind = "hidden"
points = 1

# A mistake: edits of the solution that make it. `aolab exercise check` names it by the picture.
[[step.mistake]]
name = "occlusion in place of visibility"
hint = "Black and white are exchanged: this is the occlusion. The visibility is 1 minus it."
edits = { "pow(1.0 - blockedDirections" = "pow(blockedDirections" }
"""

PAGE = """Explain the idea here, with the equation and a picture. The title and the table of the steps are added to it.

Write the function `main` of `ssao.frag`.
"""


def new(folder: str | Path, *, like: str | Path | None = None) -> Path:
    """Make the folder of an exercise, and return its path: a template, or a copy of the exercise `like`.

    `aolab exercise start FOLDER` then makes a student's folder of it. Raises `FileError` if the folder exists.
    """
    target = Path(folder)
    try:
        if like is not None:
            shutil.copytree(exercise(like).folder, target)
        else:
            target.mkdir(parents=True)
            (target / SPEC).write_text(TEMPLATE, encoding="utf-8")
            (target / TASK).write_text(PAGE, encoding="utf-8")
    except FileExistsError:
        raise FileError(f"{target} exists already; name another folder") from None
    except OSError as error:
        raise FileError(f"cannot write {target}: {error.strerror or error}") from error
    return target
