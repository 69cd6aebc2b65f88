"""SSDO, figure 4: a bounce that fades as its sender turns out of the view."""

import numpy as np

from ...gl.texture import Size
from ...modules import Module
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.environment import Environment
from ...scene.lights import DirectionalLight
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, Need, figure
from ..pixels import world_positions
from .stage import ACCUMULATE, BOUNCE, PRINTED, YELLOW

TOTAL, FRAMES = 105.0, 22  # degrees that the camera goes around, from before the yellow side to behind it; frames
RADIUS = 0.8  # scene units, the height of the box
MODULES: dict[str, Module] = {"SSDO": BOUNCE.replace(radius=RADIUS), "as printed": PRINTED.replace(radius=RADIUS)}


def fig4(size: Size = (400, 225), frames: int = FRAMES, rays: int = 128) -> Figure:
    """Four frames of a camera path around a box: its yellow side, which lights the floor, turns out of the view.

    Numbers: the bounce on one patch of the floor, frame by frame, in that of the first frame, and the first frame's in
    that of rays. The path is taken in two step sizes: a jump would stay as large when the steps are halved, whereas a
    continuous change halves with them.
    """
    degrees = np.linspace(0, TOTAL, 2 * frames - 1).tolist()
    paths = {
        name: np.array([_bounce(_drawn(size, angle, module)) for angle in degrees]) for name, module in MODULES.items()
    }
    chosen = np.linspace(0, 2 * frames - 2, 4).round().astype(int).tolist()
    truths = [
        reference(_scene(degrees[i]), size=size, like=MODULES["SSDO"], rays=rays, buffers=("indirect",)) for i in chosen
    ]
    right = _bounce(truths[0])
    needs, numbers = [], {"degrees": degrees, "bounce": {}, "first_over_rays": {}, "largest_change": {}}
    for name, path in paths.items():
        values = path / path[0]
        coarse, fine = (float(np.abs(np.diff(v)).max()) for v in (values[::2], values))
        numbers["bounce"][name], numbers["first_over_rays"][name] = values.tolist(), float(path[0] / right)
        numbers["largest_change"][name] = {"of_whole_steps": coarse, "of_half_steps": fine}
        least, most = (0.8, 1.2) if name == "SSDO" else (0.2, 2.0)
        needs += [
            Need(f"the first bounce over rays', {name}", float(path[0] / right), least, most),
            Need(f"the last bounce over the first, {name}", float(values[-1]), below=0.05),
            Need(f"the largest change from frame to frame, {name}", coarse, below=0.25),
            Need(f"the largest change, half steps over whole ones, {name}", fine / coarse, below=0.75),
        ]
    claim = "As its sender turns out of the view, the bounce fades to nothing without a jump"
    pictures = []
    for name, module in MODULES.items():
        seen = [_drawn(size, degrees[i], module, ACCUMULATE) for i in chosen]
        if name == "SSDO":
            pictures += [(f"{degrees[i]:.0f}° around", frame.image) for i, frame in zip(chosen, seen, strict=True)]
        pictures += [
            (
                f"4 times the bounce, {name}: {paths[name][i] / paths[name][0]:.2f} of the first",
                shown(4 * frame["indirect"]),
            )
            for i, frame in zip(chosen, seen, strict=True)
        ]
    pictures += [(f"4 times the bounce, rays: {_bounce(t) / right:.2f}", shown(4 * t["indirect"])) for t in truths]
    return figure("SSDO, Fig. 4", claim, needs, numbers, pictures, 4)


def _scene(degrees: float) -> Scene:
    angle = np.radians(degrees)
    eye = 5.2 * np.sin(angle), 4.4, 0.5 + 5.2 * np.cos(angle)
    yellow = Instance(block((1.6, 0.8, 1.0), YELLOW, "box"), placed(0, -0.01, 0))
    # the shadow map spans the ground: a small one keeps its texels small
    ground = Instance(block((12, 0.2, 12), Material((0.75, 0.75, 0.75)), "ground"), placed(0, -0.2, 0))
    sun = DirectionalLight((-0.35, -0.6, -1.0), (3.0, 2.8, 2.5))
    sky = Environment.constant((0.12, 0.14, 0.17))
    return Scene((ground, yellow), (sun,), sky, Camera(eye, (0, 0.25, 0.3), fov=22))


def _drawn(size: Size, degrees: float, module: Module, accumulate: int = 1) -> Frame:
    return shared_lab().render(_scene(degrees), module, size=size, accumulate=accumulate)


def _bounce(frame: Frame) -> float:
    """The mean radiance of the bounce on the patch of floor before the yellow side."""
    x, y, z = np.moveaxis(world_positions(frame), -1, 0)
    patch = frame.mask & (np.abs(x) < 0.5) & (np.abs(y) < 0.02) & (np.abs(z - 0.75) < 0.15)
    return float(frame["indirect"][patch].mean())
