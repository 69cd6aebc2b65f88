"""One buffer compared: its values, its reference, and the error of each pixel."""

from dataclasses import dataclass

import numpy as np

from .metrics import Measures, angles
from .quantities import Kind

NOISY = 1 / 3  # of the RMSE: this much noise of the reference is 11 % of the squared error


@dataclass(frozen=True, eq=False)
class BufferComparison:
    """One buffer: `result` and `reference` (H, W, C) float32, and `foreground` (H, W), the compared pixels.

    `measures` are by region. Those of the whole foreground are attributes: `comparison["visibility"].rmse`.
    """

    name: str
    kind: Kind
    result: np.ndarray
    reference: np.ndarray
    foreground: np.ndarray
    measures: dict[str, Measures]

    def __getattr__(self, name: str) -> float:
        if name in Measures.__dataclass_fields__:
            return getattr(self.measures["all"], name)
        raise AttributeError(f"{type(self).__name__} has no attribute '{name}'")

    @property
    def is_noisy(self) -> bool:
        """Whether the reference's own noise, where it is known, is a good part of the RMSE."""
        return self.noise > NOISY * self.rmse > 0

    @property
    def about_noise(self) -> str:
        """The share of the reference's own noise in the RMSE, in words."""
        rest = np.sqrt(max(self.rmse**2 - self.noise**2, 0))
        return (
            f"the reference's own standard error, {self.noise:.2g}, is {self.noise / self.rmse:.0%} of the RMSE, "
            f"{self.rmse:.2g}; without it the RMSE is about {rest:.2g}"
        )

    @property
    def error(self) -> np.ndarray:
        """(H, W) float64: each pixel's error, as `Kind.error` defines it; NaN where nothing is compared."""
        difference = self.result.astype(np.float64) - self.reference
        if self.kind.error == "angle":
            values = angles(self.result, self.reference)
        elif self.kind.error == "norm":
            values = np.linalg.norm(difference, axis=2)
        else:
            values = difference.mean(axis=2)
        return np.where(self.foreground, values, np.nan)
