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

TOTAL = 105.0  # degrees of the camera's path, from before the yellow side to behind it
RADIUS = 0.8  # scene units, the height of the box
MODULES: dict[str, Module] = {"SSDO": BOUNCE.replace(radius=RADIUS), "as printed": PRINTED.replace(radius=RADIUS)}


def fig4(size: Size = (400, 225), frames: int = 43, rays: int = 128) -> Figure:
    """Four frames of a camera path around a box. Its yellow side lights the floor and turns out of the view.

    Numbers: the bounce on a patch of the floor in each frame, as a share of the first frame's; the first frame's
    bounce as a multiple of the rays'; and the fade, the angle in which the bounce falls from nine tenths to one tenth.
    """
    degrees = np.linspace(0, TOTAL, frames).tolist()
    paths = {name: [_bounce(_drawn(size, angle, module)) for angle in degrees] for name, module in MODULES.items()}
    chosen = np.linspace(0, frames - 1, 4).round().astype(int).tolist()
    truths = [
        reference(_scene(degrees[i]), size=size, like=MODULES["SSDO"], rays=rays, buffers=("indirect",)) for i in chosen
    ]
    right = _bounce(truths[0])
    bounce = {name: (np.array(path) / path[0]).tolist() for name, path in paths.items()}
    first = {name: path[0] / right for name, path in paths.items()}
    fade = {name: _fade(degrees, path) for name, path in bounce.items()}
    needs = []
    for name, (least, most) in {"SSDO": (0.8, 1.2), "as printed": (0.3, 1.5)}.items():
        needs += [
            Need(f"the first bounce over rays', {name}", first[name], least, most),
            Need(f"the last bounce over the first, {name}", bounce[name][-1], below=0.05),
            Need(f"the fade in degrees, {name}", fade[name], above=20),
        ]
    claim = "As its sender turns out of the view, the bounce fades out smoothly"
    finding = (
        "Marched directions find the sender until it is thinner than a pixel: "
        f"the bounce fades within {fade['SSDO']:.0f}° by default, and within {fade['as printed']:.0f}° as printed"
    )
    pictures = [
        (f"{degrees[i]:.0f}° around", _drawn(size, degrees[i], MODULES["SSDO"], ACCUMULATE).image) for i in chosen
    ]
    pictures += [(f"4 times the bounce, rays: {_bounce(t) / right:.2f}", shown(4 * t["indirect"])) for t in truths]
    for name, module in MODULES.items():
        for i in chosen:
            indirect = _drawn(size, degrees[i], module, ACCUMULATE)["indirect"]
            pictures.append((f"4 times the bounce, {name}: {bounce[name][i]:.2f}", shown(4 * indirect)))
    numbers = {"degrees": degrees, "bounce": bounce, "first_over_rays": first, "fade_in_degrees": fade, "rays": rays}
    return figure("SSDO, Fig. 4", claim, needs, numbers, pictures, 4, finding)


def _fade(degrees: list[float], bounce: list[float]) -> float:
    """The degrees between the last frame above nine tenths and the first one below a tenth, interpolated."""
    falling = np.minimum.accumulate(np.maximum.accumulate(bounce[::-1])[::-1])  # without noise that rises again
    begin, end = np.interp((-0.9, -0.1), -falling, degrees)
    return float(end - begin)


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
