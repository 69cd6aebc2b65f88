"""SSDO, figure 10: an environment as virtual point lights, whose shadow maps' bias is filled."""

from ...gl.texture import Size
from ...loading import load
from ...modules import EnvironmentVPL
from ...pipeline.api import shared_lab
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .coins import contacts

LIGHTS, FILL = 256, 8  # the paper's
MAP = 64  # pixels a side; the paper's 512² are of one object, and here the maps span the whole table


def fig10(size: Size = (480, 270), rays: int = 256) -> Figure:
    """Coins and a marble under the sky alone.

    Numbers, as shares of the rays' mean: the RMSE of ambient light, and its excess on pixels of the table that touch a
    coin, where the contact shadows belong.
    """
    scene = load("coins")
    truth = reference(scene, size=size, rays=rays, buffers=("ambient",))
    touching = contacts(truth)
    mean = float(truth["ambient"][truth.mask].mean())
    error, excess, pictures = {}, {}, [("rays", shown(2 * truth["ambient"]))]
    for name, fill in {"shadow maps alone": 0, "filled": FILL}.items():
        module = EnvironmentVPL(environment_lights=LIGHTS, vpl_resolution=MAP, fill=fill)
        ambient = shared_lab().render(scene, module, size=size)["ambient"]
        error[name] = rmse(ambient, truth["ambient"], truth.mask) / mean
        excess[name] = float((ambient - truth["ambient"])[touching].mean()) / mean
        pictures.append((f"{name}: rmse {100 * error[name]:.1f} % of the mean", shown(2 * ambient)))
    needs = [
        Need("filled: rmse over that of the maps alone", error["filled"] / error["shadow maps alone"], below=0.75),
        Need("filled: rmse over the mean", error["filled"], below=0.08),
        Need("shadow maps alone: light too much at contacts", excess["shadow maps alone"], above=0.1),
        Need("filled: the same, over it", excess["filled"] / excess["shadow maps alone"], -0.4, 0.5),
    ]
    claim = (
        "With 256 lights for an environment, shadow maps lose the shadows of small details, and the fill restores them"
    )
    numbers = {"rmse_over_mean": error, "excess_at_contacts": excess, "lights": LIGHTS, "map": MAP, "rays": rays}
    return figure("SSDO, Fig. 10", claim, needs, numbers, pictures, 3)
