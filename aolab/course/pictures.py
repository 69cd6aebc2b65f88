"""The picture of a student's folder: for each step the student's, the expected one, and the signed difference."""

from collections.abc import Mapping
from pathlib import Path
from typing import get_args

import numpy as np
from PIL import Image

from ..errors import Error, ParameterError
from ..pictures.sheet import contact_sheet
from ..pipeline.frame import Frame
from .check import exercise_of, is_begun, student_texts, transplanted
from .checks import difference, finite, percent, whole
from .exercise import Exercise, Hidden, OfPictures, Rendered, Step
from .rendering import Renders, Shot, renders_of, shots

SIZE = (320, 180)
SIGNED = "RdBu_r"  # white is equal, red is more than expected
MISSING = (np.full((SIZE[1], SIZE[0], 3), 200, np.uint8), "")


def show(folder: str | Path = ".", *, only: str | None = None, name: str | Path | None = None) -> Image.Image:
    """A sheet with a row for each step: the student's picture, the expected one, and the signed difference.

    As in `check`, a step is drawn with the student's functions of this step and the solution's of the others. Raises
    `ParameterError` for an exercise without pictures, and `FileError` for a file that is missing.
    """
    one = exercise_of(Path(folder), name)
    texts = student_texts(one, Path(folder))
    steps = [one.step(only)] if only else one.spec.steps
    renders = renders_of(one)
    cells = [cell for step in steps for cell in row(renders, step, texts)]
    if not cells:
        raise ParameterError(f"the exercise {one.name} has no pictures: it measures")
    return contact_sheet(cells, 3, title=one.spec.title)


def row(renders: Renders, step: Step, texts: Mapping[str, str]) -> list[tuple[str, np.ndarray]]:
    """The captions and pictures of a step; none for a step without pictures."""
    one = renders.exercise
    shown = shot_of(one, step)
    if shown is None:
        return []
    shot, buffer = shown
    expected = renders.solution(shot)
    begun = is_begun(one, step, texts)
    try:
        frame = renders.frame(shot, transplanted(one, step, texts))
        frame[buffer]
    except Error as error:
        return [(f"{step.name}: {error}"[:200], MISSING[0]), ("expected", pixels(expected, expected, buffer))]
    share = percent(difference(frame, expected, buffer))
    return [
        (f"{step.name}: yours{'' if begun else ' (not begun)'}", pixels(frame, expected, buffer)),
        (f"{step.name}: expected ({buffer})", pixels(expected, expected, buffer)),
        (f"difference: {share}; red is more", signed(frame, expected, buffer)),
    ]


def shot_of(one: Exercise, step: Step) -> tuple[Shot, str] | None:
    """The first frame of a step that is compared with the solution, at the size of the sheet, and its buffer."""
    pictured = [
        check for check in step.checks if isinstance(check, get_args(OfPictures)) and not isinstance(check, Hidden)
    ]
    compared = sorted(pictured, key=lambda check: check.kind != "solution")
    if not compared or not isinstance(check := compared[0], Rendered):
        return None
    found = shots(one, step, check.model_copy(update={"size": SIZE}), 0)[0]
    return found, check.buffer or one.spec.buffers[0]


def pixels(frame: Frame, expected: Frame, buffer: str) -> np.ndarray:
    """(H, W, 3) uint8: the values over the range of the expected picture; four channels show the first three."""
    values, known = (_colours(whole(one, buffer)) for one in (frame, expected))
    low, high = np.percentile(finite(known), (0.5, 99.5))
    scaled = (finite(values) - min(low, 0.0)) / max(high - min(low, 0.0), 1e-12)
    return (np.clip(scaled, 0, 1) * 255 + 0.5).astype(np.uint8)


def signed(frame: Frame, expected: Frame, buffer: str) -> np.ndarray:
    """(H, W, 3) uint8: the difference, the mean over the channels; the strongest colours are half the contrast."""
    from matplotlib import colormaps

    ours, known = (finite(_colours(whole(one, buffer))) for one in (frame, expected))
    low, high = np.percentile(known, (0.5, 99.5))
    error = (ours - known).mean(axis=2) / max(high - low, 1e-12)
    return colormaps[SIGNED](np.clip(error + 0.5, 0, 1), bytes=True)[..., :3]


def _colours(values: np.ndarray) -> np.ndarray:
    """(H, W, 3)."""
    if values.ndim == 2:
        return np.repeat(values[..., None], 3, axis=2)
    return values[..., :3] if values.shape[2] >= 3 else np.repeat(values[..., :1], 3, axis=2)
