"""The stage of SSDO's figures 3, 13 and 14, and their modules."""

from dataclasses import replace

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules import SSAO, SSDO, Module
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.lights import PointLight
from ...scene.mesh import Material
from ...scene.scene import Scene
from ..pixels import world_positions

PALE, YELLOW = 0.8, Material((0.85, 0.62, 0.06), name="yellow")
RADIUS = 1.0  # scene units: the boxes are 1.05 wide
ACCUMULATE = 4  # frames, so that noise is no part of the comparison

OCCLUSION = SSAO(radius=RADIUS, directions=16, steps=8)
DIRECTIONAL = SSDO(radius=RADIUS, directions=16, steps=8)
BOUNCE = DIRECTIONAL.replace(bounces=1)
# The paper's: one point at a random distance per direction, the sum over open directions, senders as patches. Here too
# directions have cosine density, and the sums are weighted for it.
PRINTED = BOUNCE.replace(steps=1, estimator="plain", senders="patches")


def stage(albedo: float = PALE) -> Scene:
    """Two pale boxes and a yellow one on a pale floor, pink light from the left and turquoise from the right.

    As in the paper, the light is an environment and one point light with a shadow map. `albedo` is that of the pale
    surfaces; the yellow box is scaled by the same factor, and keeps its hue.
    """
    boxes = load("boxes")
    pale = Material((albedo, albedo, albedo), name="pale")
    red, green, blue = YELLOW.base_color
    yellow = Material((red * albedo / PALE, green * albedo / PALE, blue * albedo / PALE), name="yellow")
    *others, right = boxes.instances
    painted = [replace(one, mesh=replace(one.mesh, material=pale)) for one in others]
    painted.append(replace(right, mesh=replace(right.mesh, material=yellow)))
    bulb = PointLight((2.6, 4.2, 4.6), (26.0, 24.0, 21.0))
    return boxes.replace(instances=tuple(painted), lights=(bulb,))


def drawn(scene: Scene, module: Module, size: Size) -> Frame:
    return shared_lab().render(scene, module, size=size, accumulate=ACCUMULATE)


def floor(frame: Frame) -> np.ndarray:
    """(H, W) bool: the horizontal part of the stage's backdrop."""
    up = frame.world_normal()[..., 1]
    with np.errstate(invalid="ignore"):
        return frame.mask & (up > 0.999) & (np.abs(world_positions(frame)[..., 1]) < 0.02)
