"""What is tested for blocking: for each kind of glsl/occluders/, the textures and uniforms that it reads."""

import warnings
import weakref
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import moderngl
import numpy as np

from ...errors import Notice
from ...gl import context
from ...modules import Module
from ...modules.passes import Pass
from ...scene.camera import Camera
from ...scene.mesh import Mesh
from ...scene.scene import Scene
from ...scene.view import View, matrix_bytes
from ..geometry import Geometry
from ..pass_runner import Buffers, Painter
from ..surfaces import G_BUFFER, DepthTargets, g_buffer


@dataclass(frozen=True)
class Stage:
    """What it takes to draw more surfaces of the scene."""

    painter: Painter
    geometry: Geometry
    depth: DepthTargets
    scene: Scene
    view: View


@dataclass(frozen=True)
class Hidden:
    """A G-buffer of surfaces that the camera does not see, and the view that it was drawn for."""

    surfaces: Buffers
    view: View


@dataclass
class Occluders:
    """`inputs` and `uniforms` of glsl/occluders/KIND.glsl; `hidden`: surfaces that may send light, by names' suffix."""

    kind: str
    inputs: Buffers = field(default_factory=dict)
    uniforms: dict[str, object] = field(default_factory=dict)
    hidden: dict[str, Hidden] = field(default_factory=dict)


def depth(stage: Stage, module: Module, first: Buffers) -> Occluders:
    """The camera's one layer: nothing to add to the G-buffer."""
    return Occluders("depth")


def layers(stage: Stage, module: Module, first: Buffers) -> Occluders:
    """Up to `layers` depth layers, peeled (Everitt 2001); peeling stops early where nothing is left."""
    _say_what_is_open(stage.scene)
    sends = module.sends()
    behind = _peeled(stage, first["viewZ"], module.layers, sends)
    inputs = _pack(stage, first["viewZ"], behind)
    hidden = {}
    for number in range(1, 4):  # samplers must be bound; the shader does not look where there is no layer
        layer = behind[number - 1] if sends and number <= len(behind) else first
        inputs |= {f"viewNormal{number}": layer["viewNormal"], f"sender{number}": layer["albedo"]}
        if layer is not first:
            hidden[str(number)] = Hidden(layer, stage.view)
    return Occluders("layers", inputs, {}, hidden)


def views(stage: Stage, module: Module, first: Buffers) -> Occluders:
    """What `views` further cameras see, at `view_scale` of the resolution, each with `view_layers` layers."""
    if module.view_layers > 1:
        _say_what_is_open(stage.scene)
    cameras = further_cameras(stage.view.camera, stage.scene)[: module.views]
    size = stage.view.scaled(module.view_scale).size
    inputs: Buffers = {}
    hidden = {}
    for number, camera in enumerate(cameras, start=1):
        there = replace(stage, view=View(camera, size, stage.scene.bounds))
        seen = g_buffer(there.painter, there.geometry, there.depth, there.scene, there.view, name="views")
        inputs |= {f"{name}{number}": texture for name, texture in seen.items()}
        inputs[f"sender{number}"] = inputs.pop(f"albedo{number}")
        if module.view_layers > 1:
            behind = _peeled(there, seen["viewZ"], module.view_layers, with_materials=False)
            inputs[f"viewZ{number}"] = _pack(there, seen["viewZ"], behind)["layersZ"]
        hidden[str(number)] = Hidden(seen, there.view)
    for number in range(1, 5):  # samplers must be bound
        unused = {f"viewZ{number}": first["viewZ"], f"viewNormal{number}": first["viewNormal"]}
        inputs = {**unused, f"sender{number}": first["albedo"], **inputs}
    there_from_world = [camera.view_from_world for camera in cameras]
    here_from_world = stage.view.camera.view_from_world
    there_from_here = [matrix @ np.linalg.inv(here_from_world) for matrix in there_from_world]
    there_from_here += [np.eye(4)] * (4 - len(cameras))
    like = View(cameras[0], size, stage.scene.bounds).uniforms
    uniforms = {
        "views_texel_size": like["texel_size"],
        "views_pixel_from_ray": like["pixel_from_ray"],
        "view_from_camera": b"".join(matrix_bytes(matrix) for matrix in there_from_here),
        "camera_from_view": b"".join(matrix_bytes(np.linalg.inv(matrix)) for matrix in there_from_here),
    }
    return Occluders("views", inputs, uniforms, hidden if module.sends() else {})


