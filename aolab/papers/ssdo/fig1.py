"""SSDO, figure 1: a large scene, and the cost of SSDO's passes."""

import statistics
from functools import partial

from ...gl import context
from ...gl.texture import Size
from ...loading import load
from ...modules import SSAO, SSDO, Module, Unoccluded
from ...pipeline.api import shared_lab
from ...studies.machine import describe
from ..figure import Figure, Need, figure
from ..timing import REPEATS, in_turns

RADIUS = 0.6  # metres: reaches across the mouldings and the folds of the curtains
PAPER_TRIANGLES = 537_000
MODULES: dict[str, Module] = {
    "none": Unoccluded(),
    "SSAO": SSAO(radius=RADIUS, directions=16),
    "SSDO": SSDO(radius=RADIUS, directions=16),
    "SSDO + 1 bounce": SSDO(radius=RADIUS, directions=16, bounces=1),
}


def fig1(size: Size = (960, 540), repeats: int = REPEATS) -> Figure:
    """The largest scene without occlusion, with SSAO, with SSDO, and with one bounce.

    Numbers: the cost of the passes, and their cost in the same scene with fewer triangles. `detail` 1 and 4 of the
    atrium have the same shapes, so that the G-buffers are nearly the same.
    """
    large, small = load("atrium", detail=4), load("atrium", detail=1)
    lab = shared_lab()
    draw = partial(lab.render, module=MODULES["SSDO + 1 bounce"], size=size)
    costs = in_turns({"large": partial(draw, large), "small": partial(draw, small)}, repeats)
    medians = {name: statistics.median(cost.of("ssdo") for cost in costs[name]) for name in costs}
    numbers = {
        "triangles": large.triangles,
        "paper_triangles": PAPER_TRIANGLES,
        "fewer_triangles": small.triangles,
        "milliseconds": {
            "passes": medians["large"],
            "passes_with_fewer_triangles": medians["small"],
            "frame": statistics.median(cost.frame for cost in costs["large"]),
        },
        "renderer": context.renderer(),
        "machine": describe(),
    }
    claim = (
        f"The method's own passes cost the same among {large.triangles:,} triangles (the paper: {PAPER_TRIANGLES:,}) "
        f"as among {small.triangles:,}"
    )
    pictures = [(name, lab.render(large, module, size=size).image) for name, module in MODULES.items()]
    heading = f"SSDO, Fig. 1, {context.renderer()}, {describe()}"
    return figure(heading, claim, claimed(medians["large"], medians["small"]), numbers, pictures, 2)


def claimed(large: float, small: float) -> tuple[Need, ...]:
    """The claim's needs, from the milliseconds of the passes in the two scenes."""
    return (Need("the cost of the passes among many triangles over that among few", large / small, below=1.25),)
