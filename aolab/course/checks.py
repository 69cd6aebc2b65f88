"""The checks of pictures, in rising order: numbers in range, exact answers, the solution's picture, the truth."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ParameterError, suggestion
from ..pipeline.frame import Frame
from ..truth import reference
from .exercise import Exact, Hidden, OfPictures, Range, Rendered, Solution, Step, Truth
from .rendering import Renders, Shot, Texts, shots
from .scenes import EXACT, places


@dataclass(frozen=True)
class Seen:
    """One frame of a check: the student's, and the solution's of the same shot."""

    shot: Shot
    frame: Frame
    solution: Frame


@dataclass(frozen=True)
class Verdict:
    """Whether a check passed, and a sentence about the measured numbers."""

    passed: bool
    message: str


def seen(renders: Renders, step: Step, check: Rendered, texts: Texts, seed: int) -> list[Seen]:
    """The frames of a check, with the shaders `texts`. Raises `ShaderError` for one that does not compile."""
    return [
        Seen(shot, renders.frame(shot, texts), renders.solution(shot))
        for shot in shots(renders.exercise, step, check, seed)
    ]


def judged(check: OfPictures, buffer: str, pictures: list[Seen]) -> Verdict:
    """The verdict of a check on its frames."""
    for one in pictures:
        good = np.isfinite(surface(one.frame, buffer)).all(axis=1)
        if not good.all():
            return Verdict(
                False,
                f"'{buffer}' is NaN or infinite in {percent(1 - good.mean())} of the surfaces' pixels: a division by "
                "0, a root of a negative number, or normalize of a zero vector",
            )
    return _JUDGES[check.kind](check, buffer, pictures)


def surface(frame: Frame, buffer: str) -> np.ndarray:
    """(N, channels): the values of a buffer at the pixels with a surface. Raises `ParameterError` for an unknown."""
    if buffer not in frame.buffers:
        raise ParameterError(f"no buffer '{buffer}'{suggestion(buffer, frame.buffers)}")
    return whole(frame, buffer)[frame.mask].reshape(int(frame.mask.sum()), -1)


def whole(frame: Frame, buffer: str) -> np.ndarray:
    """(H, W[, channels]) float64: a buffer with its background, which no NaN marks where a shader has filled it."""
    pixels = frame[buffer] if buffer in frame.derived else frame.channels(buffer)
    return pixels / 255.0 if pixels.dtype == np.uint8 else pixels.astype(np.float64)


def difference(frame: Frame, solution: Frame, buffer: str) -> float:
    """The root mean square difference over all pixels, as a share of the contrast of the solution."""
    ours, theirs = (finite(whole(one, buffer)) for one in (frame, solution))
    return float(np.sqrt(np.mean((ours - theirs) ** 2))) / contrast(theirs)


def finite(values: np.ndarray) -> np.ndarray:
    """The values with 0 in place of NaN and of infinite ones."""
    return np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)


def contrast(values: np.ndarray) -> float:
    """The standard deviation over the pixels, all channels together; of a constant picture its value, or 1."""
    pixels = values.reshape(-1, values.shape[2] if values.ndim == 3 else 1)
    return float(np.sqrt(pixels.var(axis=0).mean())) or float(np.sqrt(np.mean(values**2))) or 1.0


def _range(check: Range, buffer: str, pictures: list[Seen]) -> Verdict:
    values = surface(pictures[0].frame, buffer)
    low, high, slack = float(values.min()), float(values.max()), 2e-3 * max(check.high - check.low, 1e-6)
    passed = low >= check.low - slack and high <= check.high + slack
    return Verdict(
        passed, f"'{buffer}' reaches from {low:.3g} to {high:.3g}; {check.low:g} to {check.high:g} are allowed"
    )


def _exact(check: Exact, buffer: str, pictures: list[Seen]) -> Verdict:
    frame = pictures[0].frame
    values = frame[buffer] if check.channel is None else frame[buffer][..., check.channel]
    holds, answer = frame.mask, np.asarray(check.value)
    formula = EXACT[check.scene].answer if check.scene in EXACT else None
    if check.value is None:
        assert formula is not None  # `verify` refuses a check without answer
        position, normal = places(frame)
        answer, where = formula(position, normal, float(frame.info["parameters"]["radius"]))
        answer, holds = answer[holds & where], holds & where
    there = values[holds]
    error = np.abs(there - (answer if answer.ndim == 0 else answer.reshape(-1, *[1] * (there.ndim - 1))))
    found = float(error.mean()) if check.value is None else float(error.max())
    kind = "mean" if check.value is None else "largest"
    value = "" if check.value is None else f" {check.value:g}"
    return Verdict(
        found <= check.tolerance,
        f"the {kind} error against the exact answer{value} on the scene '{check.scene}' is {found:.3g}; "
        f"{check.tolerance:g} is allowed",
    )


def _solution(check: Solution | Hidden, buffer: str, pictures: list[Seen]) -> Verdict:
    found = max(difference(one.frame, one.solution, buffer) for one in pictures)
    return Verdict(
        found <= check.tolerance,
        f"'{buffer}' differs from the solution's by {percent(found)}; {percent(check.tolerance)} are allowed",
    )


def _truth(check: Truth, buffer: str, pictures: list[Seen]) -> Verdict:
    frame = pictures[0].frame
    shot = pictures[0].shot
    rays = reference(shot.scene, like=frame, buffers=buffer, rays=check.rays, progress=False)
    error = (frame[buffer] - rays[buffer])[frame.mask]
    name = "standard_error" if buffer == "visibility" else f"{buffer}_standard_error"
    noise = float(np.sqrt(np.mean(rays[name][frame.mask] ** 2)))
    found, allowed = float(np.sqrt(np.mean(error**2))), check.tolerance + 2 * noise
    return Verdict(found <= allowed, f"the error against rays is {found:.3g}; {allowed:.3g} is allowed")


def percent(share: float) -> str:
    """'12 %', '0.3 %'."""
    if share > 10:
        return "more than 1000 %"
    return f"{100 * share:.0f} %" if share > 0.1 else f"{100 * share:.2g} %"


_JUDGES: dict[str, Callable[[Any, str, list[Seen]], Verdict]] = {
    "range": _range,
    "exact": _exact,
    "solution": _solution,
    "hidden": _solution,
    "truth": _truth,
}
