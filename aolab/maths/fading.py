"""How much of a direction an occluder leaves open, as a function of its distance: the fading of its influence."""

from collections.abc import Callable
from typing import Literal, get_args

import numpy as np

from .sampling import influence

Curve = Literal["classical", "linear", "sqrt", "exponential", "wendland"]
# a number is the `falloff` of the modules: a smoothstep over that outer share of the radius. A tuple is a user's curve:
# its values at equal steps from 0 to the radius, linear between them
Fading = float | Curve | tuple[float, ...]
CURVES: tuple[str, ...] = get_args(Curve)
EXPONENTIAL_END = 1 / 256  # the share of the exponential measure's samples that end at its farthest distance


def openness(distance: np.ndarray, fading: Fading, sigma: float = 1.0) -> np.ndarray:
    """The open share (n,) in [0, 1] of directions whose occluder is at `distance` (n,), in radii; 1 for no occluder.

    - a number f in [0, 1]: smoothstep(1 - f, 1, distance), so that 0 is a hard edge at the radius (`influence`);
    - `classical`: the hard edge; `linear`: d, and `sqrt`: √d, up to the radius; `exponential`: 1 - exp(-sigma d), also
      beyond the radius (the measures μ of Umenhoffer, Tóth and Szirmay-Kalos 2009, figure 1);
    - `wendland`: 1 - (1 - d)⁴ (4 d + 1) up to the radius (Reinbothe, Boubekeur and Alexa 2009, equation 3);
    - a tuple: values at equal steps from 0 to the radius; beyond the radius, 1.
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
    if isinstance(fading, tuple):
        return np.interp(distance, np.linspace(0, 1, len(fading)), fading, right=1.0).astype(distance.dtype)
    assert not isinstance(fading, str)  # `Question` refuses other names
    return 1 - influence(within**2, fading)


def density(distance: np.ndarray, fading: Curve, sigma: float = 1.0) -> np.ndarray:
    """μ'(d) (n,): the derivative of `openness`, per radius; 0 beyond the radius.

    The hard edge has all of its density at the radius: 0 is returned elsewhere.
    """
    inside = distance < 1
    if fading == "classical":
        return np.zeros_like(distance)
    if fading == "exponential":
        return sigma * np.exp(-sigma * distance)
    if fading == "linear":
        return inside.astype(distance.dtype)
    if fading == "sqrt":
        return inside / (2 * np.sqrt(np.maximum(distance, np.finfo(distance.dtype).tiny)))
    within = np.minimum(distance, 1)
    return 20 * within * (1 - within) ** 3


def inverse(share: np.ndarray, fading: Curve, sigma: float = 1.0) -> np.ndarray:
    """μ⁻¹(ξ) (n,): the distances, in radii, at which the openness reaches `share` (n,) in [0, 1].

    Of uniform shares, the distances have the density μ'. The exponential curve ends where `EXPONENTIAL_END` is missing.
    """
    if fading == "classical":
        return np.ones_like(share)
    if fading == "exponential":
        return -np.log(np.maximum(1 - share, EXPONENTIAL_END)) / sigma
    if fading == "linear":
        return share
    if fading == "sqrt":
        return share * share
    return inverted(lambda distance: openness(distance, fading), share)


def inverted(curve: Callable[[np.ndarray], np.ndarray], share: np.ndarray) -> np.ndarray:
    """The distances (n,) in [0, 1] at which the growing function `curve` reaches `share` (n,), by bisection."""
    low, high = np.zeros_like(share), np.ones_like(share)
    for _ in range(52):  # the digits of float64
        middle = (low + high) / 2
        below = curve(middle) < share
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return high


def is_hard(fading: Fading) -> bool:
    """Whether an occluder blocks wholly within the radius, and not at all beyond: its distance need not be known."""
    return fading in ("classical", 0)


def reach(fading: Fading, radius: float) -> float:
    """The distance from which on occluders count nothing, in the unit of `radius`; it may be infinite."""
    return np.inf if fading == "exponential" else radius
