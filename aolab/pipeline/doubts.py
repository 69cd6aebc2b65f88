"""Doubts about the outputs of a module of one's own: values that a mistake in its shader gives, with likely causes."""

from collections.abc import Iterable, Iterator

import numpy as np

from .frame import Frame

ROUNDING = 2e-3  # of half floats near 1


def doubts(frame: Frame, outputs: Iterable[str]) -> Iterator[str]:
    """One sentence for each buffer of `outputs` that is not a number somewhere, or a share that leaves [0, 1]."""
    mask, module = frame.mask, frame.info["module"]
    for name in outputs:
        if name not in frame.buffers or not mask.any():
            continue
        values = frame[name][mask]
        wrong = 1 - np.isfinite(values).reshape(len(values), -1).all(axis=1).mean()
        if wrong:
            yield (
                f"{module}: '{name}' is NaN or infinite in {_percent(wrong)} of the surfaces' pixels. Likely causes: a "
                "division by 0, sqrt or pow of a negative number, acos beyond [-1, 1], normalize of a zero vector"
            )
        elif (about := frame.table.get(name)) and about.kind == "share" and _leaves(values):
            yield (
                f"{module}: '{name}' reaches from {values.min():.3g} to {values.max():.3g}; it is a share, in [0, 1]. "
                "Likely causes: a sum that is not divided by its weights, a hemisphere that is turned over"
            )


def _leaves(values: np.ndarray) -> bool:
    return bool(values.min() < -ROUNDING or values.max() > 1 + ROUNDING)


def _percent(share: float) -> str:
    return "less than 1 %" if share < 0.01 else f"{share:.0%}".replace("%", " %")
