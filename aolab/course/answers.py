"""The checks of measuring exercises: answers in a file, compared with measurements made while checking."""

import tomllib
import warnings
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Error, FileError, Notice, ParameterError
from ..measures.explain import explain
from ..modules import MODULES, find
from ..pipeline.api import render
from ..truth import reference
from .checks import Verdict
from .exercise import Best, Cause, OfAnswers, Sweep, Value

ANSWERS = "answers.toml"
Size = tuple[int, int]


def judged(check: OfAnswers, folder: Path) -> Verdict:
    """The verdict on an answer of the file answers.toml in the student's folder."""
    if isinstance(check, Sweep):
        return _sweep(check, folder)
    try:
        answer = answers(folder).get(check.answer, "")
    except FileError as error:
        return Verdict(False, str(error))
    if answer in ("", []):
        return Verdict(False, f"no answer '{check.answer}' in {ANSWERS}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Notice)  # about the noise of few rays, which the tolerances allow for
        if isinstance(check, Cause):
            return _cause(check, answer)
        return _value(check, answer) if isinstance(check, Value) else _best(check, answer)


def answers(folder: Path) -> dict[str, Any]:
    """The answers of a student. Raises `FileError` for a file that is missing or no TOML."""
    path = folder / ANSWERS
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise FileError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from error


@cache
def _shares(scene: str, module: str, buffer: str, size: Size, rays: int, frames: int) -> dict[str, float]:
    table = explain(scene, find(module, MODULES), buffer=buffer, size=size, rays=rays, frames=frames).table()
    return {name: row["share"] for name, row in table.items() if name != "error"}


def _cause(check: Cause, answer: Any) -> Verdict:
    known = _shares(check.scene, check.module, check.buffer, check.size, check.rays, check.frames)
    if answer not in known:
        return Verdict(False, f"{check.answer} = {answer!r}: write one of {', '.join(known)}")
    passed = known[answer] >= check.within * max(known.values())
    return Verdict(passed, f"{check.answer} = '{answer}' has {known[answer]:.0%} of the error".replace("%", " %"))


@cache
def error_of(scene: str, module: str, size: Size, rays: int) -> float:
    """The RMSE of a module's visibility against rays that answer its own question."""
    found = find(module, MODULES)
    frame = render(scene, found, size=size)
    truth = reference(scene, like=frame, buffers="visibility", rays=rays, progress=False)
    return float(np.sqrt(np.mean((frame["visibility"] - truth["visibility"])[frame.mask] ** 2)))


def _value(check: Value, answer: Any) -> Verdict:
    if not isinstance(answer, (int, float)):
        return Verdict(False, f"{check.answer} = {answer!r} is not a number")
    found = error_of(check.scene, check.module, check.size, check.rays)
    passed = abs(answer - found) <= check.tolerance * found
    return Verdict(
        passed, f"{check.answer} = {answer:g}; measured here, it is {f'{found:.3g}' if passed else 'another'}"
    )


def _best(check: Best, answer: Any) -> Verdict:
    values = tuple(answer) if isinstance(answer, list) else (answer,)
    if values not in check.choices:
        return Verdict(
            False, f"{check.answer} = {answer!r} is none of the choices {[list(one) for one in check.choices]}"
        )
    errors = {
        one: error_of(check.scene, _with(check.module, check.parameters, one), check.size, check.rays)
        for one in check.choices
    }
    share = errors[values] / min(errors.values())
    return Verdict(share <= check.within, f"{check.answer} = {answer}: its error is {share:.2f} times the least one")


def _with(module: str, parameters: tuple[str, ...], values: tuple[float, ...]) -> str:
    given = "&".join(f"{name}={value:g}" for name, value in zip(parameters, values, strict=True))
    return f"{module}{'&' if '?' in module else '?'}{given}"


def _sweep(check: Sweep, folder: Path) -> Verdict:
    from ..studies.sweep.plan import read_spec

    path = folder / check.file
    try:
        plan = read_spec(path)
        cases = plan.cases()
    except Error as error:
        return Verdict(False, str(error))
    except (TypeError, ValueError, KeyError) as error:
        raise ParameterError(f"{path}: {error}") from error
    rendered = {
        tuple(float(case.parameters.get(name, np.nan)) for name in check.parameters)
        for case in cases
        if str(case.scene) == check.scene
    }
    missing = [list(one) for one in check.choices if tuple(map(float, one)) not in rendered]
    if missing:
        names = ", ".join(check.parameters)
        return Verdict(False, f"{check.file} does not render '{check.scene}' with {names} = {missing[0]}")
    if not plan.settings.reference:
        return Verdict(False, f"{check.file} has no reference, so that it measures no error")
    return Verdict(True, f"{check.file} has {len(cases)} cases, with all {len(check.choices)} choices")
