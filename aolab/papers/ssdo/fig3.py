"""SSDO, figure 3: coloured shadows, and a bounce of yellow light."""

import numpy as np

from ...gl.texture import Size
from ...modules import Module, Unoccluded
from ...pipeline.frame import Frame
from ...scene.environment import averaged
from ...scene.scene import Scene
from ...truth import reference
from ..closeups import closeup, overview, zoomed
from ..figure import Figure, Need, figure
from ..pixels import chromaticity, world_positions
from .stage import BOUNCE, DIRECTIONAL, OCCLUSION, PRINTED, drawn, floor, stage

CLOSEUPS = ((0.25, 0.72), (0.72, 0.72))  # x, y in the picture: the outer feet of the pale box and of the yellow one
MODULES: dict[str, Module] = {
    "none": Unoccluded(),
    "SSAO": OCCLUSION,
    "SSDO": DIRECTIONAL,
    "SSDO + 1 bounce": BOUNCE,
    "as printed": PRINTED,
}
SIDES = {"open to the left": -1, "open to the right": 1}  # of x
BOXES = {"at the pale box": -1, "at the yellow box": 1}
Numbers = dict[str, dict[str, float]]


def fig3(size: Size = (320, 180), rays: int = 64) -> Figure:
    """None, SSAO, SSDO, SSDO with one bounce, the same as printed, and rays of the same radius; with close-ups.

    Numbers: the turn of a shadow's colour, from 0, the colour of the open floor, to 1, that of the open side's light;
    the light that the boxes bounce onto the floor, as a multiple of the rays', and its ratio of blue to red.
    """
    scene, large = stage(), zoomed(size)
    frames = {name: drawn(scene, module, large) for name, module in MODULES.items()}
    buffers = ("visibility", "ambient", "bent_normal", "indirect", "image")
    frames["rays"] = reference(scene, size=large, like=BOUNCE, rays=rays, buffers=buffers)
    turns, bounces = _turns(frames, scene), _bounces(frames)
    claim = (
        "SSDO's shadows have the colour of the light from the open side, SSAO's are grey; the yellow box bounces yellow"
    )
    pictures = [(name, overview(frame.image)) for name, frame in frames.items()]
    for middle in CLOSEUPS:
        pictures += [(f"{name}, close", closeup(frame.image, middle)) for name, frame in frames.items()]
    numbers = {"turn_to_the_open_sides_colour": turns, "bounce_onto_the_floor": bounces, "rays": rays}
    return figure("SSDO, Fig. 3", claim, _needs(turns, bounces), numbers, pictures, len(frames))


def _needs(turns: Numbers, bounces: dict[str, Numbers]) -> list[Need]:
    needs = [Need("SSAO's largest turn", float(np.abs([*turns["SSAO"].values()]).max()), below=0.02)]
    for side, right in turns["rays"].items():
        needs.append(Need(f"SSDO's turn over rays', {side}", turns["SSDO"][side] / right, 0.85, 1.15))
        needs.append(Need(f"the turn as printed over rays', {side}", turns["as printed"][side] / right, 0.35, 1.15))
    for box in BOXES:
        ours, printed = bounces["SSDO + 1 bounce"][box], bounces["as printed"][box]
        needs.append(Need(f"the bounce over rays', {box}", ours["over_rays"], 0.8, 1.2))
        needs.append(Need(f"the bounce as printed over rays', {box}", printed["over_rays"], 0.35, 1.5))
    for name in ("SSDO + 1 bounce", "as printed"):
        yellow, pale = (bounces[name][box]["blue_over_red"] for box in ("at the yellow box", "at the pale box"))
        needs.append(Need(f"blue over red of the bounce, yellow box over pale, {name}", yellow / pale, below=0.3))
    return needs


def _turns(frames: dict[str, Frame], scene: Scene) -> Numbers:
    """The turn of each frame's `ambient` on the floor, in shadows that are open to one side."""
    truth = frames["rays"]
    shaded = floor(truth) & (np.abs(truth["visibility"] - 0.65) < 0.25)
    across = truth["bent_normal"][..., 0]
    return {
        name: {side: _turn(frame, shaded & (x * across > 0.2), scene, x) for side, x in SIDES.items()}
        for name, frame in frames.items()
    }


def _turn(frame: Frame, where: np.ndarray, scene: Scene, side: int) -> float:
    """The ambient light's colour `where`: 0 is the whole environment's on a floor, 1 its half's on this `side`."""
    assert scene.environment is not None  # Scene fills it in
    radiance, directions, solid_angles = averaged(scene.environment.radiance)
    arriving = radiance * (np.maximum(directions[..., 1], 0) * solid_angles)[..., None]
    whole = chromaticity(arriving.sum(axis=(0, 1)))
    half = chromaticity(arriving[side * directions[..., 0] > 0].sum(axis=0))
    away = chromaticity(frame["ambient"][where].sum(axis=0)) - whole
    return float(away @ (half - whole) / ((half - whole) @ (half - whole)))


def _bounces(frames: dict[str, Frame]) -> dict[str, Numbers]:
    """The light that each box bounces onto the floor next to it."""
    truth = frames["rays"]
    across, below = world_positions(truth)[..., 0], floor(truth)
    found: dict[str, Numbers] = {}
    for name in ("SSDO + 1 bounce", "as printed", "rays"):
        found[name] = {}
        for box, x in BOXES.items():
            rgb, right = (frame["indirect"][below & (x * across > 0.5)].sum(axis=0) for frame in (frames[name], truth))
            found[name][box] = {"over_rays": float(rgb.sum() / right.sum()), "blue_over_red": float(rgb[2] / rgb[0])}
    return found
