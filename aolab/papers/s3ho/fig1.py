"""S3HO, figure 1: the effect of SSAO on a picture."""

import numpy as np

from ...gl.texture import Size
from ...modules import SSAO, Unoccluded
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...truth import reference
from ..figure import Figure, Need, figure
from .atrium import RADIUS, atrium


def fig1(size: Size = (480, 270), rays: int = 256) -> Figure:
    """Diffuse lighting alone, SSAO's occlusion factor, and both; and the factor by rays.

    Numbers: the mean occlusion as a multiple of the rays', and their correlation; the darkened share of the pixels with
    nothing near; the largest factor; and the largest differences between the three colours' factors, between factor and
    visibility, and between the factors before and after a half turn of the sky.
    """
    scene = atrium()
    assert scene.environment is not None  # Scene fills it in
    lab, module = shared_lab(), SSAO(radius=RADIUS, directions=32, steps=8)
    diffuse, both = (lab.render(scene, one, size=size) for one in (Unoccluded(), module))
    truth = reference(scene, size=size, like=module, rays=rays, buffers=("visibility",))
    turned = scene.environment.rotated(180)
    factor, other = (
        _factor(*pair) for pair in ((diffuse, both), (lab.relight(f, environment=turned) for f in (diffuse, both)))
    )
    visibility, right = (frame["visibility"][both.mask] for frame in (both, truth))
    numbers = {
        "mean_occlusion_over_rays": float((1 - visibility).mean() / (1 - right).mean()),
        "correlation_with_rays": float(np.corrcoef(visibility, right)[0, 1]),
        "darkened_with_nothing_near": float((factor.mean(axis=-1) < 0.995)[visibility > 0.999].mean()),
        "largest_factor": float(factor.max()),
        "difference_between_colours": float(np.ptp(factor, axis=-1).max()),
        "difference_from_the_visibility": float(np.abs(factor - visibility[:, None]).max()),
        "change_under_a_turned_sky": float(np.abs(other - factor).max()),
        "rays": rays,
    }
    needs = [
        Need("mean occlusion over rays'", numbers["mean_occlusion_over_rays"], 0.65, 1.25),
        Need("correlation of the visibility with rays'", numbers["correlation_with_rays"], above=0.7),
        Need("the share darkened with nothing near", numbers["darkened_with_nothing_near"], below=0.001),
        Need("the largest factor", numbers["largest_factor"], below=1.001),
        Need("the largest difference between colours", numbers["difference_between_colours"], below=0.01),
        Need("the largest difference from the visibility", numbers["difference_from_the_visibility"], below=0.01),
        Need("the largest change under a turned sky", numbers["change_under_a_turned_sky"], below=0.01),
    ]
    claim = "Occlusion as a factor only darkens, all colours alike, whatever the light: its shadows are grey and static"
    pictures = [
        ("diffuse", diffuse.image),
        ("both", both.image),
        ("occlusion factor, SSAO", gray(both["visibility"])),
        ("occlusion factor, rays", gray(truth["visibility"])),
    ]
    return figure("S3HO, Fig. 1", claim, needs, numbers, pictures, 2)


def _factor(diffuse: Frame, both: Frame) -> np.ndarray:
    """(n, 3): the factor of occlusion at each surface pixel."""
    return both["radiance"][both.mask] / np.maximum(diffuse["radiance"][both.mask], 1e-6)
