"""Hints: a mistake is recognised by what it does to the picture.

Each known mistake is rendered with the scenes of the step. The student's error e and the error m of a mistake are
compared as vectors over all pixels: their cosine, e·m / |e||m|, is 1 if they are the same up to a factor. So a mistake
is found even if the student's is weaker or stronger, or if there are other faults beside it. Where no mistake is alike,
the picture itself is tried: mirrored, negated, scaled.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import ShaderError
from ..pipeline.frame import Frame
from .checks import Seen, contrast, finite, whole
from .exercise import Mistake, Step, mutated
from .rendering import Renders

ALIKE = 0.6  # the least cosine: docs/exercises.md has the figures
SAME = 0.05  # the largest error, in contrasts, of a picture that is only mirrored, negated or scaled
LIMIT = 10.0  # in contrasts: a larger error of a pixel counts as much


@dataclass(frozen=True)
class Hint:
    """The name of a mistake, the hint for it, and its likeness in [0, 1]."""

    mistake: str
    text: str
    likeness: float


@dataclass(frozen=True)
class Picture:
    """A buffer of a shot, the student's and the solution's."""

    seen: Seen
    buffer: str

    @property
    def expected(self) -> np.ndarray:
        return finite(whole(self.seen.solution, self.buffer))

    def error(self, frame: Frame) -> np.ndarray:
        """The flat error of a frame against the solution's, in contrasts, divided by √(number of values)."""
        ours, expected = finite(whole(frame, self.buffer)), self.expected
        error = np.clip((ours - expected) / contrast(expected), -LIMIT, LIMIT)
        return error.ravel() / np.sqrt(error.size)


def hint(renders: Renders, step: Step, pictures: Sequence[Picture]) -> Hint | None:
    """The known mistake that explains the student's pictures best, or a property of the picture; None for neither."""
    error = np.concatenate([one.error(one.seen.frame) for one in pictures]) if pictures else np.zeros(0)
    if not error.any():
        return None
    likeness = likenesses(renders, step, pictures, error)
    best = max(likeness, key=likeness.__getitem__, default="")
    if best and likeness[best] >= ALIKE:
        text = next(mistake.hint for mistake in step.mistakes if mistake.name == best)
        return Hint(best, text, likeness[best])
    return next(filter(None, map(_of_picture, pictures)), None)


def likenesses(renders: Renders, step: Step, pictures: Sequence[Picture], error: np.ndarray) -> dict[str, float]:
    """{mistake: cosine between its error and the student's}; 0 for a mistake without effect."""
    found = {}
    for mistake in step.mistakes:
        try:
            theirs = np.concatenate([_mistaken(renders, mistake, one) for one in pictures])
        except ShaderError:
            continue  # the mistake of an exercise that is being written
        length = float(np.linalg.norm(theirs) * np.linalg.norm(error))
        found[mistake.name] = float(theirs @ error) / length if length else 0.0
    return found


def _mistaken(renders: Renders, mistake: Mistake, one: Picture) -> np.ndarray:
    return one.error(renders.kept_frame(one.seen.shot, mutated(renders.exercise, mistake), mistake.name))


def _of_picture(one: Picture) -> Hint | None:
    """A picture that is the expected one but for a mirror, a sign, a constant or a factor."""
    ours, expected = finite(whole(one.seen.frame, one.buffer)), one.expected
    scale = contrast(expected)

    def is_expected(values: np.ndarray) -> bool:
        return float(np.sqrt(np.mean((values - expected) ** 2))) < SAME * scale

    if np.ptp(ours) == 0:
        return Hint("constant", f"'{one.buffer}' is {ours.flat[0]:.3g} everywhere.", 1.0)
    if is_expected(ours[::-1]):
        return Hint("mirrored", f"'{one.buffer}' is upside down.", 1.0)
    if is_expected(ours[:, ::-1]):
        return Hint("mirrored", f"'{one.buffer}' is mirrored from left to right.", 1.0)
    if is_expected(-ours):
        return Hint("negated", f"'{one.buffer}' has the wrong sign.", 1.0)
    if is_expected(1 - ours):
        return Hint("inverted", f"'{one.buffer}' is 1 minus the expected picture.", 1.0)
    if (power := float(np.mean(ours**2))) > 0 and np.isfinite(power):
        factor = float(np.mean(ours * expected)) / power
        if factor > 0 and is_expected(ours * factor):
            return Hint(
                "scaled",
                f"'{one.buffer}' is {1 / factor:.3g} times the expected picture: a factor is wrong, or a sum is not "
                "divided by its number of terms.",
                1.0,
            )
    return None
