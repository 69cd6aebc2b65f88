"""SSDO, figure 14: shadows and bounces of growing radii."""

import numpy as np

from ...gl.texture import Size
from ...modules import Module
from ...pipeline.frame import Frame
from ...truth import reference
from ..figure import Figure, Need, figure
from .stage import BOUNCE, PRINTED, drawn, stage

RADII = (0.25, 0.5, 1.0, 2.0)  # scene units
MODULES: dict[str, Module] = {"SSDO": BOUNCE, "as printed": PRINTED}
SHADED, BRIGHT = 0.95, 0.02  # a shadow's visibility; a bounce's radiance, in the picture's mean


def fig14(size: Size = (400, 225), rays: int = 64) -> Figure:
    """SSDO with one bounce for growing radii, the same as printed, and rays of the same radii.

    Numbers: the shares of the surfaces that shadows and bounces reach, and both in those of rays.
    """
    scene = stage()
    frames = {
        name: [drawn(scene, module.replace(radius=radius), size) for radius in RADII]
        for name, module in MODULES.items()
    }
    buffers = ("visibility", "indirect", "radiance", "image")
    frames["rays"] = [
        reference(scene, size=size, like=BOUNCE.replace(radius=radius), rays=rays, buffers=buffers) for radius in RADII
    ]
    shares = {name: {what: [share(f) for f in some] for what, share in SHARES.items()} for name, some in frames.items()}
    needs, pictures = [], []
    for name, found in shares.items():
        for index, radius in enumerate(RADII):
            reached = ", ".join(f"{what} on {share[index]:.0%}" for what, share in found.items())
            pictures.append((f"{name}, radius {radius:g}: {reached}", frames[name][index].image))
    for name in MODULES:
        least, most = (0.8, 1.25) if name == "SSDO" else (0.3, 2.0)
        for what, share in shares[name].items():
            over = [ours / right for ours, right in zip(share, shares["rays"][what], strict=True)]
            needs += [
                Need(
                    f"the reach of {what} over the next smaller radius', the least, {name}",
                    float((np.array(share[1:]) / share[:-1]).min()),
                    above=1.2,
                ),
                Need(f"the reach of {what} over rays', the least, {name}", min(over), above=least),
                Need(f"the reach of {what} over rays', the most, {name}", max(over), below=most),
            ]
    claim = "A smaller radius shrinks the shadows and the reach of the bounce"
    return figure(
        "SSDO, Fig. 14", claim, needs, {"radius": list(RADII), "reach": shares, "rays": rays}, pictures, len(RADII)
    )


def _shadows(frame: Frame) -> float:
    return float((frame["visibility"][frame.mask] < SHADED).mean())


def _bounces(frame: Frame) -> float:
    level = BRIGHT * float(frame["radiance"][frame.mask].mean())
    return float((frame["indirect"][frame.mask].mean(axis=-1) > level).mean())


SHARES = {"shadows": _shadows, "bounces": _bounces}
