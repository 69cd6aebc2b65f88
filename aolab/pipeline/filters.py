"""What happens to an estimate before it lights anything: accumulation, noise removal, upsampling.

A pass treats up to four buffers alike, and asks the geometry once for all of them (glsl/lib/sources.glsl).
"""

from collections.abc import Iterator, Mapping

import moderngl

from ..gl import context
from ..gl.texture import FORMATS
from ..modules.passes import Pass
from ..scene.view import View, ray_scale_offset
from .pass_runner import Buffers, Painter

GROUP = 4  # textures a pass: with those of the geometry, well below the 16 that OpenGL 3.3 lets a shader read


def apply(
    painter: Painter, filter: str, estimate: Buffers, formats: Mapping[str, str], surfaces: Buffers, view: View
) -> Buffers:
    """Each buffer of the estimate through the separable filter `filter` (none, box4, bilateral), rows then columns."""
    if filter == "none":
        return estimate
    shader, result = f"pipeline/{filter}.frag", {}
    for names, inputs in _groups(estimate):
        outputs = {name: formats[name] for name in names}
        rows, columns = (
            Pass(_title("filter", names), shader, outputs, {"sources": len(names), "vertical": vertical})
            for vertical in (False, True)
        )
        between = painter.run(rows, surfaces | inputs, view.uniforms, view.size)
        result |= painter.run(columns, surfaces | _sources(between), view.uniforms, view.size)
        painter.give_back(between)
    return result


def upsample(
    painter: Painter,
    estimate: Buffers,
    formats: Mapping[str, str],
    small: Buffers,
    small_view: View,
    large: Buffers,
    view: View,
) -> Buffers:
    """Each buffer of the estimate at the size of `view`, by joint bilateral upsampling."""
    uniforms = {**view.uniforms, "small_ray_from_pixel": ray_scale_offset(small_view.camera, small_view.size)}
    surfaces = {**large, "smallViewZ": small["viewZ"], "smallNormal": small["viewNormal"]}
    result = {}
    for names, inputs in _groups(estimate):
        outputs = {name: formats[name] for name in names}
        step = Pass(_title("upsample", names), "pipeline/upsample.frag", outputs, {"sources": len(names)})
        result |= painter.run(step, surfaces | inputs, uniforms, view.size)
    return result


def accumulate(painter: Painter, estimate: Buffers, means: Buffers, frames: int, view: View) -> None:
    """Add one of `frames` estimates, at its share, to the running means (single precision)."""
    gl = context.get()
    gl.enable_only(moderngl.BLEND)
    gl.blend_func = moderngl.ONE, moderngl.ONE
    for names, inputs in _groups(estimate):
        step = Pass("accumulate", "pipeline/share.frag", {}, {"sources": len(names)})
        targets = {name: means[name] for name in names}
        painter.run(step, inputs, {"share": 1.0 / frames}, view.size, targets=targets)
    gl.enable_only(moderngl.NOTHING)


def single_precision(format: str) -> str:
    """The float32 format with the same channels, for sums over many frames."""
    return {1: "R32F", 2: "RGBA32F", 4: "RGBA32F"}[FORMATS[format][0]]


def _groups(estimate: Buffers) -> Iterator[tuple[list[str], Buffers]]:
    """Names, and the same textures under the names that the shaders read them by."""
    names = list(estimate)
    for start in range(0, len(names), GROUP):
        group = names[start : start + GROUP]
        yield group, _sources({name: estimate[name] for name in group})


def _sources(textures: Buffers) -> Buffers:
    return {f"source{number}": texture for number, texture in enumerate(textures.values())}


def _title(what: str, names: list[str]) -> str:
    """As timings call it: 'filter visibility', 'filter occlusion0 to occlusion3'."""
    return f"{what} {names[0]}" + (f" to {names[-1]}" if len(names) > 1 else "")
