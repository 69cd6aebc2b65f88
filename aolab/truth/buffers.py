"""The buffers of a reference: which integrals each is made of, and how."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from .points import Points

Means = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Buffer:
    """`finish(means, points)` makes (n, channels) from the `integrals` (names of `integrals.INTEGRANDS`).

    `light` is the lights' irradiance, at the points; it is no integral over the hemisphere and costs no rays of it.
    """

    channels: int
    integrals: tuple[str, ...]
    finish: Callable[[Means, Points], np.ndarray]
    background: float = 0.0


def _bent_normal(means: Means, points: Points) -> np.ndarray:
    return means["open_direction"] / np.maximum(means["open"], np.float32(1e-6))


def _transfer(means: Means, points: Points) -> np.ndarray:
    """Eq. 6 of Umenhoffer et al. 2009; 0/0, a point that sees no sky at all under albedo 1, is 0."""
    numerator, denominator = means["fuzzy"], 1 - means["closed_albedo"]
    return np.where(numerator > 0, numerator / np.maximum(denominator, np.float32(1e-6)), 0)


def _direct(means: Means, points: Points) -> np.ndarray:
    return points.albedo / np.float32(np.pi) * means["light"]


def _ambient(means: Means, points: Points) -> np.ndarray:
    return points.albedo * means["environment"]  # albedo/π × L × π: the density of the rays is cosθ/π


def _indirect(means: Means, points: Points) -> np.ndarray:
    return points.albedo * means["sender"]


def _harmonics(first: int) -> Callable[[Means, Points], np.ndarray]:
    return lambda means, points: np.float32(np.pi) * means["harmonics"][:, first : first + 4]


BUFFERS: dict[str, Buffer] = {
    "visibility": Buffer(1, ("open",), lambda means, points: means["open"]),
    "standard_error": Buffer(1, ("open",), lambda means, points: means["standard_error"], np.nan),
    "ambient": Buffer(3, ("environment",), _ambient),
    "indirect": Buffer(3, ("sender",), _indirect),
    "bent_normal": Buffer(3, ("open", "open_direction"), _bent_normal),
    **{f"sh{i}": Buffer(4, ("harmonics",), _harmonics(4 * i)) for i in range(4)},
    "obscurance": Buffer(1, ("fuzzy",), lambda means, points: means["fuzzy"]),
    "transfer": Buffer(3, ("fuzzy", "closed_albedo"), _transfer),
    "transfer_multibounce": Buffer(3, ("path",), lambda means, points: means["path"]),
    "direct": Buffer(3, ("light",), _direct),
    "radiance": Buffer(
        3,
        ("light", "environment", "sender"),
        lambda means, points: _direct(means, points) + _ambient(means, points) + _indirect(means, points),
    ),
}
