"""RSM and SSAO, figures 5 and 6: without and with indirect light."""

from ...gl.texture import Size
from ...modules import RSM
from ...pipeline.api import shared_lab
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .stage import stage

EXPOSURE = 3.0


def fig5(size: Size = (320, 240), rays: int = 256) -> Figure:
    """The room in the light of its lamp alone: direct light, with the bounce of the map, and by rays.

    Numbers: the RMSE of direct + indirect light against rays, as a share of the rays' mean.
    """
    scene = stage(daylight=0.0)
    truth = reference(scene, size=size, rays=rays, buffers=("direct", "indirect"))
    frame = shared_lab().render(scene, RSM(gather="full"), size=size)
    whole = truth["direct"] + truth["indirect"]
    mean = float(truth["indirect"][truth.mask].mean())
    without = rmse(truth["direct"], whole, truth.mask) / mean
    bounce = rmse(frame["indirect"], truth["indirect"], truth.mask) / mean
    energy = float(frame["indirect"][truth.mask].mean()) / mean
    needs = [
        Need("rmse with the bounce over that without", bounce / without, below=0.35),
        Need("the bounce over the rays'", energy, 0.85, 1.2),
    ]
    pictures = [
        ("without indirect light", shown(EXPOSURE * frame["direct"])),
        ("with indirect light", shown(EXPOSURE * (frame["direct"] + frame["indirect"]))),
        ("one bounce, by rays", shown(EXPOSURE * whole)),
    ]
    claim = "The reflective shadow map adds the light of one bounce"
    numbers = {"rmse_without": without, "rmse_with": bounce, "bounce_over_rays": energy, "rays": rays}
    return figure("RSM and SSAO, Fig. 5 and 6", claim, needs, numbers, pictures, 3)
