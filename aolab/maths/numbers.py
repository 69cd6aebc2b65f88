"""Numbers that users give."""

import numpy as np


def numbers(value: object) -> np.ndarray | None:
    """`value` as an array of float64; None if it holds anything but numbers."""
    try:
        return np.asarray(value, float)
    except (TypeError, ValueError):
        return None
