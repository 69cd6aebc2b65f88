"""Doubts about the outputs of a module of one's own: values that a mistake in its shader gives, with likely causes."""

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from ..modules import Module
from .frame import Frame

ROUNDING = 2e-3  # of half floats near 1
ENOUGH = 64  # pixels of surfaces: fewer may well have one value
# Of visibility, the value that a tenth of the pixels exceeds. Over seven scenes, `ssao` with ten times the automatic
# radius has 0.96 or more, with the hemisphere turned over at most 0.66, with open and blocked exchanged 0.34.
OPEN_SHARE, OPEN_LEAST = 0.9, 0.75


def is_own(module: Module) -> bool:
    """Whether the module, or its shader alone, is the user's."""
    return not type(module).__module__.startswith("aolab.") or isinstance(module.shader, Path)


def doubts(frame: Frame, outputs: Iterable[str]) -> Iterator[str]:
    """One sentence for each buffer of `outputs` with values that a mistake gives.

    These are NaN, a share that leaves [0, 1], one value everywhere, and visibility that is nowhere near 1.
    """
    mask, module = frame.mask, frame.info["module"]
    for name in outputs:
        if name not in frame.buffers or not mask.any():
            continue
        values = frame[name][mask]
        about = frame.table.get(name)
        wrong = 1 - np.isfinite(values).reshape(len(values), -1).all(axis=1).mean()
        if wrong:
            yield (
                f"{module}: '{name}' is NaN or infinite in {_percent(wrong)} of the surfaces' pixels. Likely causes: a "
                "division by 0, sqrt or pow of a negative number, acos beyond [-1, 1], normalize of a zero vector"
            )
        elif about and about.kind == "share" and _leaves(values):
            yield (
                f"{module}: '{name}' reaches from {values.min():.3g} to {values.max():.3g}; it is a share, in [0, 1]. "
                "Likely causes: a sum that is not divided by its weights, a weight below 0"
            )
        elif len(values) >= ENOUGH and (values == values[0]).all():
            yield (
                f"{module}: '{name}' has one value, {_text(values[0])}, in all of the surfaces' pixels. Likely causes: "
                "an output that main() does not assign on every way, an early return, a radius of another scale than "
                "the scene's, a loop without an end (software rendering leaves a loop after 65535 steps)"
            )
        elif name == "visibility" and (top := float(np.quantile(values, OPEN_SHARE))) < OPEN_LEAST:
            yield (
                f"{module}: '{name}' is below {top:.2g} in {_percent(OPEN_SHARE)} of the surfaces' pixels; open "
                "surfaces have 1. Likely causes: a hemisphere that is turned over (directions below the surface), open "
                "and blocked exchanged, a surface that occludes itself (a larger bias), a radius as large as the scene"
            )


def _leaves(values: np.ndarray) -> bool:
    return bool(values.min() < -ROUNDING or values.max() > 1 + ROUNDING)


def _text(value: np.ndarray) -> str:
    return ", ".join(f"{number:.3g}" for number in np.atleast_1d(value))


def _percent(share: float) -> str:
    return "less than 1 %" if share < 0.01 else f"{share:.0%}".replace("%", " %")
