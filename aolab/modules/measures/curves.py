"""The measures of figure 1: curves with closed forms, in NumPy (`aolab.maths.fading`) and in GLSL."""

from typing import ClassVar

import numpy as np

from ...maths import fading
from ..parameters import parameter
from .base import Measure


class _Curve(Measure):
    """A curve of `aolab.maths.fading`."""

    curve: ClassVar[fading.Curve]

    def openness(self, distance: np.ndarray) -> np.ndarray:
        return fading.openness(distance, self.curve, self._sigma)

    def density(self, distance: np.ndarray) -> np.ndarray:
        return fading.density(distance, self.curve, self._sigma)

    def inverse(self, share: np.ndarray) -> np.ndarray:
        return fading.inverse(share, self.curve, self._sigma)

    @property
    def fading(self) -> fading.Fading:
        return self.curve

    @property
    def _sigma(self) -> float:
        return 1.0


class Classical(_Curve):
    """Occluders within the radius block wholly: ambient occlusion."""

    name = "classical"
    curve = "classical"
    shader = "measures/classical.glsl"


class Linear(_Curve):
    """The openness grows with the distance, up to the radius."""

    name = "linear"
    curve = "linear"
    shader = "measures/linear.glsl"


class Sqrt(_Curve):
    """The square root of the distance (Méndez et al. 2005): near occluders count most."""

    name = "sqrt"
    curve = "sqrt"
    shader = "measures/sqrt.glsl"


class Exponential(_Curve):
    """Fog that scatters and does not absorb: 1 - exp(-σ d), also beyond the radius."""

    name = "exponential"
    curve = "exponential"
    shader = "measures/exponential.glsl"

    sigma: float = parameter(
        3.0, "Density of the fog, σ; 3 leaves 5 % to occluders beyond the radius.", gt=0, le=100, unit="1 / radii"
    )

    @property
    def _sigma(self) -> float:
        return self.sigma
