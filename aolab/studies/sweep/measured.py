"""The measures of a sweep: names such as `visibility.rmse`, and functions of one's own."""

import inspect
from collections.abc import Callable, Iterable
from dataclasses import fields
from typing import Any

import numpy as np

from ...errors import ParameterError, suggestion
from ...measures.comparison import compare
from ...measures.metrics import Measures
from ...pipeline.frame import Frame

Measure = str | Callable[..., Any]

DEFAULT_BUFFER = "visibility"
REGIONS = ("all", "border", "silhouettes", "thin", "interior")
OF_TRUTH = tuple(field.name for field in fields(Measures))
# numbers of the frame alone, over the pixels with a surface
OF_FRAME: dict[str, Callable[[np.ndarray], float]] = {
    "mean": lambda values: float(values.mean()),
    "std": lambda values: float(values.std()),
    "least": lambda values: float(values.min()),
    "most": lambda values: float(values.max()),
}


def parse(name: str) -> tuple[str, str, str]:
    """(buffer, region, measure) of `rmse`, `ambient.rmse` or `ambient.border.rmse`. Raises `ParameterError`."""
    parts = name.split(".")
    last = parts[-1]
    known = [*OF_TRUTH, *OF_FRAME]
    if last not in known or len(parts) > 3:
        raise ParameterError(f"measure '{name}' is unknown: BUFFER.REGION.MEASURE{suggestion(last, known)}")
    buffer = parts[0] if len(parts) > 1 else DEFAULT_BUFFER
    region = parts[1] if len(parts) == 3 else "all"
    if region not in REGIONS:
        raise ParameterError(f"measure '{name}': no region '{region}'{suggestion(region, REGIONS)}")
    return buffer, region, last


def default(with_reference: bool) -> tuple[Measure, ...]:
    """The measures of a sweep that names none."""
    return ("visibility.rmse", "visibility.bias") if with_reference else ("visibility.mean",)


def buffers_of(measures: Iterable[Measure]) -> tuple[str, ...]:
    """The buffers whose truth is needed: of names that compare; `visibility` for functions of two arguments."""
    found: dict[str, None] = {}
    for one in measures:
        if isinstance(one, str):
            buffer, _, last = parse(one)
            if last in OF_TRUTH:
                found[buffer] = None
        elif _takes_truth(one):
            found[DEFAULT_BUFFER] = None
    return tuple(found)


def needs_truth(measures: Iterable[Measure]) -> bool:
    """Whether any of the measures compares with the truth."""
    return bool(buffers_of(measures))


def measure(frame: Frame, truth: Frame | None, measures: Iterable[Measure]) -> dict[str, Any]:
    """{column: number} for each measure. Raises `ParameterError` for a buffer that the frame lacks."""
    found: dict[str, Any] = {}
    compared: dict[str, Any] = {}
    for one in measures:
        if not isinstance(one, str):
            found |= _own(one, frame, truth)
            continue
        buffer, region, last = parse(one)
        if buffer not in frame:
            module = frame.info.get("module")
            raise ParameterError(f"module {module} has no buffer '{buffer}'{suggestion(buffer, frame.buffers)}")
        if last in OF_FRAME:
            values = frame[buffer]
            found[one] = OF_FRAME[last](values[frame.mask] if values.shape[:2] == frame.mask.shape else values)
            continue
        if truth is None:
            raise ParameterError(f"measure '{one}' compares with the truth: reference=True computes it")
        if buffer not in compared:
            flip = any(isinstance(name, str) and parse(name)[::2] == (buffer, "flip") for name in measures)
            compared[buffer] = compare(frame, truth, buffer, flip=flip)[buffer]
        found[one] = float(getattr(compared[buffer].measures[region], last))
    return found


def _own(function: Callable[..., Any], frame: Frame, truth: Frame | None) -> dict[str, Any]:
    result = function(frame, truth) if _takes_truth(function) else function(frame)
    name = getattr(function, "__name__", type(function).__name__)
    values = result if isinstance(result, dict) else {name: result}
    try:
        return {key: float(value) for key, value in values.items()}
    except (TypeError, ValueError):
        raise ParameterError(f"measure {name} returned {result!r}: not a number, nor numbers by name") from None


def _takes_truth(function: Callable[..., Any]) -> bool:
    return len(inspect.signature(function).parameters) >= 2
