"""What happens to an estimate before it lights anything: accumulation, noise removal, upsampling."""

import moderngl

from .draw import Buffers, Painter
from .gl import context
from .gl.texture import FORMATS
from .passes import Pass
from .view import View, ray_scale_offset


def apply(
    painter: Painter, filter: str, estimate: Buffers, formats: dict[str, str], surfaces: Buffers, view: View
) -> Buffers:
    """Each buffer of the estimate through the separable filter `filter` (none, box4, bilateral), rows then columns."""
    if filter == "none":
        return estimate
    result = {}
    for name, texture in estimate.items():
        for vertical in (False, True):
            step = Pass(f"filter {name}", f"pipeline/{filter}.frag", {name: formats[name]}, {"vertical": vertical})
            texture = painter.run(step, {**surfaces, "source": texture}, view.uniforms, view.size)[name]
        result[name] = texture
    return result


def upsample(
    painter: Painter,
    estimate: Buffers,
    formats: dict[str, str],
    small: Buffers,
    small_view: View,
    large: Buffers,
    view: View,
) -> Buffers:
    """Each buffer of the estimate at the size of `view`, by joint bilateral upsampling."""
    uniforms = {**view.uniforms, "small_ray_from_pixel": ray_scale_offset(small_view.camera, small_view.size)}
    inputs = {**large, "smallViewZ": small["viewZ"], "smallNormal": small["viewNormal"]}
    result = {}
    for name, texture in estimate.items():
        step = Pass(f"upsample {name}", "pipeline/upsample.frag", {name: formats[name]})
        result |= painter.run(step, {**inputs, "source": texture}, uniforms, view.size)
    return result


def accumulate(painter: Painter, estimate: Buffers, means: Buffers, frames: int, view: View) -> None:
    """Add one of `frames` estimates, at its share, to the running means (single precision)."""
    gl = context.get()
    gl.enable_only(moderngl.BLEND)
    gl.blend_func = moderngl.ONE, moderngl.ONE
    for name, texture in estimate.items():
        step = Pass("accumulate", "pipeline/share.frag", {})
        uniforms = {"share": 1.0 / frames}
        painter.run(step, {"source": texture}, uniforms, view.size, targets={name: means[name]})
    gl.enable_only(moderngl.NOTHING)


def single_precision(format: str) -> str:
    """The float32 format with the same channels, for sums over many frames."""
    return {1: "R32F", 2: "RGBA32F", 4: "RGBA32F"}[FORMATS[format][0]]
