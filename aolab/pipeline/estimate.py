"""Runs an estimate: at its scale, over its sample sets, filtered, and brought to full size."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ..errors import ParameterError
from ..gl.bindings import Bindings
from ..modules.estimate import Estimate
from ..modules.passes import GeometryPass, Pass
from ..scene.view import View
from . import filters
from .pass_runner import Buffers, Where
from .state import FrameContext, SurfaceState
from .surfaces import as_bindings, facing

MANY = 16  # accumulated frames that show their progress; the explorer's few are no long work


def estimate(state: SurfaceState, what: Estimate, given: Iterable[Bindings] = ()) -> Buffers:
    """The outputs of `what`, averaged, filtered, at full size; `NAME_raw` is each one before the filter.

    The passes may read the surfaces, the occluders, the module's numbers and samples, and all that is `given`.
    """
    frame, runner = state.frame, state.frame.runner
    given = list(given)
    if what.once:
        known = [as_bindings(facing(state.large, frame.module.normals)), frame.parameters, *given]
        given.append(Bindings("the passes before the samples", steps(frame, what.once, known)))
    if len(frame.seeds) == 1:
        formats = dict(what.outputs)
        raw = _passes(state, what, given, frame.seeds[0])
    else:
        formats = {name: filters.single_precision(format) for name, format in what.outputs.items()}
        raw = _accumulated(state, what, given, formats)
    # a filter compares distances to the tangent plane, which no map bends
    small, large = (facing(state.small, "geometric"), state.small_view), (facing(state.large, "geometric"), frame.view)
    background = {name: value for step in what.passes for name, value in step.background.items()}
    decides = what.decides or (next(iter(what.outputs)) if len(what.outputs) == 1 else "")
    result = filters.apply(runner, what.filter or frame.plan.filter, raw, formats, small, large, background, decides)
    return {**{f"{name}_raw": texture for name, texture in raw.items()}, **result}


def steps(
    frame: FrameContext,
    passes: Iterable[Pass],
    given: Sequence[Bindings],
    view: View | None = None,
    where: Where | None = None,
) -> Buffers:
    """The outputs of passes that run once each, in order: a pass may read those before it.

    Full-screen passes have the size of `view`, by default the frame's; those with a `background` are drawn `where`.
    """
    view, made, fillers = view or frame.view, {}, {}
    seen = Bindings("the view", uniforms=view.uniforms, constants=view.constants)
    for step in passes:
        for name in step.outputs:
            if name in fillers:
                raise ParameterError(
                    f"passes '{fillers[name]}' and '{step.name}' both fill '{name}'; rename one of them"
                )
            fillers[name] = step.name
        before = [*given, Bindings("the passes before", made)]
        if isinstance(step, GeometryPass):
            made = made | frame.rasterizer.draw(step, view, before)
        else:
            made = made | frame.runner.run(
                step, [seen, frame.last, *before], view.size, where=where if step.background else None
            )
    return made


def _accumulated(state: SurfaceState, what: Estimate, given: Sequence[Bindings], formats: Mapping[str, str]) -> Buffers:
    runner, seeds = state.frame.runner, state.frame.seeds
    means = {name: runner.take(state.small_view.size, format) for name, format in formats.items()}
    for mean in means.values():  # one by one: together they may be more than a framebuffer takes
        runner.pool.framebuffer([mean]).clear()
    with _bar(len(seeds)) as bar:
        for seed in seeds:
            one = _passes(state, what, given, seed)
            filters.accumulate(runner, one, means, formats, len(seeds))
            runner.give_back(one)
            bar.update()
    return means


def _bar(frames: int) -> Any:
    from ..progress import progress_bar  # a part of the start-up, which a single frame does not need

    return progress_bar("accumulate", frames, "frame", shown=None if frames >= MANY else False)


def _passes(state: SurfaceState, what: Estimate, given: Sequence[Bindings], seed: int) -> Buffers:
    frame = state.frame
    known = [
        as_bindings(facing(state.small, frame.module.normals)),
        state.occluders.bindings,
        frame.parameters,
        frame.samples(seed),
        *given,
    ]
    made = steps(frame, what.passes, known, state.small_view, state.small_where)
    outputs = {name: made.pop(name) for name in what.outputs}
    frame.runner.give_back(made)
    return outputs
