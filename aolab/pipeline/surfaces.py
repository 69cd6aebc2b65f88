"""Surfaces: what the camera sees, before any light (the G-buffer), and its smaller copy."""

from collections.abc import Mapping

import moderngl
import numpy as np

from ..gl import context
from ..gl.texture import attach
from ..modules.passes import Pass
from ..scene.scene import Scene
from ..scene.view import View, ray_scale_offset
from .geometry import Geometry
from .pass_runner import Buffers, Painter

G_BUFFER = {"viewZ": "R32F", "viewNormal": "RGBA16F", "albedo": "RGBA16F"}
BACKGROUND_Z = -np.inf

_SHRINK = Pass("shrink", "pipeline/shrink.frag", G_BUFFER)


class DepthTargets:
    """Depth buffers by size: scratch space that no frame keeps."""

    def __init__(self) -> None:
        self._depth: dict[tuple[int, int], moderngl.Renderbuffer] = {}

    def of(self, size: tuple[int, int]) -> moderngl.Renderbuffer:
        if size not in self._depth:
            if len(self._depth) >= 4:  # the image, and the further views; older ones are of sizes left behind
                self._depth.clear()
            depth = context.get().depth_renderbuffer(size)
            attach([], depth)  # refuses one that the driver had no memory for
            self._depth[size] = depth
        return self._depth[size]


def g_buffer(
    painter: Painter,
    geometry: Geometry,
    depth: DepthTargets,
    scene: Scene,
    view: View,
    name: str = "g_buffer",
    nearer: moderngl.Texture | None = None,
    formats: Mapping[str, str] = G_BUFFER,
) -> Buffers:
    """Draw the scene's viewZ (R32F, background -inf), viewNormal and albedo (RGBA16F), or the first of these only.

    `name` is for the timings. With `nearer` (viewZ), what lies behind that layer, with the mesh's own normals.
    """
    gl = context.get()
    buffers = {name: painter.take(view.size, format) for name, format in formats.items()}
    peel = nearer is not None
    program = painter.programs.get("pipeline/gbuffer.frag", {"peel": peel}, vertex="pipeline/gbuffer.vert")
    # set a mesh at a time, by Geometry.draw
    program.set({**view.uniforms, "base_color": (1.0, 1.0, 1.0, 1.0), "alpha_cutoff": 0.0})
    painter.bind_unit(program, "base_texture", 0)
    if nearer is not None:
        painter.bind_unit(program, "nearerZ", 1)
        nearer.use(1)
    framebuffer = painter.pool.framebuffer(list(buffers.values()), depth.of(view.size))
    with painter.timer.measure(name):
        framebuffer.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        painter.pool.framebuffer([buffers["viewZ"]]).clear(red=BACKGROUND_Z)
        framebuffer.use()
        gl.enable_only(moderngl.DEPTH_TEST)
        geometry.draw(scene, program)
        gl.enable_only(moderngl.NOTHING)
    return buffers


def shrink(painter: Painter, buffers: Buffers, view: View, small: View) -> Buffers:
    """The G-buffer at the size of `small`, from the one at the size of `view`."""
    uniforms = {**view.uniforms, "small_ray_from_pixel": ray_scale_offset(small.camera, small.size)}
    return painter.run(_SHRINK, buffers, uniforms, small.size)


def border_samplers() -> dict[str, moderngl.Sampler]:
    """For depths that are asked for off the screen, where nothing is known.

    The camera's are the background's there: nothing blocks. Those of further views are infinitely far: they do not
    say that a point is in the open.
    """
    background = _border((BACKGROUND_Z, BACKGROUND_Z, BACKGROUND_Z, BACKGROUND_Z))
    unknown = _border((np.inf, np.inf, BACKGROUND_Z, BACKGROUND_Z))
    return {
        **dict.fromkeys(("viewZ", "layersZ"), background),
        **dict.fromkeys(("viewZ1", "viewZ2", "viewZ3", "viewZ4"), unknown),
    }


def _border(color: tuple[float, float, float, float]) -> moderngl.Sampler:
    sampler = context.get().sampler(repeat_x=False, repeat_y=False, filter=(moderngl.NEAREST, moderngl.NEAREST))
    sampler.border_color = color
    return sampler
