"""HAO, figure 9: occluders that the camera does not see, by SSAO and by HAO."""

from collections.abc import Callable

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules import SSAO, Module
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ...scene.camera import Camera
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ...truth import reference
from ..figure import Figure, Need, figure
from .settings import TABLE_1, occlusion

GREY = Material((0.7, 0.7, 0.7))
MODULES: dict[str, Module] = {
    "SSAO": SSAO(directions=32, steps=8),
    "HAO": TABLE_1,
    "HAO, 32 steps": TABLE_1.replace(steps=32),
}


def hidden() -> tuple[Scene, Scene]:
    """A round column behind another one, which hides all of it; and the scene without it."""
    return load("colonnade", fluted=False), load("colonnade", fluted=False, hidden=False)


def outside() -> tuple[Scene, Scene]:
    """A floor beside a high block that lies to the left of the picture; and the floor alone."""
    camera = Camera(eye=(0, 4, 0.01), target=(0, 0, 0), fov=40)
    left = -4 * float(np.tan(np.radians(20))) * 16 / 9  # of the picture, on the floor
    floor = Instance(block((12, 0.2, 6), GREY, "floor"), placed(0, -0.2, 0))
    # without the block, another one far away leaves the bounds, and so the voxels, as they are
    wall, far = (Instance(block((1, 2, 5), GREY, "wall"), placed(x, 0, 0)) for x in (left - 0.52, 5.49))
    return Scene((floor, wall, far), camera=camera), Scene((floor, far), camera=camera)


CASES: dict[str, tuple[Callable[[], tuple[Scene, Scene]], float]] = {
    "behind the front object": (hidden, 2.0),
    "outside the view": (outside, 1.0),
}


def fig9(size: Size = (320, 180), rays: int = 128) -> Figure:
    """An occluder behind the front object, and one outside the view, by SSAO, by HAO and by rays.

    Numbers: the occlusion that the occluder adds to the picture, over that which rays find, for the same question.
    Eight steps of a wide radius are longer than a voxel, and some rays pass through the hollow column.
    """
    found: dict[str, dict[str, float]] = {}
    needs, pictures = [], []
    for case, (make, radius) in CASES.items():
        scenes = make()
        found[case] = {}
        for name, module in MODULES.items():
            asked = module.replace(radius=radius)
            drawn = [shared_lab().render(scene, asked, size=size, accumulate=4) for scene in scenes]
            truths = [reference(scene, size=size, like=asked, rays=rays, buffers=("visibility",)) for scene in scenes]
            added, right = (float((occlusion(whole) - occlusion(bare)).sum()) for whole, bare in (drawn, truths))
            found[case][name] = added / right
            pictures.append((f"{name}, {case}", gray(drawn[0]["visibility"])))
        truth = reference(scenes[0], size=size, like=TABLE_1.replace(radius=radius), rays=rays, buffers=("visibility",))
        pictures.append((f"rays, {case}", gray(truth["visibility"])))
        needs += [
            Need(f"SSAO's added occlusion over rays', {case}", found[case]["SSAO"], -0.1, 0.1),
            Need(f"HAO's added occlusion over rays', {case}, 8 steps", found[case]["HAO"], 0.4, 1.3),
            Need(f"HAO's added occlusion over rays', {case}, 32 steps", found[case]["HAO, 32 steps"], 0.75, 1.3),
        ]
    claim = "Occluders behind the front object and outside the view darken the receiver by HAO, and not by SSAO"
    return figure("HAO, Fig. 9", claim, needs, {"added_over_rays": found, "rays": rays}, pictures, 4)
