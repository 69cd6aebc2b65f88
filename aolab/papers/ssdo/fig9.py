"""SSDO, figure 9: shadows of small things without a bias, with the classic bias, and with its gap filled."""

from dataclasses import replace
from typing import Any

from ...gl.texture import Size
from ...loading import load
from ...pipeline.api import shared_lab
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .coins import contacts

# the paper's map has 1024² pixels for a scene of the picture's size; the sun's map here spans the whole table
MAP = 512
WAYS: dict[str, dict[str, Any]] = {
    "no bias": {"shadow_bias": "none"},
    "classic bias": {},
    "filled, one layer": {"fill": 16},
    "filled, peeled layers": {"fill": 8, "occluders": "layers"},
}


def fig9(size: Size = (480, 270)) -> Figure:
    """Coins and a marble under a low sun.

    Numbers: the RMSE of direct light against rays, as a share of its mean; and the share of the shadow that is there on
    pixels of the table that touch a coin and are in shadow.
    """
    scene = load("coins")
    truth = reference(scene, size=size, rays=2, buffers=("direct",))
    dark = contacts(truth) & (truth["direct"].max(axis=-1) == 0)
    mean = float(truth["direct"][truth.mask].mean())
    unshadowed = shared_lab().render(
        scene.replace(lights=tuple(replace(light, shadow=False) for light in scene.lights)), "none", size=size
    )["direct"]
    error, contact, pictures = {}, {}, [("rays", shown(truth["direct"]))]
    for name, way in WAYS.items():
        direct = shared_lab().render(scene, "none", size=size, shadow_resolution=MAP, **way)["direct"]
        error[name] = rmse(direct, truth["direct"], truth.mask) / mean
        contact[name] = 1 - float(direct[dark].sum() / unshadowed[dark].sum())
        pictures.append((f"{name}: rmse {100 * error[name]:.0f} % of the mean", shown(direct)))
    needs = [
        Need("no bias: rmse over the classic bias's", error["no bias"] / error["classic bias"], above=2),
        Need("classic bias: share of the contact shadow", contact["classic bias"], below=0.75),
    ]
    for name in list(WAYS)[2:]:
        needs += [
            Need(f"{name}: rmse over the classic bias's", error[name] / error["classic bias"], below=0.9),
            Need(f"{name}: share of the contact shadow", contact[name], above=0.85),
        ]
    claim = (
        "Without a bias surfaces shade themselves, the bias loses contact shadows, and samples on the screen fill them"
    )
    numbers = {"rmse_over_mean": error, "contact_shadow": contact, "map": MAP}
    return figure("SSDO, Fig. 9", claim, needs, numbers, pictures, 3)
