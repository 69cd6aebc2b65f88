"""Draws the scene's triangles: G-buffers, depth layers, and the geometry passes of modules and occluder kinds."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import nullcontext

import moderngl

from ..gl import context, raw
from ..gl.bindings import Bindings, joined
from ..gl.texture import Depth, attach
from ..modules.buffers import ON_DEMAND
from ..modules.passes import GeometryPass, Pass
from ..scene.mesh import Mesh
from ..scene.scene import Scene
from ..scene.view import Size, View, Viewpoint
from .geometry import MESH_TEXTURES, MESH_UNIFORMS, Geometry, kinds_of
from .pass_runner import FARTHEST, Buffers, PassRunner
from .surfaces import G_BUFFER, g_buffer


class DepthTargets:
    """Depth buffers by size: scratch space that no frame keeps."""

    def __init__(self) -> None:
        self._depth: dict[Size, moderngl.Renderbuffer] = {}

    def of(self, size: Size) -> moderngl.Renderbuffer:
        """A depth buffer of unspecified content."""
        if size not in self._depth:
            if len(self._depth) >= 4:  # the image, and the further views; older ones are of sizes left behind
                self._depth.clear()
            depth = context.get().depth_renderbuffer(size)
            attach([], depth)  # refuses one that the driver had no memory for
            self._depth[size] = depth
        return self._depth[size]


class Rasterizer:
    """Draws one scene for the frame of one runner. An occluder kind draws through it (`modules.occluders.Drawing`).

    `last` are the buffers and the view of the last frame, for all passes.
    """

    def __init__(
        self, runner: PassRunner, geometry: Geometry, depth: DepthTargets, scene: Scene, last: Bindings
    ) -> None:
        self.runner, self.geometry, self.depth, self.scene, self.last = runner, geometry, depth, scene, last

    def surfaces(
        self,
        views: Sequence[View],
        name: str = "g_buffer",
        formats: Mapping[str, str] = G_BUFFER,
        depth: Depth | None = None,
        only: Collection[Mesh] | None = None,
        onto: Buffers | None = None,
    ) -> Buffers:
        """The G-buffer of all `views`, tiles of one texture for each of `formats`: see `surfaces.g_buffer`.

        `depth` is filled with depths of up to `FARTHEST`, and 1 in the background. `only` and `onto`: see `triangles`.
        """
        step = g_buffer(name, self._needed(formats), atlas=len(views) > 1)
        with raw.depth_up_to(FARTHEST):
            return self.triangles(step, views, depth=depth, skip_backs=True, only=only, onto=onto)

    def _needed(self, formats: Mapping[str, str]) -> Mapping[str, str]:
        """The formats, and that of the emission, if the surfaces' light is wanted and the scene has some."""
        emits = "albedo" in formats and self.scene.emits
        return {**formats, **({"emission": ON_DEMAND["emission"].format} if emits else {})}

    def peeled(
        self,
        nearest: moderngl.Texture,
        count: int,
        views: Sequence[View],
        formats: Mapping[str, str] = G_BUFFER,
    ) -> list[Buffers]:
        """Up to `count` further depth layers behind `nearest` (viewZ); fewer where nothing is left."""
        behind: list[Buffers] = []
        while len(behind) < count:
            layer = self.peel(behind[-1]["viewZ"] if behind else nearest, views, formats)
            if layer is None:
                break
            behind.append(layer)
        return behind

    def peel(
        self, nearer: moderngl.Texture, views: Sequence[View], formats: Mapping[str, str] = G_BUFFER
    ) -> Buffers | None:
        """The G-buffer of what lies behind `nearer` (viewZ), or None where nothing does. Normals are the mesh's own."""
        drawn = context.get().query(samples=True)
        with drawn:
            step = g_buffer("peel", self._needed(formats), peel=True)
            buffers = self.triangles(step, views, [Bindings("the nearer layer", {"nearerZ": nearer})])
        if drawn.samples == 0:
            self.runner.give_back(buffers)
            return None
        return buffers

    def draw(self, step: GeometryPass, view: View, bindings: Iterable[Bindings] = ()) -> Buffers:
        """The outputs of a geometry pass from its viewpoint; `view` is the camera's."""
        seen_from = view if step.seen_from is None else step.seen_from(self.scene, view)
        return self.triangles(step, [seen_from], bindings)

    def reliefs(self) -> Bindings:
        """The scene's height maps, for shaders with lib/relief.glsl."""
        made = self.geometry.reliefs.of(self.scene)
        textures = {"relief_atlas": made.atlas}
        return Bindings("the reliefs", textures, made.uniforms, {"reliefs": len(made.regions)})

    def run(self, step: Pass, bindings: Iterable[Bindings], size: Size) -> Buffers:
        """The outputs of a full-screen pass."""
        return self.runner.run(step, bindings, size)

    def kept(self, name: str, key: object, make: Callable[[], Buffers]) -> Buffers:
        """The textures that `make` returns, kept between frames: see `PassRunner.kept`."""
        return self.runner.kept(name, key, make)

    def triangles(
        self,
        step: GeometryPass,
        viewpoints: Sequence[Viewpoint],
        bindings: Iterable[Bindings] = (),
        depth: Depth | None = None,
        skip_backs: bool = False,
        only: Collection[Mesh] | None = None,
        onto: Buffers | None = None,
    ) -> Buffers:
        """Draw the triangles from each viewpoint into its region of the outputs; `depth` replaces a scratch one.

        With `skip_backs`, backs that are hidden behind the fronts of their solid are left out. With `only`, just these
        meshes are drawn. With `onto`, the triangles are added to these outputs of another pass and to its depth. Then
        further outputs are unspecified where none of the triangles is.
        """
        gl, runner, size = context.get(), self.runner, viewpoints[0].sheet
        # of each mesh in turn, by Geometry.draw
        kinds = kinds_of(self.scene.meshes if only is None else only)
        mesh = Bindings("the mesh", uniforms=MESH_UNIFORMS, constants=kinds)
        own = [
            *bindings,
            mesh,
            self.reliefs(),
            self.last,
            Bindings(f"the pass '{step.name}'", constants=step.constants, includes=step.includes),
        ]
        views = [Bindings("the view", uniforms=one.uniforms, constants=one.constants) for one in viewpoints]
        given = [joined([*own, view], f"pass '{step.name}'") for view in views]
        program = runner.program(step, given[0], step.vertex, step.geometry)
        tested = step.combine == "nearest"
        depth = (depth or self.depth.of(size)) if tested else None
        targets = runner.targets(step, size, onto or {})
        # a depth texture alone is not kept in the pool, which would keep it for good
        framebuffer = runner.framebuffer(program, step, targets, depth) if targets else attach([], depth)
        runner.bind(program, given[0].textures, step.reads, MESH_TEXTURES)
        with runner.timer.measure(step.name):
            if onto is None:
                _clear(runner, framebuffer, step, targets, size)
            gl.enable_only(moderngl.DEPTH_TEST if tested else moderngl.NOTHING)
            with nullcontext() if tested else raw.or_bits():
                for viewpoint, one in zip(viewpoints, given, strict=True):
                    program.set(one.uniforms)
                    framebuffer.viewport = viewpoint.region
                    framebuffer.use()
                    seen_from = viewpoint if skip_backs and isinstance(viewpoint, View) else None
                    self.geometry.draw(self.scene, program, seen_from, only)
            gl.enable_only(moderngl.NOTHING)
        return targets


def _clear(
    runner: PassRunner, framebuffer: moderngl.Framebuffer, step: GeometryPass, targets: Buffers, size: Size
) -> None:
    """Fill the depth with 1 and each target with its `clear` value."""
    framebuffer.viewport = 0, 0, *size
    whole_numbers = any(texture.dtype == "u4" for texture in targets.values())
    if not whole_numbers:
        framebuffer.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
    for name, texture in targets.items():
        value = step.clear.get(name, 0.0)
        alone = runner.pool.framebuffer([texture])
        alone.viewport = 0, 0, *size
        if texture.dtype == "u4":
            raw.clear_integers(alone, 0, int(value))
        elif value or whole_numbers:
            alone.clear(value, value, value, value)
