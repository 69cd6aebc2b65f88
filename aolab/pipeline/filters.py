"""Runs the passes between an estimate and the lighting: accumulation, noise removal, upsampling.

A pass treats up to four buffers alike, and reads the geometry once for all of them (glsl/lib/sources.glsl).
"""

from collections.abc import Iterator, Mapping
from types import MappingProxyType

import moderngl

from ..gl import context
from ..gl.bindings import Bindings
from ..gl.texture import FORMATS
from ..modules.filters import Filter
from ..modules.filters.base import MOST_SOURCES, over_sources, titled
from ..modules.passes import Pass
from ..scene.view import View, ray_scale_offset
from .pass_runner import Buffers, PassRunner
from .tiles import PIXELS, Tiles, grid

Formats = Mapping[str, str]


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

    On a software renderer, buffers with values in `background` are filtered where the buffer `decides` has another
    value within the filter's reach. Elsewhere they all have these values, so that their means are known.
    """
    result: Buffers = {}
    upsampled = small[1].size != large[1].size
    tiles = None
    if decides in background and runner.timer.software and not (upsampled and filter.at_full_size):
        tiles = _differing(runner, filter, decides, estimate, formats, background[decides])
    for names in _groups(estimate):
        some, textures = {name: formats[name] for name in names}, {name: estimate[name] for name in names}
        there = tiles if background.keys() >= some.keys() else None
        if filter.at_full_size:
            if upsampled:
                textures = _upsample(runner, filter, textures, some, small, large)
            result |= _passes(runner, filter, textures, some, large, there)
        else:
            textures = _passes(runner, filter, textures, some, small, there)
            result |= _upsample(runner, filter, textures, some, small, large) if upsampled else textures
    if tiles:
        runner.give_back({"tiles": tiles.texture})
    return result


def _differing(
    runner: PassRunner, filter: Filter, decides: str, estimate: Buffers, formats: Formats, value: float
) -> Tiles | None:
    """The tiles with a value other than `value` in the buffer `decides`, within the filter's reach; None without it."""
    reach = filter.reach()
    if reach is None:
        return None
    texture = estimate[decides]
    name = titled("filter", next(names for names in _groups(estimate) if decides in names))  # its time is the filter's
    constants = {"tile_pixels": PIXELS, "reach": reach, "single": FORMATS[formats[decides]][0] == 1}
    step = Pass(name, "pipeline/tiles.frag", {"tiles": "R8"}, constants)
    texel_size = 1 / texture.width, 1 / texture.height
    given = Bindings("the buffer", {"source": texture}, {"value": value, "source_texel_size": texel_size})
    return Tiles(runner.run(step, [given], grid(texture.size))["tiles"])


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
