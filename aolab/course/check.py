"""Check a student's folder: each step with the student's functions for it, and the solution's for all other steps."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import get_args

from ..errors import Error, FileError, ParameterError, ShaderError
from . import answers
from . import shader as glsl
from .checks import judged, seen
from .exercise import SPEC, Exercise, OfAnswers, OfPictures, Step, bare, exercise
from .hints import Hint, Picture, hint
from .rendering import Renders, renders_of, shots
from .results import COMPILES, Checked, Result, StepResult

MARK = "aolab.toml"  # the file of a student's folder that names its exercise
LONGEST = 1 << 20  # bytes of a student's file


def check(
    folder: str | Path = ".", *, only: str | None = None, seed: int = 0, name: str | Path | None = None
) -> Result:
    """Check the exercise in a student's folder.

    `only` is the name of one step; `seed` makes the hidden scenes; `name` is the exercise, by default the one that the
    folder's file aolab.toml names. Each step is checked with the student's functions of this step and the solution's of
    the others, so that a mistake costs the points of one step. An endless loop in a shader never returns: see
    `aolab.course.checked_apart`. Raises `ParameterError` and `FileError` for a folder without an exercise.
    """
    folder = Path(folder)
    one = exercise_of(folder, name)
    steps = [one.step(only)] if only else one.spec.steps
    renders = renders_of(one)
    try:
        texts = student_texts(one, folder)
    except FileError as error:
        return Result(one.name, one.spec.title, tuple(nothing(step, str(error)) for step in steps), str(error))
    found = [_compiles(renders, folder)] if one.spec.shaders else []
    found += [_step(renders, step, texts, folder, seed) for step in steps]
    return Result(one.name, one.spec.title, tuple(found))


def exercise_of(folder: Path, name: str | Path | None = None) -> Exercise:
    """The exercise of a student's folder."""
    if name is not None:
        return exercise(name)
    if not folder.is_dir():
        raise FileError(f"no folder {folder}")
    path = folder / MARK
    try:
        named = tomllib.loads(path.read_text(encoding="utf-8"))["exercise"]
    except FileNotFoundError:
        raise FileError(f"no {MARK} in {folder}: `aolab exercise start` writes it; or name the exercise") from None
    except (KeyError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise FileError(f'cannot read {path}: write exercise = "NAME" ({error})') from error
    beside = folder / str(named)
    return exercise(beside if (beside / SPEC).is_file() else str(named))


def student_texts(one: Exercise, folder: Path) -> dict[str, str]:
    """{file: text} of the student's shaders, with their own includes in place. Raises `FileError`."""
    return {shader.file: glsl.with_own_includes(text_of(folder, shader.file), folder) for shader in one.spec.shaders}


def text_of(folder: Path, file: str) -> str:
    """The text of a student's file. Raises `FileError` for a missing, unreadable or huge one."""
    path = path_of(folder, file)
    try:
        if path.stat().st_size > LONGEST:
            raise FileError(f"{path.name} has more than {LONGEST >> 20} MiB")
        return path.read_text(encoding="utf-8-sig")  # an editor may have written a mark of byte order
    except FileNotFoundError:
        there = sorted(one.name for one in folder.iterdir()) if folder.is_dir() else []
        raise FileError(f"no file {path.name} in {folder}; there are: {', '.join(there)[:200] or 'none'}") from None
    except UnicodeDecodeError as error:
        raise FileError(f"{path.name} is no text in UTF-8: {error.reason} at byte {error.start}") from error
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"cannot read {path.name}: {error.strerror or error}") from error


def path_of(folder: Path, file: str) -> Path:
    """The absolute path of a student's file."""
    return (folder / Path(file).name).resolve()


def transplanted(one: Exercise, step: Step, texts: Mapping[str, str]) -> dict[str, str]:
    """The student's shaders, with the solution's functions of all other steps. Raises `ParameterError`."""
    made = dict(texts)
    for other in one.spec.steps:
        for hole in other.holes if other.name != step.name else ():
            file = one.file_of(hole)
            made[file] = glsl.with_functions(made[file], one.solution[file], [bare(hole)])
    for hole in step.holes:  # they have to be there
        glsl.function(made[one.file_of(hole)], bare(hole))
    return made


def is_begun(one: Exercise, step: Step, texts: Mapping[str, str]) -> bool:
    """Whether a function of the step differs from its hole; a missing function is a difference."""
    for hole in step.holes:
        file = one.file_of(hole)
        try:
            mine, empty = (glsl.function(text, bare(hole)) for text in (texts[file], one.holes[file]))
        except ParameterError:
            return True
        if not glsl.same_code(texts[file][mine.body : mine.end], one.holes[file][empty.body : empty.end]):
            return True
    return not step.holes


def _compiles(renders: Renders, folder: Path) -> StepResult:
    """Whether the files compile as they are: the message then names their lines."""
    one = renders.exercise
    title = "every shader compiles"
    shot = next(
        shot
        for step in one.spec.steps
        for check in step.checks
        if isinstance(check, get_args(OfPictures))
        for shot in shots(one, step, check, 0)  # pyright: ignore[reportArgumentType]
    )
    try:
        renders.lab.reload()
        frame = renders.frame(shot, {shader.file: path_of(folder, shader.file) for shader in one.spec.shaders})
        frame.complete()
    except Error as error:
        return StepResult(COMPILES, title, (Checked(COMPILES, COMPILES, 1, False, str(error)),))
    return StepResult(COMPILES, title, (Checked(COMPILES, COMPILES, 1, True, f"rendered at {frame.size}"),))


def nothing(step: Step, message: str, begun: bool = True) -> StepResult:
    """A step without points, for the reason `message`."""
    checks = tuple(Checked(step.name, check.kind, check.points, False, message) for check in step.checks)
    return StepResult(step.name, step.title, checks, begun)


def _step(renders: Renders, step: Step, texts: Mapping[str, str], folder: Path, seed: int) -> StepResult:
    one = renders.exercise
    if not is_begun(one, step, texts):
        return nothing(step, "not begun", begun=False)
    try:
        mine = transplanted(one, step, texts)
    except ParameterError as error:
        return nothing(step, str(error))
    checks, pictures = [], dict[tuple[object, ...], Picture]()
    for check in step.checks:
        if isinstance(check, get_args(OfAnswers)):
            verdict = answers.judged(check, folder)  # pyright: ignore[reportArgumentType]
        else:
            buffer = check.buffer or one.spec.buffers[0]  # pyright: ignore[reportAttributeAccessIssue]
            try:
                frames = seen(renders, step, check, mine, seed)  # pyright: ignore[reportArgumentType]
                verdict = judged(check, buffer, frames)  # pyright: ignore[reportArgumentType]
            except ShaderError as error:
                where = "with the solution's functions of the other steps"
                return nothing(step, str(error).replace("<inline>", where))
            pictures |= {(buffer, *frame.shot.key): Picture(frame, buffer) for frame in frames}
        checks.append(Checked(step.name, check.kind, check.points, verdict.passed, verdict.message))
    made = StepResult(step.name, step.title, tuple(checks))
    return made if made.passed else _hinted(made, hint(renders, step, [*pictures.values()]))


def _hinted(made: StepResult, found: Hint | None) -> StepResult:
    if found is None:
        return made
    return StepResult(made.name, made.title, made.checks, made.begun, found.mistake, found.text)
