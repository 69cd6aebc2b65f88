"""The stage of the article's figures: the Cornell box in the light of a spot, and a little daylight."""

from ...loading import load
from ...scene.environment import Environment
from ...scene.lights import SpotLight
from ...scene.scene import Scene

SPOT = SpotLight((0, 5.4, -2.8), (0, -1, 0), (36.0, 28.0, 18.0), inner=50, outer=60)


def stage(daylight: float = 0.2) -> Scene:
    """The room; without `daylight`, the spot is the only light."""
    room = load("cornell", daylight=max(daylight, 0.01)).replace(lights=(SPOT,))
    return room if daylight else room.replace(environment=Environment.constant(0.0))
