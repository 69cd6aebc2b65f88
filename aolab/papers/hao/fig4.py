"""HAO, figure 4: the spread of the rays."""

from itertools import pairwise

from ...gl.texture import Size
from ...loading import load
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ...truth import reference
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .settings import TABLE_1, occlusion

SPREADS = (0.25, 0.5, 0.75)  # as printed
RADIUS = 1.0  # scene units


def fig4(size: Size = (320, 180), rays: int = 128) -> Figure:
    """Boxes for three spreads, and rays in the same cones.

    Numbers, by spread: the mean occlusion over the rays', the RMSE, and the share of the surface that is darkened.
    """
    scene, lab = load("boxes"), shared_lab()
    over, error, reach, pictures = [], [], [], []
    for spread in SPREADS:
        module = TABLE_1.replace(spread=spread, radius=RADIUS)
        frame = lab.render(scene, module, size=size, accumulate=4)
        truth = reference(scene, size=size, like=module, rays=rays, buffers=("visibility",))
        over.append(float(occlusion(frame).sum() / occlusion(truth).sum()))
        error.append(rmse(frame["visibility"], truth["visibility"], frame.mask & truth.mask))
        reach.append(float((occlusion(frame)[frame.mask] > 0.02).mean()))
        pictures += [(f"spread {spread:g}", gray(frame["visibility"])), ("rays", gray(truth["visibility"]))]
    needs = [
        Need("the mean occlusion over rays', the least", min(over), above=0.8),
        Need("the mean occlusion over rays', the most", max(over), below=1.5),
        Need("the RMSE against rays, the most", max(error), below=0.06),
        Need(
            "the darkened share of the surface over that of the next narrower spread, the least",
            min(wide / max(narrow, 1e-9) for narrow, wide in pairwise(reach)),
            above=1.05,
        ),
    ]
    claim = "A wider spread darkens more of the surface, as rays in the same cone do"
    numbers = {"spread": list(SPREADS), "occlusion_over_rays": over, "rmse": error, "darkened": reach, "rays": rays}
    return figure("HAO, Fig. 4", claim, needs, numbers, pictures[0::2] + pictures[1::2], 3)
