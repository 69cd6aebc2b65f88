"""`aolab exercise`: list, start, check, show, grade, new."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Context, Exit, Option, Typer

from . import completion, options

if TYPE_CHECKING:
    from ..course import Exercise

exercise = Typer(
    name="exercise",
    help="Exercises for a course: start, check, grade.",
    rich_markup_mode=None,
    invoke_without_command=True,
)


@exercise.callback()
def _help(context: Context) -> None:
    if context.invoked_subcommand is None:
        print(context.get_help())


Name = Annotated[
    str,
    Argument(metavar="NAME", help="An exercise of `aolab exercise list`, or the folder of your own.",
             autocompletion=completion.exercises),
]  # fmt: skip
Folder = Annotated[Path, Argument(metavar="DIR", help="The student's folder.")]
Which = Annotated[
    str | None,
    Option("--exercise", metavar="NAME", help="The exercise, by name or by folder. Default: as aolab.toml names it."),
]
Only = Annotated[str | None, Option(metavar="STEP", help="One step. Default: all.")]
Seed = Annotated[int, Option(metavar="N", help="Makes the hidden scenes: keep yours secret.")]
Limit = Annotated[float, Option(metavar="SECONDS", min=1, help="The time limit for a folder.")]


@exercise.command("list")
def list_exercises(as_json: options.Json = False) -> None:
    """List the exercises: name, time, title, and the paper's section."""
    from ..course import exercises
    from ..table import table

    found = exercises().values()
    if as_json:
        print(json.dumps([_about(one) for one in found], indent=2))
        return
    rows = [
        [one.name, one.spec.minutes, f"{one.points:g}", one.spec.title, one.spec.learn, one.spec.paper] for one in found
    ]
    print(table({"name": "", "minutes": "d", "points": ">", "title": ""}, [row[:4] for row in rows]))
    print()
    for name, *_, learn, paper in rows:
        print(f"{name}: {learn}\n    {paper}")


@exercise.command()
def start(
    name: Name,
    folder: Annotated[
        Path | None, Argument(metavar="DIR", help="The folder to make. Default: NAME.", show_default=False)
    ] = None,
) -> None:
    """Make a folder with the task, a shader with holes, and a notebook."""
    from ..course import start as make

    made = make(name, folder)
    print(f"{made}: read {made / 'task.md'}, edit, then `aolab exercise check {made}`")


@exercise.command()
def check(
    folder: Folder = Path("."),
    output: Annotated[
        Path | None,
        Option("--json", metavar="FILE", help="Write the result, in the form of Gradescope's results.json."),
    ] = None,
    only: Only = None,
    seed: Seed = 0,
    which: Which = None,
    limit: Limit = 120.0,
) -> None:
    """Check a folder step by step.

    Prints points, measured numbers, and hints for known mistakes. Each step is checked with its own functions; the
    other functions are those of the solution. The exit status is 1 if a check fails.
    """
    from ..course import checked_apart
    from ..output import check_writable
    from .files import write_json

    if output is not None:
        check_writable(output)
    result = checked_apart(folder, only=only, seed=seed, name=which, limit=limit)
    if output is not None:
        write_json(output, result.to_dict())
    print(result)
    if not result.passed:
        raise Exit(1)


@exercise.command()
def show(
    folder: Folder = Path("."),
    output: Annotated[
        Path | None, Option("-o", "--output", metavar="FILE.png", help="The picture to write. Default: DIR/show.png.")
    ] = None,
    only: Only = None,
    which: Which = None,
) -> None:
    """Draw each step beside the expected picture.

    A row holds your picture, the expected picture, and their signed difference.
    """
    from ..course import show as draw
    from ..output import replacing
    from .files import check_picture

    path = folder / "show.png" if output is None else output
    check_picture(path)
    picture = draw(folder, only=only, name=which)
    with replacing(path) as file:
        picture.save(file, "PNG")
    print(path)


@exercise.command()
def grade(
    folders: Annotated[list[Path], Argument(metavar="DIR", help="The folders of the students.")],
    output: Annotated[Path, Option("-o", "--output", metavar="FILE.csv", help="The table to write, a row a folder.")],
    which: Which = None,
    seed: Seed = 0,
    limit: Limit = 120.0,
    workers: Annotated[
        int | None, Option(metavar="N", min=1, help="Folders at a time. Default: the number of cores.")
    ] = None,
) -> None:
    """Check many folders, and write a table.

    Each folder is checked in a process with a time limit: an endless loop, a crash or a missing file costs the points
    of its own folder only.
    """
    from ..course import grade as run
    from ..course.grade import Graded, table
    from ..output import check_writable, replacing
    from ..progress import progress_bar, write_line

    check_writable(output)
    with progress_bar("folders", len(folders), "folder") as bar:

        def done(one: Graded) -> None:
            bar.update()
            write_line(f"{one.folder}: {one.result.score:g} of {one.result.points:g}  {one.result.error}".rstrip())

        found = run(folders, seed=seed, name=which, limit=limit, workers=workers, done=done)
    with replacing(output) as file:
        file.write(table(found).encode())
    print(output)


@exercise.command()
def new(
    folder: Annotated[Path, Argument(metavar="DIR", help="The folder to make; its name is the exercise's name.")],
    like: Annotated[
        str | None, Option(metavar="NAME", help="Copy this exercise. Default: a small template with comments.")
    ] = None,
) -> None:
    """Make an exercise of your own.

    The folder holds exercise.toml and task.md to edit.
    """
    from ..course import new as make

    made = make(folder, like=like)
    print(f"{made}: edit {made / 'exercise.toml'}, then `aolab exercise start {made} TRIAL`")


def _about(one: "Exercise") -> dict[str, object]:
    about = {name: getattr(one.spec, name) for name in ("title", "learn", "minutes", "paper")}
    return {"name": one.name, **about, "points": one.points, "steps": [step.name for step in one.spec.steps]}


NAMES = [one.name or getattr(one.callback, "__name__", "") for one in exercise.registered_commands]
