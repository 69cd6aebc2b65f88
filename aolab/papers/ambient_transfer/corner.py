"""A floor in front of an endless wall, where obscurance has a closed form."""

import numpy as np

from ...modules.measures import Measure
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.environment import Environment
from ...scene.mesh import Material, Mesh
from ...scene.scene import Instance, Scene
from ..pixels import world_positions

COLOR = (0.8, 0.6, 0.4)
MIDDLE = 0.5  # half the width of the measured floor: its surroundings are on the screen


def corner() -> Scene:
    """The wall stands in the plane x = 0; the sky is white."""
    floor = np.array([(0, 0, 40), (40, 0, 40), (40, 0, -40), (0, 0, -40)], float)
    wall = np.array([(0, 0, 40), (0, 0, -40), (0, 40, -40), (0, 40, 40)], float)
    faces = np.array([(0, 1, 2), (0, 2, 3)])
    instances = tuple(
        Instance(Mesh(corners, faces, material=Material(COLOR), name=name))
        for corners, name in ((floor, "floor"), (wall, "wall"))
    )
    camera = Camera((2.6, 2.2, 0), (0.3, 0.35, 0), fov=48)  # sees the wall up to a height of 1.4
    return Scene(instances, (), Environment.constant(1.0), camera, name="corner")


def beside_the_wall(frame: Frame, nearest: float, farthest: float) -> tuple[np.ndarray, np.ndarray]:
    """(H, W) bool: the floor between two distances from the wall, and its distances (n,)."""
    x, y, z = np.moveaxis(world_positions(frame), -1, 0)
    near = frame.mask & (np.abs(y) < 1e-3) & (np.abs(z) < MIDDLE) & (x > nearest) & (x < farthest)
    return near, x[near]


def exact(distance: np.ndarray, measure: Measure) -> np.ndarray:
    """The obscurance (n,) of the floor at `distance` (n,) from the wall, in radii.

    Cosine-distributed directions are uniform over the unit disc (Nusselt's analogue). A ray of length ρ meets the wall
    where its coordinate on the disc is over c = distance / ρ: the blocked share is (arccos c - c √(1 - c²)) / π. Its
    mean over ρ with the density μ' is 1 - O.
    """
    reach = measure.inverse((np.arange(1000) + 0.5) / 1000)
    c = np.clip(distance[:, None] / np.maximum(reach, 1e-9), 0, 1)
    return 1 - ((np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi).mean(axis=1)