# to the right, to the left, above, and from the other side: in the camera's own axes (x right, y up, -z forward)
DISPLACEMENTS = ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.6, -0.8))


def further_cameras(camera: Camera, scene: Scene) -> list[Camera]:
    """The cameras of SSDO, section 4: displaced by a unit vector times the scene's bounding-sphere radius.

    They look at the same centre of interest: the point of the view axis beside the scene's centre, or the target if
    that is farther.
    """
    axes = camera.view_from_world[:3, :3]  # rows: right, up, backward
    eye, forward = np.asarray(camera.eye), -axes[2]
    distance = max(np.linalg.norm(np.subtract(camera.target, eye)), (scene.bounds.mean(axis=0) - eye) @ forward)
    interest = eye + distance * forward
    result = []
    for displacement in DISPLACEMENTS:
        there = eye + scene.radius * (np.asarray(displacement) @ axes)
        looking = interest - there
        # straight down the camera's up there is no up left: then its forward serves
        up = axes[1] if np.linalg.norm(np.cross(looking, axes[1])) > 1e-3 * np.linalg.norm(looking) else forward
        result.append(replace(camera, eye=tuple(there), target=tuple(interest), up=tuple(up)))
    return result


def _peeled(stage: Stage, nearest: moderngl.Texture, count: int, with_materials: bool) -> list[Buffers]:
    """The G-buffers behind `nearest` (viewZ): `count` - 1 of them, or as many as there are."""
    behind: list[Buffers] = []
    while len(behind) < count - 1:
        layer = _peel(stage, behind[-1]["viewZ"] if behind else nearest, with_materials)
        if layer is None:
            break
        behind.append(layer)
    return behind


def _pack(stage: Stage, nearest: moderngl.Texture, behind: list[Buffers]) -> Buffers:
    """`layersZ`: the depths of up to four layers in one texture."""
    depths = [nearest, *(layer["viewZ"] for layer in behind)]
    padded = depths + [nearest] * (4 - len(depths))  # samplers must be bound; `layers` says how many count
    inputs = {f"viewZ{number or ''}": texture for number, texture in enumerate(padded)}
    step = Pass("pack layers", "pipeline/pack_layers.frag", {"layersZ": "RGBA32F"})
    return stage.painter.run(step, inputs, {}, stage.view.size, {"layers": len(depths)})


def _peel(stage: Stage, nearer: moderngl.Texture, with_materials: bool) -> Buffers | None:
    """The G-buffer of what lies behind `nearer` (viewZ), or None where nothing does. Normals are the mesh's own."""
    formats = G_BUFFER if with_materials else {"viewZ": G_BUFFER["viewZ"]}
    drawn = context.get().query(samples=True)
    with drawn:
        buffers = g_buffer(stage.painter, stage.geometry, stage.depth, stage.scene, stage.view, "peel", nearer, formats)
    if drawn.samples == 0:
        stage.painter.give_back(buffers)
        return None
    return buffers


_said_open: "weakref.WeakSet[Mesh]" = weakref.WeakSet()


def _say_what_is_open(scene: Scene) -> None:
    meshes = {instance.mesh for instance in scene.instances}
    fresh = [mesh for mesh in meshes if mesh not in _said_open and not mesh.is_closed]
    _said_open.update(fresh)
    if fresh:
        names = ", ".join(sorted({mesh.name for mesh in fresh})[:5])
        warnings.warn(
            f"{len(fresh)} of {len(meshes)} meshes are not closed ({names}): between two layers need be no solid. "
            "Where the last layer has no back, `thickness` closes it",
            Notice,
            stacklevel=2,
        )


KINDS: dict[str, Callable[[Stage, Module, Buffers], Occluders]] = {"depth": depth, "layers": layers, "views": views}
