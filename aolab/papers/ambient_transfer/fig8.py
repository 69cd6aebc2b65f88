"""Ambient transfer, figure 8: a large scene under the environment alone, its transfer, and both."""

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules.ambient_transfer import AmbientTransfer
from ...pipeline.api import shared_lab
from ...scene.scene import Scene
from ...truth import reference
from ..figure import Figure, Need, figure
from ..pixels import rmse

MODULE = AmbientTransfer(radius=1.0, directions=16, steps=2, measure="classical")  # "two samples for each ray"
PRINTED = {"constant shading, fps": 180, "with transfer, fps": 100, "polygons": 415_000}  # NV8800, 800×600


def fig8(size: Size = (320, 180), rays: int = 256) -> Figure:
    """Skyscrapers under their sky, without occlusion, the transfer W by itself, and the light modulated with W.

    Numbers: the root mean square error of the obscurance O and of W against paths of many bounces within the radius,
    and the means; of aolab's classical measure, for which paths have a meaning.
    """
    scene, lab = _by_daylight(), shared_lab()
    plain = lab.render(scene, "none", size=size)
    frame = lab.render(scene, MODULE, size=size)
    buffers = ("obscurance", "transfer", "transfer_multibounce")
    truth = reference(scene, like=frame, bounces=12, rays=rays, buffers=buffers)
    paths, mask = truth["transfer_multibounce"], frame.mask
    open, traced = (np.repeat(one["obscurance"][..., None], 3, axis=-1) for one in (frame, truth))
    results = {"O": open, "W": frame["transfer"], "O by rays": traced, "W by rays": truth["transfer"]}
    errors = {name: rmse(values, paths, mask) for name, values in results.items()}
    means = {name: float(values[mask].mean()) for name, values in {**results, "paths": paths}.items()}
    needs = (
        Need("the error of W over that of O", errors["W"] / errors["O"], below=0.9),
        Need("the error of W over that of O, both by rays", errors["W by rays"] / errors["O by rays"], below=0.5),
        Need(
            "the light that O lacks over the light that W lacks",
            (1 - means["O"]) / max(1 - means["W"], 1e-9),
            above=1.3,
        ),
        Need(
            "the light that W lacks over the light that paths lack", (1 - means["W"]) / (1 - means["paths"]), 0.6, 1.4
        ),
    )
    numbers = {
        "rmse against paths": errors,
        "mean": means,
        "triangles": scene.triangles,
        "ms": {"transfer": frame.timings, "none": plain.timings},
        "printed": PRINTED,
    }
    pictures = [
        ("environment only", plain.image),
        (f"W, mean {means['W']:.3f}", _shown(frame["transfer"])),
        ("modulated with W", frame.image),
        (f"O, mean {means['O']:.3f}", _shown(open)),
        (f"paths, mean {means['paths']:.3f}", _shown(paths)),
    ]
    claim = "W lights creases by the reflections of their surroundings, and so is nearer to multiple scattering than O"
    return figure("Ambient transfer, Fig. 8", claim, needs, numbers, pictures, 3)


def _by_daylight() -> Scene:
    return load("skyscrapers").replace(lights=())


def _shown(values: np.ndarray) -> np.ndarray:
    return (255 * values.clip(0, 1)).astype(np.uint8)
