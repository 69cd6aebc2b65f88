"""What is tested for blocking: for each kind of glsl/occluders/, the textures and uniforms that it reads."""

import warnings
import weakref
from collections.abc import Callable
from dataclasses import dataclass, field

import moderngl

from .draw import Buffers, Painter
from .errors import Notice
from .gl import context
from .gl.geometry import Geometry
from .mesh import Mesh
from .modules import Module
from .passes import Pass
from .scene import Scene
from .surfaces import BACKGROUND_Z, G_BUFFER, DepthTargets
from .view import View


@dataclass(frozen=True)
class Stage:
    """What it takes to draw more surfaces of the scene."""

    painter: Painter
    geometry: Geometry
    depth: DepthTargets
    scene: Scene
    view: View


@dataclass
class Occluders:
    """`inputs` and `uniforms` for glsl/occluders/KIND.glsl. `hidden`: G-buffers whose surfaces may send light too,
    by the suffix of their names."""  # fmt: skip

    kind: str
    inputs: Buffers = field(default_factory=dict)
    uniforms: dict[str, object] = field(default_factory=dict)
    hidden: dict[str, Buffers] = field(default_factory=dict)


def depth(stage: Stage, module: Module, first: Buffers) -> Occluders:
    """The camera's one layer: nothing to add to the G-buffer."""
    return Occluders("depth")


_said_open: "weakref.WeakSet[Mesh]" = weakref.WeakSet()


def layers(stage: Stage, module: Module, first: Buffers) -> Occluders:
    """Up to `layers` depth layers, peeled (Everitt 2001); peeling stops early where nothing is left."""
    _say_what_is_open(stage.scene)
    painter, view = stage.painter, stage.view
    peeled, found = dict(first), 1
    hidden: dict[str, Buffers] = {}
    for number in range(1, module.layers):
        layer = _peel(stage, peeled[f"viewZ{number - 1 or ''}"], with_materials=module.bounce() is not None)
        if layer is None:
            break
        found += 1
        peeled |= {f"{name}{number}": texture for name, texture in layer.items()}
        hidden[str(number)] = layer
    for number in range(found, 4):  # samplers must be bound; the shader does not look
        peeled[f"viewZ{number}"] = first["viewZ"]
    pack = Pass("pack layers", "pipeline/pack_layers.frag", {"layersZ": "RGBA32F"})
    packed = painter.run(pack, peeled, view.uniforms, view.size, {"layers": found})
    inputs = {**packed, **{name: texture for name, texture in peeled.items() if not name.startswith("viewZ")}}
    for number in range(1, 4):  # as above
        inputs = {f"viewNormal{number}": first["viewNormal"], f"sender{number}": first["albedo"], **inputs}
    return Occluders("layers", inputs, {}, hidden if module.bounce() is not None else {})


def _peel(stage: Stage, nearer: moderngl.Texture, with_materials: bool) -> Buffers | None:
    """The G-buffer of what lies behind `nearer` (viewZ), or None where nothing does. Normals are the mesh's own."""
    gl, painter, view = context.get(), stage.painter, stage.view
    names = G_BUFFER if with_materials else {"viewZ": G_BUFFER["viewZ"]}
    buffers = {name: painter.take(view.size, format) for name, format in names.items()}
    program = painter.programs.get("pipeline/gbuffer.frag", {"peel": True}, vertex="pipeline/gbuffer.vert")
    program.set({**view.uniforms, "base_color": (1.0, 1.0, 1.0, 1.0), "alpha_cutoff": 0.0})
    painter.bind_unit(program, "base_texture", 0)
    painter.bind_unit(program, "nearerZ", 1)
    nearer.use(1)
    framebuffer = painter.pool.framebuffer(list(buffers.values()), stage.depth.of(view.size))
    drawn = gl.query(samples=True)
    with painter.timer.measure("peel"):
        framebuffer.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        painter.pool.framebuffer([buffers["viewZ"]]).clear(red=BACKGROUND_Z)
        framebuffer.use()
        gl.enable_only(moderngl.DEPTH_TEST)
        with drawn:
            stage.geometry.draw(stage.scene, program)
        gl.enable_only(moderngl.NOTHING)
    if drawn.samples == 0:
        painter.give_back(buffers)
        return None
    return buffers


def _say_what_is_open(scene: Scene) -> None:
    meshes = {instance.mesh for instance in scene.instances}
    fresh = [mesh for mesh in meshes if mesh not in _said_open and not mesh.is_closed]
    _said_open.update(fresh)
    if fresh:
        names = ", ".join(sorted({mesh.name for mesh in fresh})[:5])
        warnings.warn(
            f"{len(fresh)} of {len(meshes)} meshes are not closed ({names}): between two layers there need be no solid. "
            "Where the last layer has no back, `thickness` closes it",
            Notice,
            stacklevel=2,
        )


KINDS: dict[str, Callable[[Stage, Module, Buffers], Occluders]] = {"depth": depth, "layers": layers}

