"""The buffers that the passes of a frame read."""

from collections.abc import Iterable

from ..modules.buffers import REFLECTIVE
from ..modules.passes import Pass
from ..modules.virtual_lights import VirtualLights
from .reflective import PACKED
from .state import Asked, FrameContext


def sampled(frame: FrameContext, passes: Iterable[Pass]) -> frozenset[str]:
    """The buffers that these passes sample, those of the occluder kind included."""
    declared, names = frame.runner.programs.declared, set()
    for step in passes:
        read = declared(step.shader, step.includes)
        samplers = set(read.samplers)
        if "occluders.glsl" in read.includes:
            samplers.update(*(declared(text).samplers for text in frame.occluders.bindings().includes.values()))
        names |= {step.reads.get(name, name) for name in samplers}
    return frozenset(names)


def all_asked(frame: FrameContext) -> Asked:
    """All that the passes of the frame's module, and its occluder kind, read."""
    declared, passes = frame.runner.programs.declared, frame.module.all_passes()
    asks_for_occluders = any("occluders.glsl" in declared(step.shader, step.includes).includes for step in passes)
    lights = [step.samples for step in frame.module.lighting() if isinstance(step, VirtualLights)]
    names = sampled(frame, passes).union(*lights)
    return Asked(names, asks_for_occluders, bool(names & {*REFLECTIVE, PACKED}))
