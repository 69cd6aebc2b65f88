"""Lights, in the terms of glTF's KHR_lights_punctual: each illuminates, casts a shadow, and has no size."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.numbers import numbers, vector
from .camera import Vec3


def _check(light: object, **values: object) -> None:
    for name, value in values.items():
        array = vector(value)
        if array is None:
            raise SceneError(f"{type(light).__name__}: {name} = {value!r:.80} is not three finite numbers")
        if name in ("intensity", "irradiance") and (array < 0).any():
            raise SceneError(f"{type(light).__name__}: {name} = {value} is negative")
        if name == "direction" and not np.linalg.norm(array) > 0:
            raise SceneError(f"{type(light).__name__}: direction = {value} has no length")


@dataclass(frozen=True)
class DirectionalLight:
    """A sun. `direction` is the way the light travels (world space); `irradiance` is RGB on a facing surface."""

    direction: Vec3
    irradiance: Vec3 = (1.0, 1.0, 1.0)
    shadow: bool = True

    def __post_init__(self) -> None:
        _check(self, direction=self.direction, irradiance=self.irradiance)


@dataclass(frozen=True)
class PointLight:
    """A bulb. `intensity` is RGB power per solid angle: irradiance = intensity / distance² on a facing surface."""

    position: Vec3
    intensity: Vec3 = (1.0, 1.0, 1.0)
    shadow: bool = True

    def __post_init__(self) -> None:
        _check(self, position=self.position, intensity=self.intensity)


@dataclass(frozen=True)
class SpotLight:
    """A bulb in a cone: full inside `inner`, none outside `outer` (half angles, degrees, 0 <= inner < outer < 90)."""

    position: Vec3
    direction: Vec3
    intensity: Vec3 = (1.0, 1.0, 1.0)
    inner: float = 20.0
    outer: float = 30.0
    shadow: bool = True

    def __post_init__(self) -> None:
        _check(self, position=self.position, direction=self.direction, intensity=self.intensity)
        angles = numbers((self.inner, self.outer))
        if angles is None or not 0 <= angles[0] < angles[1] < 90:
            raise SceneError(f"SpotLight: inner = {self.inner}, outer = {self.outer} are not 0 <= inner < outer < 90")


Light = DirectionalLight | PointLight | SpotLight
MAX_SHADOW_TILES = 256  # shadow maps of all lights: an atlas of 8192 pixels a side, 256 MB


def shadow_tiles(light: Light) -> int:
    """How many shadow maps the light needs, were it to cast a shadow: a point light looks along six axes."""
    return 6 if isinstance(light, PointLight) else 1
