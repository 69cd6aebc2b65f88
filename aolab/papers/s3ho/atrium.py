"""The large scene of S3HO's figures 1 and 9: the atrium, whose sun is a part of its environment."""

import numpy as np

from ...loading import load
from ...scene.environment import Environment
from ...scene.lights import DirectionalLight
from ...scene.scene import Scene

RADIUS = 0.6  # metres: reaches across the mouldings and the folds of the curtains
SUN = 6.0  # degrees across, as by default in a sky of aolab's own


def atrium() -> Scene:
    """The atrium without lights: the sun is a disc in the environment, because the methods occlude the environment."""
    scene = load("atrium")
    (sun,) = scene.lights
    assert isinstance(sun, DirectionalLight)
    assert scene.environment is not None  # Scene fills it in
    sharp = np.array(sun.irradiance) / (2 * np.pi * (1 - np.cos(np.radians(SUN / 2))))
    black = (0.0, 0.0, 0.0)
    disc = Environment.sky(
        black, black, black, sun_direction=tuple(-np.array(sun.direction)), sun_radiance=tuple(sharp), sun_angle=SUN
    )
    return scene.replace(lights=(), environment=Environment(scene.environment.radiance + disc.radiance, "sun and sky"))
