"""An exercise is data: a folder with exercise.toml, task.md and, where the package has none, the solution's shader."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from .. import paths
from ..errors import FileError, ParameterError, suggestion
from ..modules import MODULES, Module, find
from . import shader as glsl
from .scenes import EXACT

SPEC, TASK = "exercise.toml", "task.md"


class _Table(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)


class _Check(_Table):
    points: float = Field(1, gt=0)


class Rendered(_Check):
    """A check that renders a scene, with changes of the module's parameters in `set`."""

    scene: str = "boxes"
    buffer: str = ""  # the first one of the exercise's `buffers`
    set: dict[str, Any] = {}
    size: tuple[int, int] | None = None
    seed: int = 0
    accumulate: int = Field(1, ge=1)
    eye: tuple[float, float, float] | None = None
    target: tuple[float, float, float] | None = None


class Range(Rendered):
    """Every surface's value is a number from `low` to `high`."""

    kind: Literal["range"]
    low: float = 0
    high: float = 1


class Exact(Rendered):
    """The mean error against a known answer is at most `tolerance`: a constant `value`, or a formula of `scenes.py`."""

    kind: Literal["exact"]
    scene: str = "plane"
    value: float | None = None
    channel: int | None = Field(None, ge=0)
    tolerance: float = Field(gt=0)


class Solution(Rendered):
    """The root mean square difference from the solution's buffer, as a share of that buffer's contrast."""

    kind: Literal["solution"]
    tolerance: float = Field(0.05, gt=0)


class Truth(Rendered):
    """The root mean square error against rays is at most `tolerance` plus twice the rays' standard error."""

    kind: Literal["truth"]
    tolerance: float = Field(gt=0)
    rays: int = Field(128, ge=2)


class Hidden(Rendered):
    """As `Solution`, on `count` scenes that the lecturer's seed makes."""

    kind: Literal["hidden"]
    count: int = Field(2, ge=1, le=16)
    tolerance: float = Field(0.05, gt=0)


class Cause(_Check):
    """The answer is the part of the error with the largest share (`aolab.explain`), or with nearly that share."""

    kind: Literal["cause"]
    answer: str
    scene: str
    module: str
    buffer: str = "visibility"
    size: tuple[int, int] = (96, 54)
    rays: int = Field(64, ge=2)
    frames: int = Field(16, ge=1)
    within: float = Field(0.8, gt=0, le=1)  # of the largest share


class Value(_Check):
    """The answer is a measured number, to a relative `tolerance`: the RMSE of a module against the truth."""

    kind: Literal["value"]
    answer: str
    scene: str
    module: str
    size: tuple[int, int] = (96, 54)
    rays: int = Field(64, ge=2)
    tolerance: float = Field(0.1, gt=0)


class Best(_Check):
    """The answer is a list with a value for each of `parameters`; its error is at most `within` times the least one.

    The candidates are all `choices`, lists of such values.
    """

    kind: Literal["best"]
    answer: str
    scene: str
    module: str
    parameters: tuple[str, ...]
    choices: tuple[tuple[float, ...], ...]
    size: tuple[int, int] = (96, 54)
    rays: int = Field(64, ge=2)
    within: float = Field(1.1, ge=1)


class Sweep(_Check):
    """The file is a specification for `aolab sweep` that renders `scene` with all `choices`, and a reference."""

    kind: Literal["sweep"]
    file: str
    scene: str
    parameters: tuple[str, ...]
    choices: tuple[tuple[float, ...], ...]


OfPictures = Range | Exact | Solution | Truth | Hidden
OfAnswers = Cause | Value | Best | Sweep
Check = Annotated[OfPictures | OfAnswers, Field(discriminator="kind")]


class Mistake(_Table):
    """A known mistake: `edits` of the solution that make it, and the hint for it."""

    name: str
    hint: str
    edits: dict[str, str] = Field(min_length=1)


class Step(_Table):
    """A stage: the functions to write (`holes`: function, the body that it has at first), and its checks."""

    name: str
    title: str
    task: str
    expect: str = ""
    holes: dict[str, str] = {}
    set: dict[str, Any] = {}
    checks: tuple[Check, ...] = Field(min_length=1, alias="check")
    mistakes: tuple[Mistake, ...] = Field((), alias="mistake")


class Shader(_Table):
    """A file of the student's: the text of `file`, with the files of `inline`; it stands for the shader `replaces`."""

    file: str
    inline: tuple[str, ...] = ()
    replaces: str = ""


class Spec(_Table):
    """The contents of exercise.toml."""

    title: str
    learn: str
    minutes: int = Field(ge=1)
    paper: str
    module: str = "ssao"
    outputs: dict[str, str] = {}
    buffers: tuple[str, ...] = ("visibility",)
    size: tuple[int, int] = (96, 64)
    shaders: tuple[Shader, ...] = Field((), alias="shader")
    files: tuple[str, ...] = ()  # further files of the folder that the student gets
    steps: tuple[Step, ...] = Field(min_length=1, alias="step")


