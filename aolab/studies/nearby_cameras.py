"""Cameras for a scene: its own camera, and cameras beside it that look at the same point."""

from dataclasses import replace

import numpy as np

from ..errors import ParameterError, notice
from ..gl.texture import Size
from ..pipeline.lab import Lab
from ..scene.camera import Camera
from ..scene.scene import Scene

STEP = 15.0  # degrees: other surfaces are hidden and seen, and the same objects are still in the picture
CLEARANCE = 0.5  # share of the distance from the scene's own camera to its nearest surface: no pillar before the lens
LEAST = 2.0  # degrees; a smaller angle gives nearly the same view


def turned(camera: Camera, degrees: float) -> Camera:
    """The camera, its eye moved by `degrees` around the axis `up` through its target, counterclockwise from above."""
    up = np.asarray(camera.up) / np.linalg.norm(camera.up)
    arm, angle = np.subtract(camera.eye, camera.target), np.radians(degrees)
    # Rodrigues' rotation
    arm = arm * np.cos(angle) + np.cross(up, arm) * np.sin(angle) + up * (up @ arm) * (1 - np.cos(angle))
    return replace(camera, eye=tuple(np.add(camera.target, arm).tolist()))


def cameras(scene: Scene, count: int, lab: Lab, size: Size) -> dict[float, Camera]:
    """{degrees: camera}: the scene's own, at 0, and turned by 15, -15, 30, -30, ... degrees, `count` in all.

    An angle is halved until the picture shows a surface, and the nearest surface is at least half as far as from the
    scene's own camera. Below 2 degrees, or if the angle is used already, the camera is left out with a `Notice`.
    Raises `ParameterError` if `count` is not a whole number from 1 on.
    """
    if not isinstance(count, int) or count < 1:
        raise ParameterError(f"views = {count!r} is not a whole number from 1 on")
    own = scene.camera
    assert own is not None  # every scene has a camera
    nearest = _nearest(scene, own, lab, size)
    found = {0.0: own}
    for index in range(1, count):
        wanted = degrees = STEP * ((index + 1) // 2) * (1 if index % 2 else -1)
        while (
            abs(degrees) >= LEAST
            and not CLEARANCE * nearest <= _nearest(scene, turned(own, degrees), lab, size) < np.inf
        ):
            degrees /= 2
        if abs(degrees) >= LEAST and degrees not in found:
            found[degrees] = turned(own, degrees)
        else:
            notice(f"{scene.name}: no free view near {wanted:g} degrees; it is left out")
    return found


def _nearest(scene: Scene, camera: Camera, lab: Lab, size: Size) -> float:
    """Distance along the view axis to the nearest surface in the picture; infinite if there is none."""
    return float(-lab.render(scene, "none", camera=camera, size=size)["viewZ"].max())
