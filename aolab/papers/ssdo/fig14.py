"""SSDO, figure 14: shadows and bounces of growing radii."""

from collections.abc import Callable
from itertools import pairwise

from ...gl.texture import Size
from ...modules import Module
from ...pipeline.frame import Frame
from ...truth import reference
from ..figure import Figure, Need, figure
from .stage import BOUNCE, PRINTED, drawn, stage

RADII = (0.25, 0.5, 1.0, 2.0)  # scene units
MODULES: dict[str, Module] = {"SSDO": BOUNCE, "as printed": PRINTED}
BOUNDS = {"SSDO": (0.8, 1.25), "as printed": (0.3, 1.25)}  # of occlusion and bounce, as multiples of the rays'
SHADED, BRIGHT = 0.95, 0.02  # visibility of a shadow; radiance of a bounce, as a share of the picture's mean


def fig14(size: Size = (320, 180), rays: int = 128) -> Figure:
    """SSDO with one bounce for growing radii, the same as printed, and rays of the same radii.

    Numbers: the shares of the surfaces that shadows and bounces reach; the mean occlusion and the mean bounce.
    """
    scene = stage()
    frames = {name: [drawn(scene, at(module, radius), size) for radius in RADII] for name, module in MODULES.items()}
    buffers = ("visibility", "indirect", "radiance", "image")
    frames["rays"] = [
        reference(scene, size=size, like=at(BOUNCE, radius), rays=rays, buffers=buffers) for radius in RADII
    ]
    found = {
        name: {what: [measure(f) for f in some] for what, measure in MEASURES.items()} for name, some in frames.items()
    }
    needs = []
    for name, (least, most) in BOUNDS.items():
        for what in ("reach of shadows", "reach of bounces"):
            growth = min(after / before for before, after in pairwise(found[name][what]))
            needs.append(Need(f"the {what} over that of the next smaller radius, the least, {name}", growth, above=1.2))
        for what in ("mean occlusion", "mean bounce"):
            over = [ours / right for ours, right in zip(found[name][what], found["rays"][what], strict=True)]
            needs.append(Need(f"the {what} over rays', the least, {name}", min(over), above=least))
            needs.append(Need(f"the {what} over rays', the most, {name}", max(over), below=most))
    claim = "A smaller radius shrinks the shadows and the reach of the bounce"
    pictures = []
    for name, some in frames.items():
        for index, radius in enumerate(RADII):
            shadows, bounces = (found[name][what][index] for what in ("reach of shadows", "reach of bounces"))
            caption = f"{name}, radius {radius:g}: shadows on {shadows:.0%}, bounces on {bounces:.0%}"
            pictures.append((caption, some[index].image))
    numbers = {"radius": list(RADII), **found, "rays": rays}
    return figure("SSDO, Fig. 14", claim, needs, numbers, pictures, len(RADII))


def at(module: Module, radius: float) -> Module:
    return module.replace(radius=radius)


def _reach_of_bounces(frame: Frame) -> float:
    level = BRIGHT * float(frame["radiance"][frame.mask].mean())
    return float((frame["indirect"][frame.mask].mean(axis=-1) > level).mean())


MEASURES: dict[str, Callable[[Frame], float]] = {
    "reach of shadows": lambda frame: float((frame["visibility"][frame.mask] < SHADED).mean()),
    "reach of bounces": _reach_of_bounces,
    "mean occlusion": lambda frame: float(1 - frame["visibility"][frame.mask].mean()),
    "mean bounce": lambda frame: float(frame["indirect"][frame.mask].mean()),
}
