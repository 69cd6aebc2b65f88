"""S3HO, figure 7: a white room in a strong light probe, by rays, S3HO, SSDO and SSBN."""

import numpy as np

from ...gl.texture import Size
from ...modules import SSAO
from ...pipeline.api import shared_lab
from ..closeups import over_background
from ..figure import Figure, Need, figure
from ..pixels import noise
from .room import KINDS, RADIUS, colour_error, draws, in_shadow, methods, room, traced, variants

DIRECTIONS = 32


def fig7(size: Size = (400, 225), rays: int = 1024, seeds: int = 8) -> Figure:
    """The room by rays of the same radius (RTDO in the paper), and by the methods with 32 directions of two points.

    Numbers: the colour error in local shadows, of the mean over seeds; and the relative noise: unfiltered, unfiltered
    in shadows, and filtered. The colour errors are compared with SSAO's, whose shadows have the colours of the open
    surface.
    """
    truth = traced(size, rays)
    shaded = in_shadow(truth)
    others = variants(DIRECTIONS)
    ssao = SSAO(radius=RADIUS, directions=DIRECTIONS, steps=2)
    colours, noises = {}, {}
    for name, module in {"SSAO": ssao, **methods(DIRECTIONS), **others}.items():
        raw = draws(module.replace(filter="none"), size, seeds)
        colours[name] = colour_error(np.mean(raw, axis=0), truth["ambient"], shaded)
        noises[name] = {
            "raw": noise(raw, truth.mask),
            "raw_in_shadows": noise(raw, shaded),
            "filtered": noise(draws(module, size, seeds), truth.mask),
        }

    needs = []
    for kind, name in KINDS.items():
        for method in ("S3HO", "SSDO"):
            ratio = colours[method + name] / colours["SSAO"]
            needs.append(Need(f"{method}'s colour error in shadows over SSAO's, {kind}", ratio, below=0.6))
        ratio = noises[f"S3HO{name}"]["raw"] / noises[f"SSDO{name}"]["raw"]
        needs.append(Need(f"S3HO's noise over SSDO's, {kind}", ratio, below=0.5))
    alike = [noises[f"S3HO{name}"]["raw"] / noises[f"SSDO{name}, blurred alike"]["raw"] for name in ("", " as printed")]
    finding = (
        "Where S3HO and SSDO blur the light alike, S3HO's noise over SSDO's is "
        f"{alike[0]:.2f} with the blocked sum, and {alike[1]:.2f} as printed"
    )
    pictures = [(f"rays, {rays} a pixel", over_background(truth["ambient"], truth))]
    for name, module in {**methods(DIRECTIONS), "SSDO, blurred alike": others["SSDO, blurred alike"]}.items():
        caption = f"{name}: colours off by {colours[name]:.3f}, raw noise {noises[name]['raw']:.1%}"
        pictures.append((caption, shared_lab().render(room(), module, size=size).image))
    claim = "S3HO's and SSDO's shadows have the colours that rays find; S3HO's have less noise at equal samples"
    numbers = {"colour_error_in_shadows": colours, "noise": noises, "rays": rays}
    return figure("S3HO, Fig. 7", claim, needs, numbers, pictures, 4, finding)
