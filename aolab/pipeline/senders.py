"""The light that leaves surfaces before a bounce: those that the camera sees, and hidden ones."""

from collections.abc import Sequence
from dataclasses import replace

import moderngl

from ..gl.bindings import Bindings
from ..modules.buffers import LIT
from ..modules.occluders.base import Hidden
from ..modules.passes import AMBIENT, DIRECT, Pass
from .estimate import steps
from .lighting import Lights
from .pass_runner import Buffers
from .plan import Plan
from .state import FrameContext, SurfaceState
from .surfaces import as_bindings


def _sender(emits: bool) -> Pass:
    return Pass("sender", "pipeline/sender.frag", {"sender": LIT["sender"].format}, {"has_emission": emits})


def senders(state: SurfaceState, lit: Buffers, lights: Lights) -> tuple[Buffers, SurfaceState]:
    """`sender`, direct + ambient light + emission of the surfaces that the camera sees; and the state with the light
    of hidden surfaces bound.
    """
    frame, occluders = state.frame, state.occluders
    runner, view = frame.runner, frame.view
    once: Buffers = {}
    if occluders.hidden:
        known = [as_bindings(state.large), frame.parameters, *lights.seen_from(view)]
        once = steps(frame, frame.plan.estimate.once, known)
    given = Bindings("the passes before the samples", once)
    sent = {hidden.sender: _hidden_sender(frame, hidden, lights, given) for hidden in occluders.hidden}
    bound = replace(occluders.bindings, textures={**occluders.bindings.textures, **sent})
    emission = {"emission": state.large.get("emission", lit["ambient"])}
    known = [Bindings("the lighting", lit), Bindings("the surfaces", emission)]
    sender = runner.run(_sender("emission" in state.large), known, view.size)
    return sender, replace(state, occluders=replace(occluders, bindings=bound))


def _hidden_sender(frame: FrameContext, hidden: Hidden, lights: Lights, given: Bindings) -> moderngl.Texture:
    """The light that leaves hidden surfaces, in the regions of their views.

    The environment's part is that of the module's own estimate, of one sample set and without filter. Samples towards
    lights are left out. `given` are the textures that the estimate makes before its samples.
    """
    runner, size = frame.runner, hidden.views[0].sheet
    passes = _passes(frame.plan, "emission" in hidden.surfaces)
    surfaces = {"emission": hidden.surfaces["albedo"], **hidden.surfaces}  # samplers must be bound
    targets = [runner.targets(step, size) for step in passes]
    for view in hidden.views:
        known = [
            as_bindings(surfaces),
            Bindings("the view", uniforms=view.uniforms, constants=view.constants),
            hidden.occluders,
            given,
            frame.parameters,
            frame.samples(frame.seeds[0]),
            *lights.seen_from(view),
        ]
        made: Buffers = {}
        for step, outputs in zip(passes, targets, strict=True):
            before = Bindings("the passes before", made)
            made = made | runner.run(step, [*known, before], size, targets=outputs, region=view.region)
    sender = targets.pop()["sender"]
    for outputs in targets:
        runner.give_back(outputs)
    return sender


def _passes(plan: Plan, emits: bool) -> Sequence[Pass]:
    """The module's estimate, direct light, and the module's own ambient light; then the sum."""
    ambient = [step for step in plan.lighting if isinstance(step, Pass) and "ambient" in step.outputs]
    if "environment_vpl" in plan.module.parts:  # whose lights are added up for the camera's view alone
        ambient = [replace(AMBIENT, constants={"occluded": False})]
    return [*plan.estimate.passes, DIRECT, *ambient, _sender(emits)]
