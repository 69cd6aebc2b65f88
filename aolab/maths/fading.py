"""How much of a direction an occluder leaves open, as a function of its distance: the fading of its influence."""

from typing import Literal, get_args

import numpy as np

from .sampling import influence

Curve = Literal["classical", "linear", "sqrt", "exponential", "wendland"]
# a number is the `falloff` of the modules: a smoothstep over that outer share of the radius
Fading = float | Curve
CURVES: tuple[str, ...] = get_args(Curve)


def openness(distance: np.ndarray, fading: Fading, sigma: float = 1.0) -> np.ndarray:
    """The open share (n,) in [0, 1] of directions whose occluder is at `distance` (n,), in radii; 1 for no occluder.

    - a number f in [0, 1]: smoothstep(1 - f, 1, distance), so that 0 is a hard edge at the radius (`influence`);
    - `classical`: the hard edge; `linear`: d, and `sqrt`: √d, up to the radius; `exponential`: 1 - exp(-sigma d), also
      beyond the radius (the measures μ of Umenhoffer, Tóth and Szirmay-Kalos 2009, figure 1);
    - `wendland`: 1 - (1 - d)⁴ (4 d + 1) up to the radius (Reinbothe, Boubekeur and Alexa 2009, equation 3).
    """
    if is_hard(fading):
        return (distance >= 1).astype(distance.dtype)
    if fading == "exponential":
        return 1 - np.exp(-sigma * distance)
    within = np.minimum(distance, 1)
    if fading == "linear":
        return within
    if fading == "sqrt":
        return np.sqrt(within)
    if fading == "wendland":
        return 1 - (1 - within) ** 4 * (4 * within + 1)
    assert not isinstance(fading, str)  # `Question` refuses other names
    return 1 - influence(within**2, fading)


def is_hard(fading: Fading) -> bool:
    """Whether an occluder blocks wholly within the radius, and not at all beyond: its distance need not be known."""
    return fading in ("classical", 0)


def reach(fading: Fading, radius: float) -> float:
    """The distance from which on occluders count nothing, in the unit of `radius`; it may be infinite."""
    return np.inf if fading == "exponential" else radius
