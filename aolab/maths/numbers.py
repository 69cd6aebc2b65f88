"""Numbers that users give."""

import numpy as np


def vector(value: object) -> np.ndarray | None:
    """`value` as an array (3,) of float64; None if it is anything but three finite numbers."""
    found = numbers(value)
    return found if found is not None and found.shape == (3,) and np.isfinite(found).all() else None


def numbers(value: object) -> np.ndarray | None:
    """`value` as an array of float64; None if it holds anything but numbers."""
    try:
        return np.asarray(value, float)
    except (TypeError, ValueError):
        return None
