"""Runs the passes between an estimate and the lighting: accumulation, noise removal, upsampling.

A pass treats up to four buffers alike, and reads the geometry once for all of them (glsl/lib/sources.glsl).
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

import moderngl

from ..gl import context
from ..gl.bindings import Bindings
from ..gl.texture import FORMATS
from ..modules.filters import Filter
from ..modules.filters.base import MOST_SOURCES, over_sources
from ..scene.view import View, ray_scale_offset
from .pass_runner import Buffers, PassRunner, Where

Formats = Mapping[str, str]


def apply(
    runner: PassRunner,
    filter: Filter,
    estimate: Buffers,
    formats: Formats,
    small: tuple[Buffers, View],
    large: tuple[Buffers, View],
    where: Where | None = None,
    background: Mapping[str, float] = MappingProxyType({}),
) -> Buffers:
    """Each buffer of the estimate, filtered and at full size; `small` and `large` are surfaces with their view.

    `where` are the pixels with surfaces; `background` has the values of buffers of the estimate elsewhere.
    """
    result: Buffers = {}
    upsampled = small[1].size != large[1].size
    for names in _groups(estimate):
        some, textures = {name: formats[name] for name in names}, {name: estimate[name] for name in names}
        if filter.at_full_size:
            if upsampled:
                textures = _upsample(runner, filter, textures, some, small, large)
            result |= _passes(runner, filter, textures, some, large)
        else:
            there = where if background.keys() >= some.keys() else None
            textures = _passes(runner, filter, textures, some, small, there, background)
            result |= _upsample(runner, filter, textures, some, small, large) if upsampled else textures
    return result


def _passes(
    runner: PassRunner,
    filter: Filter,
    textures: Buffers,
    formats: Formats,
    surfaces: tuple[Buffers, View],
    where: Where | None = None,
    background: Mapping[str, float] = MappingProxyType({}),
) -> Buffers:
    """The filter's passes, each over the result of the one before it; `where`, if the filter keeps the background."""
    where = where if filter.keeps_background else None
    given = textures
    for step in filter.passes(formats):
        step = replace(step, background={name: background[name] for name in formats}) if where else step
        made = runner.run(step, [*_common(filter, *surfaces), _sources(textures)], surfaces[1].size, where=where)
        if textures is not given:
            runner.give_back(textures)
        textures = made
    return textures


def _upsample(
    runner: PassRunner,
    filter: Filter,
    textures: Buffers,
    formats: Formats,
    small: tuple[Buffers, View],
    large: tuple[Buffers, View],
) -> Buffers:
    """The buffers at the size of `large`."""
    surfaces, view = small
    there = Bindings(
        "the small view",
        {"smallViewZ": surfaces["viewZ"], "smallNormal": surfaces["viewNormal"]},
        {"small_ray_from_pixel": ray_scale_offset(view.camera, view.size)},
    )
    step = over_sources("upsample", filter.upsampling, formats)
    return runner.run(step, [*_common(filter, *large), there, _sources(textures)], large[1].size)


def _common(filter: Filter, surfaces: Buffers, view: View) -> list[Bindings]:
    numbers = filter.numbers()
    return [
        Bindings("the surfaces", surfaces),
        Bindings("the view", uniforms=view.uniforms, constants=view.constants),
        Bindings(filter.label(), uniforms=numbers, constants=numbers),
    ]


def accumulate(runner: PassRunner, estimate: Buffers, means: Buffers, formats: Formats, frames: int) -> None:
    """Add one of `frames` estimates, at its share, to the running means (`formats`, single precision)."""
    gl = context.get()
    gl.enable_only(moderngl.BLEND)
    gl.blend_func = moderngl.ONE, moderngl.ONE
    share = Bindings("the mean", uniforms={"share": 1.0 / frames})
    for names in _groups(estimate):
        step = over_sources("accumulate", "pipeline/share.frag", {name: formats[name] for name in names})
        targets = {name: means[name] for name in names}
        sources = _sources({name: estimate[name] for name in names})
        runner.run(step, [share, sources], means[names[0]].size, targets=targets)
    gl.enable_only(moderngl.NOTHING)


def single_precision(format: str) -> str:
    """The float32 format with the same channels, for sums over many frames."""
    return {1: "R32F", 2: "RG32F", 4: "RGBA32F"}[FORMATS[format][0]]


def _groups(estimate: Buffers) -> Iterator[list[str]]:
    """The names, as many at a time as one pass treats."""
    names = list(estimate)
    for start in range(0, len(names), MOST_SOURCES):
        yield names[start : start + MOST_SOURCES]


def _sources(textures: Buffers) -> Bindings:
    """The textures under the names that filters read them by."""
    return Bindings("the sources", {f"source{number}": texture for number, texture in enumerate(textures.values())})
