"""Runs the passes between an estimate and the lighting: accumulation, noise removal, upsampling.

A pass treats up to four buffers alike, and reads the geometry once for all of them (glsl/lib/sources.glsl).
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from types import MappingProxyType

import moderngl

from ..gl import context
from ..gl.bindings import Bindings
from ..gl.texture import FORMATS
from ..modules.filters import Filter
from ..modules.filters.base import MOST_SOURCES, over_sources, titled
from ..scene.view import View, ray_scale_offset
from .differing import differing
from .pass_runner import Buffers, PassRunner
from .surfaces import as_bindings
from .tiles import Tiles

Formats = Mapping[str, str]

# in pixels of the small picture: the four nearest (upsample.frag)
UPSAMPLING_REACH = 1


def apply(
    runner: PassRunner,
    filter: Filter,
    estimate: Buffers,
    formats: Formats,
    small: tuple[Buffers, View],
    large: tuple[Buffers, View],
    background: Mapping[str, float] = MappingProxyType({}),
    decides: str = "",
) -> Buffers:
    """Each buffer of the estimate, filtered and at full size; `small` and `large` are surfaces with their view.

    On a software renderer, buffers with values in `background` are filtered, and brought to full size, where the buffer
    `decides` has another value within reach. Elsewhere they all have these values, so that their means are known.
    """
    upsampled = small[1].size != large[1].size
    reach = filter.reach() if decides in background and runner.timer.software else None
    filtered = grown = None
    if reach is not None:
        # the time of the search is the filter's
        name = titled("filter", next(names for names in _groups(estimate) if decides in names))
        find = partial(differing, runner, name, estimate[decides], formats[decides], background[decides], small[1])
        if not (upsampled and filter.at_full_size):
            filtered = find(small[1], reach)
        if upsampled and filter.upsampling == Filter.upsampling:
            grown = find(large[1], UPSAMPLING_REACH + (0 if filter.at_full_size else reach))
    result: Buffers = {}
    for names in _groups(estimate):
        some, textures = {name: formats[name] for name in names}, {name: estimate[name] for name in names}
        even = {name: background[name] for name in names if name in background}
        where, where_grown = (filtered, grown) if even.keys() == some.keys() else (None, None)
        if upsampled and filter.at_full_size:
            textures = _upsample(runner, filter, textures, some, small, large, where_grown, even)
        textures = _passes(runner, filter, textures, some, large if filter.at_full_size else small, where)
        if upsampled and not filter.at_full_size:
            textures = _upsample(runner, filter, textures, some, small, large, where_grown, even)
        result |= textures
    for tiles in (filtered, grown):
        if tiles:
            runner.give_back({"tiles": tiles.texture})
    return result


def _passes(
    runner: PassRunner,
    filter: Filter,
    textures: Buffers,
    formats: Formats,
    surfaces: tuple[Buffers, View],
    tiles: Tiles | None = None,
) -> Buffers:
    """The filter's passes, each over the result of the one before it, over `tiles`; elsewhere all values are equal."""
    given = textures
    for step in filter.passes(formats):
        bindings = [*_common(filter, *surfaces), _sources(textures)]
        made = runner.run(step, bindings, surfaces[1].size, where=tiles, elsewhere=textures)
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
    tiles: Tiles | None,
    background: Mapping[str, float],
) -> Buffers:
    """The buffers at the size of `large`, drawn over `tiles`; elsewhere they have the values of their `background`."""
    surfaces, view = small
    there = Bindings(
        "the small view",
        {"smallViewZ": surfaces["viewZ"], "smallNormal": surfaces["viewNormal"]},
        {"small_ray_from_pixel": ray_scale_offset(view.camera, view.size)},
    )
    step = replace(over_sources("upsample", filter.upsampling, formats), background=background)
    return runner.run(step, [*_common(filter, *large), there, _sources(textures)], large[1].size, where=tiles)


def _common(filter: Filter, surfaces: Buffers, view: View) -> list[Bindings]:
    numbers = filter.numbers()
    return [
        as_bindings(surfaces),
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
