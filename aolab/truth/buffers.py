"""The buffers of a reference: the integrals that each is made of, its value, and its standard error."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from .moments import Moments, Pair

EMPTY = np.float32(1e-6)  # a denominator below this is 0: nothing arrived
PI = np.float32(np.pi)


@dataclass(frozen=True)
class Buffer:
    """`value` and `variance` return (n, channels) from the moments of `integrals` and from the albedo (n, 3) there.

    The channels are those of the table of all buffers, `aolab.modules.buffers`. `crosses` are the pairs of integrals
    whose covariance `variance` looks at. The integral `light` is the lights' irradiance at the points; it is exact, and
    costs no rays over the hemisphere.
    """

    integrals: tuple[str, ...]
    value: Callable[[Moments, np.ndarray], np.ndarray]
    variance: Callable[[Moments, np.ndarray], np.ndarray]
    crosses: tuple[Pair, ...] = ()

    def error(self, moments: Moments, albedo: np.ndarray) -> np.ndarray:
        """(n, channels): the standard error of the value."""
        return np.sqrt(self.variance(moments, albedo))


def standard_error(name: str) -> str:
    """The name of the buffer that holds the standard error of the buffer `name`."""
    return "standard_error" if name == "visibility" else f"{name}_standard_error"


def with_errors(names: Iterable[str]) -> list[str]:
    """`names`, each followed by its standard error; the image, a picture of the radiance, has none."""
    return [name for base in names for name in ([base, standard_error(base)] if base in BUFFERS else [base])]


def base_of(name: str) -> str:
    """The buffer that `name` is, or is the standard error of."""
    return "visibility" if name == "standard_error" else name.removesuffix("_standard_error")


def _linear(integral: str, factor: Callable[[np.ndarray], np.ndarray | np.float32], part: slice) -> Buffer:
    """A buffer that is a mean times a factor, which may depend on the albedo."""
    return Buffer(
        (integral,),
        lambda moments, albedo: factor(albedo) * moments.mean(integral)[:, part],
        lambda moments, albedo: factor(albedo) ** 2 * moments.variance(integral)[:, part],
    )


def _one(albedo: np.ndarray) -> np.float32:
    return np.float32(1)


def _albedo(albedo: np.ndarray) -> np.ndarray:
    return albedo  # albedo/π × radiance × π: the density of the rays is cosθ/π


ALL = slice(None)


def _bent_normal(moments: Moments, albedo: np.ndarray) -> np.ndarray:
    return moments.mean("open_direction") / np.maximum(moments.mean("open"), EMPTY)


def _bent_normal_variance(moments: Moments, albedo: np.ndarray) -> np.ndarray:
    """Of a ratio A / B: (var A - 2 r cov(A, B) + r² var B) / B², to first order."""
    ratio, below = _bent_normal(moments, albedo), np.maximum(moments.mean("open"), EMPTY)
    covariance = moments.covariance("open_direction", "open")
    variance = moments.variance("open_direction") - 2 * ratio * covariance + ratio**2 * moments.variance("open")
    return np.maximum(variance, 0) / below**2


def _transfer(moments: Moments, albedo: np.ndarray) -> np.ndarray:
    """Eq. 6 of Umenhoffer et al. 2009; 0/0, a point that sees no sky at all under albedo 1, is 0."""
    above, below = moments.mean("fuzzy"), 1 - moments.mean("closed_albedo")
    return np.where(above > 0, above / np.maximum(below, EMPTY), 0)


def _transfer_variance(moments: Moments, albedo: np.ndarray) -> np.ndarray:
    """Of the ratio O / (1 - C), as above: the covariance of O and 1 - C is -cov(O, C)."""
    ratio, below = _transfer(moments, albedo), np.maximum(1 - moments.mean("closed_albedo"), EMPTY)
    covariance = moments.covariance("closed_albedo", "fuzzy")
    variance = moments.variance("fuzzy") + 2 * ratio * covariance + ratio**2 * moments.variance("closed_albedo")
    return np.maximum(variance, 0) / below**2


def _radiance(moments: Moments, albedo: np.ndarray) -> np.ndarray:
    arriving = moments.mean("light") / PI + moments.mean("environment") + moments.mean("sender")
    return albedo * arriving


def _radiance_variance(moments: Moments, albedo: np.ndarray) -> np.ndarray:
    """The rays of the environment and of the senders are the same: their covariance counts."""
    both = 2 * moments.covariance("environment", "sender")
    variance = moments.variance("environment") + moments.variance("sender") + both
    return albedo**2 * np.maximum(variance, 0)


BUFFERS: dict[str, Buffer] = {
    "visibility": _linear("open", _one, ALL),
    "ambient": _linear("environment", _albedo, ALL),
    "indirect": _linear("sender", _albedo, ALL),
    "bent_normal": Buffer(
        ("open", "open_direction"), _bent_normal, _bent_normal_variance, (("open_direction", "open"),)
    ),
    **{f"sh{i}": _linear("harmonics", lambda albedo: PI, slice(4 * i, 4 * i + 4)) for i in range(4)},
    "obscurance": _linear("fuzzy", _one, ALL),
    "transfer": Buffer(("fuzzy", "closed_albedo"), _transfer, _transfer_variance, (("closed_albedo", "fuzzy"),)),
    "transfer_multibounce": _linear("path", _one, ALL),
    "direct": _linear("light", lambda albedo: albedo / PI, ALL),
    "radiance": Buffer(("light", "environment", "sender"), _radiance, _radiance_variance, (("environment", "sender"),)),
}
