"""Cameras and lights at a node's pose: both look down its -z, with y up."""

from collections.abc import Sequence

import numpy as np

from ..scene.camera import Camera, Vec3
from ..scene.lights import DirectionalLight, Light, PointLight, SpotLight


def camera_at(world_from_camera: np.ndarray, **lens: float | None) -> Camera:
    """A camera at a node; `lens`: `fov`, `ortho`, `near`, `far` of `Camera`.

    A scale of the node has no effect, as in glTF. Raises `SceneError` for a camera that sees nothing.
    """
    eye, forward, up = world_from_camera[:3, 3], -world_from_camera[:3, 2], world_from_camera[:3, 1]
    forward, up = (axis / max(float(np.linalg.norm(axis)), 1e-300) for axis in (forward, up))
    return Camera(eye=_tuple(eye), target=_tuple(eye + forward), up=_tuple(up), **lens)  # type: ignore[arg-type]


def light_at(
    world_from_light: np.ndarray, color: np.ndarray, has_position: bool, cone: Sequence[float] | None
) -> Light:
    """A light at a node. `color` (3,) is its irradiance or intensity; `cone` the inner and outer half angle (degrees).

    Raises `SceneError` for a light that is not finite, negative, or has no direction.
    """
    position, direction, rgb = _tuple(world_from_light[:3, 3]), _tuple(-world_from_light[:3, 2]), _tuple(color)
    if not has_position:
        return DirectionalLight(direction, rgb)
    return PointLight(position, rgb) if cone is None else SpotLight(position, direction, rgb, cone[0], cone[1])


def _tuple(vector: np.ndarray) -> Vec3:
    x, y, z = np.asarray(vector, float).tolist()
    return x, y, z