@dataclass(frozen=True, eq=False)
class Exercise:
    """An exercise in its folder."""

    folder: Path
    spec: Spec

    @property
    def name(self) -> str:
        return self.folder.name

    @property
    def points(self) -> float:
        """All points, with the one for shaders that compile."""
        return sum(check.points for step in self.spec.steps for check in step.checks) + bool(self.spec.shaders)

    @cached_property
    def module(self) -> Module:
        """The module with the exercise's parameters."""
        return find(self.spec.module, MODULES)

    @cached_property
    def solution(self) -> dict[str, str]:
        """{file: text} of the solution."""
        return {one.file: glsl.assembled(one.file, self.folder, one.inline) for one in self.spec.shaders}

    def file_of(self, function: str) -> str:
        """The file with the function; its name may stand before the function, as in 'ssdo.frag: main'."""
        file, _, name = function.rpartition(": ")
        files = [file] if file in self.solution else list(self.solution)
        for one in files:
            if name in {
                known for found in glsl.functions(self.solution[one]) for known in (found.name, found.signature)
            }:
                glsl.function(self.solution[one], name)
                return one
        raise ParameterError(f"{self.name}: no shader of the exercise has a function '{function}'")

    @cached_property
    def holes(self) -> dict[str, str]:
        """{file: text} that a student starts with."""
        texts = dict(self.solution)
        for step in self.spec.steps:
            task = f'// TODO, step "{step.name}": {step.task}'
            for hole, body in step.holes.items():
                file = self.file_of(hole)
                texts[file] = glsl.with_body(texts[file], bare(hole), f"{wrapped(task)}\n{body}")
        return texts

    def step(self, name: str) -> Step:
        """The step with this name."""
        known = {step.name: step for step in self.spec.steps}
        if name not in known:
            raise ParameterError(f"the exercise {self.name} has no step '{name}'{suggestion(name, known)}")
        return known[name]


def bare(hole: str) -> str:
    """The function of a hole, without its file."""
    return hole.rpartition(": ")[2]


def wrapped(comment: str, width: int = 110) -> str:
    """A comment as lines of at most `width` characters."""
    lines = [""]
    for word in comment.removeprefix("// ").split():
        if len(lines[-1]) + len(word) > width:
            lines.append("")
        lines[-1] += f"{word} "
    return "\n".join(f"// {line.rstrip()}" for line in lines)


def names() -> list[str]:
    """The package's exercises in the order of a course: order.txt in their folder."""
    return (paths.exercises() / "order.txt").read_text(encoding="utf-8").split()


def exercises() -> dict[str, Exercise]:
    """{name: exercise} of the package."""
    return {name: read(paths.exercises() / name) for name in names()}


def exercise(name: str | Path) -> Exercise:
    """The exercise with this name, or that of a lecturer's folder.

    Raises `ParameterError` for an unknown name and for a wrong exercise.toml, which it names with the key.
    """
    if (Path(name) / SPEC).is_file():
        return read(Path(name))
    if str(name) not in names():
        given = str(name)[:80]
        raise ParameterError(f"no exercise '{given}', and no folder with {SPEC}{suggestion(given, names())}")
    return read(paths.exercises() / name)


def read(folder: Path) -> Exercise:
    """The exercise in a folder."""
    path = folder / SPEC
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from error
    except tomllib.TOMLDecodeError as error:
        raise ParameterError(f"cannot read {path} as TOML: {error}") from error
    try:
        spec = Spec(**values)
    except ValidationError as error:
        raise ParameterError(f"{path}: {explained(error, values)}") from None
    made = Exercise(folder.resolve(), spec)
    verify(made, path)
    return made


def explained(error: ValidationError, values: Mapping[str, Any]) -> str:
    """The first fault, with its key and the names of its step and check, as in 'step.kernel.check.2.points: ...'."""
    first = min(error.errors(), key=lambda item: item["type"] == "union_tag_not_found")
    place: list[str] = []
    inside: Any = values
    for key in first["loc"]:
        if isinstance(key, int):
            inside = inside[key] if isinstance(inside, (list, tuple)) and key < len(inside) else {}
            named = isinstance(inside, dict) and isinstance(inside.get("name"), str)
            place.append(str(inside["name"]) if named else str(key + 1))
        elif not (isinstance(inside, dict) and inside.get("kind") == key):  # pydantic names the kind of a union, too
            place.append(str(key))
            inside = inside.get(key, {}) if isinstance(inside, dict) else {}
    if first["type"] == "extra_forbidden":
        return f"unknown key '{'.'.join(place)}'"
    return f"{'.'.join(place)}: {first['msg']}"


def verify(one: Exercise, path: Path) -> None:
    """Raise `ParameterError` for names that lead nowhere: functions, edits, scenes of exact answers, double names."""
    steps = [step.name for step in one.spec.steps]
    if twice := [name for name in steps if steps.count(name) > 1]:
        raise ParameterError(f"{path}: two steps have the name '{twice[0]}'")
    try:
        one.module  # noqa: B018  # an unknown name raises
        one.holes  # noqa: B018
        for step in one.spec.steps:
            for mistake in step.mistakes:
                mutated(one, mistake)
            for check in step.checks:
                if isinstance(check, Exact) and check.value is None and EXACT[check.scene].answer is None:
                    raise ParameterError(f"step '{step.name}': the exact answer on '{check.scene}' needs a `value`")
    except KeyError as error:
        raise ParameterError(f"{path}: no exact scene {error}; known: {', '.join(EXACT)}") from None
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from None


def mutated(one: Exercise, mistake: Mistake) -> dict[str, str]:
    """{file: text} of the solution with a mistake."""
    texts = dict(one.solution)
    for old, new in mistake.edits.items():
        files = [file for file, text in texts.items() if old in text]
        if len(files) != 1:
            raise ParameterError(f"mistake '{mistake.name}': {len(files)} shaders, not one, have: {old}")
        texts[files[0]] = glsl.edited(texts[files[0]], {old: new}, f"mistake '{mistake.name}'")
    return texts
