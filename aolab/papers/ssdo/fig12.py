"""SSDO, figure 12: the bounce that the clamp of instant radiosity takes away, restored in image space."""

import numpy as np

from ...gl.texture import Size
from ...modules import InstantRadiosity
from ...pipeline.api import shared_lab
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, Need, figure
from ..pixels import rmse, world_positions
from .coins import CARD_X, table, under_a_card

CLAMP = 2.0  # cm, and the radius of the bounce on the screen
WAYS = {"unclamped": (0.02, False), "clamped": (CLAMP, False), "with the near field": (CLAMP, True)}


def fig12(size: Size = (480, 270), rays: int = 256, lights: int = 256) -> Figure:
    """The foot of a pale card on a table, where the light of the card's lowest part is near.

    Numbers, over the table within 1 cm of the card: the share of the rays' bounce that is there, and the RMSE as a
    share of its mean.
    """
    scene = under_a_card()
    truth = reference(scene, size=size, rays=rays, buffers=("indirect",))
    x, _, z = np.moveaxis(world_positions(truth), -1, 0)
    foot = table(truth) & (x > CARD_X) & (x < CARD_X + 1) & (np.abs(z - 0.5) < 6)
    mean = float(truth["indirect"][foot].mean())
    light, error, pictures = {}, {}, [("rays", shown(8 * truth["indirect"]))]
    for name, (clamp, near) in WAYS.items():
        module = InstantRadiosity(
            bounce_lights=lights,
            vpl_clamp=clamp,
            near_field=near,
            radius=CLAMP,
            falloff=0,
            directions=32,
            steps=8,
            fill=8,
        )
        indirect = shared_lab().render(scene, module, size=size)["indirect"]
        light[name] = float(indirect[foot].mean()) / mean
        error[name] = rmse(indirect, truth["indirect"], foot) / mean
        caption = f"{name}: {100 * light[name]:.0f} % of the rays' light at the foot, rmse {100 * error[name]:.0f} %"
        pictures.append((caption, shown(8 * indirect)))
    lost, left = (1 - light[name] for name in ("clamped", "with the near field"))
    needs = [
        Need("light that the clamp takes away at the foot", lost, above=0.1),
        Need("with the near field: light that is missing, over it", left / lost, -0.5, 0.5),
        Need(
            "with the near field: rmse over that of the clamped",
            error["with the near field"] / error["clamped"],
            below=0.7,
        ),
    ]
    claim = "Clamped virtual lights lose energy near corners, and a bounce in image space restores it"
    numbers = {"light_over_rays": light, "rmse_over_mean": error, "clamp": CLAMP, "lights": lights, "rays": rays}
    return figure("SSDO, Fig. 12", claim, needs, numbers, pictures, 2)
