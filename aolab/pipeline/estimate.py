"""Runs a module's passes: at its scale, over its sample sets, filtered, and brought to full size."""

from collections.abc import Mapping
from dataclasses import dataclass

from ..modules import Module
from ..modules.passes import Estimate
from ..scene.view import View
from . import filters
from .occluders import Occluders
from .pass_runner import Buffers, Painter


@dataclass(frozen=True)
class Run:
    """What all estimates of one frame share.

    `inputs` are textures beside the surfaces; `seeds` are averaged over; `small` is the G-buffer at the module's scale.
    """

    painter: Painter
    module: Module
    occluders: Occluders
    inputs: Buffers
    view: View
    seeds: range
    small: Buffers


def estimate(run: Run, what: Estimate, large: Buffers) -> Buffers:
    """The outputs of `what`, averaged, filtered, at full size; `NAME_raw` is each one before the filter."""
    painter, module = run.painter, run.module
    small, small_view = large, run.view
    if module.scale < 1:
        small_view = run.view.scaled(module.scale)
        small = {**large, **run.small}
    if len(run.seeds) == 1:
        formats = dict(what.outputs)
        raw = _passes(run, what, small, small_view, run.seeds[0])
    else:
        formats = {name: filters.single_precision(format) for name, format in what.outputs.items()}
        raw = _accumulated(run, what, formats, small, small_view)
    result = filters.apply(painter, module.filter, raw, formats, small, small_view)
    if module.scale < 1:
        result = filters.upsample(painter, result, formats, small, small_view, large, run.view)
    return {**{f"{name}_raw": texture for name, texture in raw.items()}, **result}


def _accumulated(run: Run, what: Estimate, formats: Mapping[str, str], surfaces: Buffers, view: View) -> Buffers:
    means = {name: run.painter.take(view.size, format) for name, format in formats.items()}
    for mean in means.values():  # one by one: together they may be more than a framebuffer takes
        run.painter.pool.framebuffer([mean]).clear()
    for seed in run.seeds:
        one = _passes(run, what, surfaces, view, seed)
        filters.accumulate(run.painter, one, means, len(run.seeds), view)
        run.painter.give_back(one)
    return means


def _passes(run: Run, what: Estimate, surfaces: Buffers, view: View, seed: int) -> Buffers:
    module = run.module
    constants = module.constants()
    uniforms = {**view.uniforms, **module.model_dump(), **run.occluders.uniforms, **module.samples(seed)}
    inputs = {**surfaces, **run.occluders.inputs, **run.inputs}
    aliases = {"occluders.glsl": f"occluders/{run.occluders.kind}.glsl"}
    made: Buffers = {}
    for step in what.passes:
        made |= run.painter.run(step, {**inputs, **made}, uniforms, view.size, constants, aliases)
    return {name: made[name] for name in what.outputs}
