"""The twin of each shader that takes samples. This table is all the registry there is."""

from collections.abc import Callable
from dataclasses import dataclass

from ...modules import Module
from ...modules.estimate import Estimate
from ...modules.marched import Marched
from ...modules.passes import Pass
from .ambient_transfer import ambient_transfer
from .bounces import near_field, s3ho_senders, ssdo_bounce
from .hao import hao
from .inputs import Inputs
from .lamps import fill, ssdo_lights
from .marched import s3ho, ssao, ssbn, ssdo, visibility
from .receiver import Texel
from .rotated_ssao import rotated_ssao
from .rsm import rsm, rsm_complete
from .samples import Samples
from .virtual_lights import virtual_lights

Twin = Callable[[Inputs, Texel, int], Samples | None]  # of a texel and a seed; None for a texel without samples

TWINS: dict[str, Twin] = {
    "ssao.frag": ssao,
    "ssdo.frag": ssdo,
    "ssdo.bounce.frag": ssdo_bounce,
    "ssbn.frag": ssbn,
    "s3ho.moments.frag": s3ho,
    "s3ho.frag": s3ho,
    "s3ho.senders.frag": s3ho_senders,
    "near_field.frag": near_field,
    "ssdo.lights.frag": ssdo_lights,
    "pipeline/fill.frag": fill,
    "rotated_ssao.frag": rotated_ssao,
    "hao.frag": hao,
    "ambient_transfer.frag": ambient_transfer,
    "rsm.gather.frag": rsm,
    "rsm.complete.frag": rsm_complete,
    "virtual_lights.frag": virtual_lights,
}


@dataclass(frozen=True)
class Taking:
    """A pass that takes samples, and its `twin`. Its `estimate` is None for a lighting pass without a filter.

    `bounces`: the pass runs over lit surfaces, where occluders send light.
    """

    step: Pass
    twin: Twin
    estimate: Estimate | None
    bounces: bool


def taking(module: Module) -> list[Taking]:
    """The passes of a module whose samples have a twin, in the order of the frame."""
    found, bounce = [], module.bounce()
    for one in [module.estimate(), *module.lighting(), *([bounce] if bounce else [])]:
        estimate = one if isinstance(one, Estimate) else None
        for step in estimate.passes if estimate else [one]:
            if isinstance(step, Pass) and (twin := _twin_of(module, step)):
                found.append(Taking(step, twin, estimate, one is bounce))
    return found


def _twin_of(module: Module, step: Pass) -> Twin | None:
    """None for a pass that takes no samples, or whose samples are not computed again.

    A module of your own that marches directions and has the output `visibility` needs no twin of its own.
    """
    own = visibility if isinstance(module, Marched) and "visibility" in step.outputs else None
    return TWINS.get(str(step.shader), own)
