"""SSDO, figure 11: instant radiosity, whose shadow maps' bias is filled."""

from ...gl.texture import Size
from ...modules import InstantRadiosity
from ...pipeline.api import shared_lab
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .coins import contacts, under_a_card

LIGHTS, FILL, MAP = 64, 16, 128


def fig11(size: Size = (480, 270), rays: int = 256) -> Figure:
    """Coins in the dark beside a pale card in the light: all of their light is its bounce.

    Numbers, over the table's pixels that touch a coin, where the contact shadows belong, as shares of the rays' mean
    there: the RMSE of the bounce and its excess.
    """
    scene = under_a_card()
    truth = reference(scene, size=size, rays=rays, buffers=("indirect",))
    touching = contacts(truth)
    mean = float(truth["indirect"][touching].mean())
    error, excess, pictures = {}, {}, [("rays", shown(8 * truth["indirect"]))]
    for name, fill in {"shadow maps alone": 0, "filled": FILL}.items():
        module = InstantRadiosity(bounce_lights=LIGHTS, vpl_resolution=MAP, vpl_clamp=1.0, fill=fill)
        indirect = shared_lab().render(scene, module, size=size)["indirect"]
        error[name] = rmse(indirect, truth["indirect"], touching) / mean
        excess[name] = float((indirect - truth["indirect"])[touching].mean()) / mean
        pictures.append((f"{name}: rmse at contacts {100 * error[name]:.0f} % of the mean", shown(8 * indirect)))
    needs = [
        Need(
            "filled: rmse at contacts over that of the maps alone",
            error["filled"] / error["shadow maps alone"],
            below=0.8,
        ),
        Need("shadow maps alone: light too much at contacts", excess["shadow maps alone"], above=0.1),
        Need("filled: the same, over it", excess["filled"] / excess["shadow maps alone"], -0.5, 0.5),
    ]
    claim = "In instant radiosity, shadow maps lose the shadows of small details, and the fill restores them"
    numbers = {"rmse_at_contacts": error, "excess_at_contacts": excess, "lights": LIGHTS, "map": MAP, "rays": rays}
    return figure("SSDO, Fig. 11", claim, needs, numbers, pictures, 3)
