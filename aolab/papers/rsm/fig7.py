"""RSM and SSAO, figures 7 and 8: the scene and its ambient occlusion."""

import numpy as np

from ...gl.texture import Size
from ...modules import MODULES, find
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ...truth import reference
from ..figure import Figure, Need, figure
from .stage import stage

MODULE = "rotated_ssao+rsm?radius=1"


def fig7(size: Size = (320, 240), rays: int = 128) -> Figure:
    """The room with the bounce shaded by the occlusion, and the occlusion alone, beside that of rays.

    Numbers: the correlation of the visibility with that of rays of the same radius, and the bias.
    """
    scene = stage()
    module = find(MODULE, MODULES)
    frame = shared_lab().render(scene, module, size=size)
    truth = reference(scene, size=size, rays=rays, like=frame, buffers=("visibility",))
    ours, exact = frame["visibility"][truth.mask], truth["visibility"][truth.mask]
    correlation = float(np.corrcoef(ours, exact)[0, 1])
    bias = float((ours - exact).mean())
    needs = [
        Need("correlation of the visibility with rays'", correlation, above=0.8),
        Need("mean visibility less that of rays", bias, -0.1, 0.1),
    ]
    pictures = [
        ("the scene", frame.image),
        ("ambient occlusion", gray(frame["visibility"])),
        ("ambient occlusion, by rays", gray(truth["visibility"])),
    ]
    claim = "The occlusion is that of corners and contacts"
    return figure(
        "RSM and SSAO, Fig. 7 and 8",
        claim,
        needs,
        {"correlation": correlation, "bias": bias, "rays": rays},
        pictures,
        3,
    )
