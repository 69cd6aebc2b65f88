"""Meshes and their textures on the GPU, kept for as long as the mesh lives."""

import weakref
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import moderngl
import numpy as np

from ..gl import context
from ..gl.program import Program
from ..gl.source import Constant
from ..gl.texture import refuse_exhaustion
from ..scene.clipping import with_hidden_backs
from ..scene.mesh import Mesh, Texture
from ..scene.scene import Scene
from ..scene.view import View
from .reliefs import ReliefStore
from .textures import upload

# of each mesh in turn; see glsl/lib/base_color.glsl
MESH_UNIFORMS: dict[str, object] = {
    "base_color": (1.0, 1.0, 1.0, 1.0),
    "alpha_cutoff": -1.0,
    "blended": False,
    "mesh_number": 0.0,
    "single_sided": False,
    "has_shares": False,
    "emission": (0.0, 0.0, 0.0),
    "normal_scale": 1.0,
    "normal_mapped": False,
    "relief_number": 0,
    "is_smooth": False,
}
ATTRIBUTES = "local_position", "local_normal", "texture_uv", "vertex_color", "vertex_visibility"
INSTANCE_BYTES = 17 * 4  # world_from_local 16f, number 1f
MESH_TEXTURES = {"base_texture": 0, "emission_texture": 1, "normal_texture": 2}  # of each mesh in turn, by their units


def kinds_of(meshes: Collection[Mesh]) -> dict[str, Constant]:
    """Constants: whether one of the meshes is single-sided, has holes or is blended, and so on.

    Most scenes have few of these, and their shaders are spared the rest.
    """
    return {
        "one_sided": any(not mesh.material.double_sided for mesh in meshes),
        "cut_outs": any(mesh.material.has_holes for mesh in meshes),
        "bent_normals": any(mesh.material.bends_normals for mesh in meshes),
        "textured": any(mesh.material.texture is not None for mesh in meshes),
        "vertex_colored": any(mesh.colors is not None for mesh in meshes),
    }


def stored(color: tuple[float, float, float]) -> tuple[float, ...]:
    """The colour in the half floats of the G-buffer, so that no driver rounds it in its own way."""
    return tuple(np.array(color, np.float16).tolist())


@dataclass
class _Group:
    """Instances of a mesh that are drawn together: the mirrored ones, or the others."""

    instances: moderngl.Buffer  # INSTANCE_BYTES each
    placement: bytes
    arrays: dict[int, moderngl.VertexArray] = field(default_factory=dict)  # by program


@dataclass
class _GpuMesh:
    attributes: moderngl.Buffer  # position 3f, normal 3f, uv 2f, colour 4f, baked visibility 1f
    indices: moderngl.Buffer
    tangents: moderngl.Buffer | None = None  # 4f; made when a program reads them
    groups: dict[bool, _Group] = field(default_factory=dict)  # by whether they are mirrored


def _placements(world_from_local: Sequence[np.ndarray], scene: Scene) -> dict[bool, bytes]:
    """{mirrored: the instances}. Of each instance: the matrix as GLSL stores it, column by column, in the world of the
    shaders; and its number.
    """
    placed = np.array(world_from_local)
    placed[:, :3, 3] -= scene.shader_origin
    columns = placed.transpose(0, 2, 1).reshape(-1, 16)
    rows = np.column_stack([columns, np.arange(len(columns))]).astype(np.float32)
    mirrored = np.linalg.det(placed[:, :3, :3]) < 0
    return {side: rows[mirrored == side].tobytes() for side in (False, True) if (mirrored == side).any()}


class Geometry:
    """Uploads what it has not seen; draws a scene, one call a mesh, instanced."""

    def __init__(self) -> None:
        self._meshes: weakref.WeakKeyDictionary[Mesh, _GpuMesh] = weakref.WeakKeyDictionary()
        self._textures: weakref.WeakKeyDictionary[Texture, dict[object, moderngl.Texture]]
        self._textures = weakref.WeakKeyDictionary()  # by the alpha at which it is cut, and of numbers
        self._white: moderngl.Texture | None = None
        self._scenes: weakref.WeakKeyDictionary[Scene, Sequence[tuple[Mesh, int, Mapping[bool, bytes]]]]
        self._scenes = weakref.WeakKeyDictionary()
        self._seen: tuple[Scene, View, Collection[Mesh]] | None = None
        self.reliefs = ReliefStore()

    def draw(
        self, scene: Scene, program: Program, seen_from: View | None = None, only: Collection[Mesh] | None = None
    ) -> None:
        """Draw every instance, or those of `only` these meshes; sets `MESH_UNIFORMS`, and binds `MESH_TEXTURES`.

        Backs of solids that the view `seen_from` cannot see are left out. The order of meshes is always the same,
        so that of surfaces at equal depth the same is seen.
        """
        gl, without_backs = context.get(), self._without_backs(scene, seen_from) if seen_from else ()
        for mesh, number, placements in self._placed(scene):
            if only is not None and mesh not in only:
                continue
            gpu = self._of(mesh)
            self._use_material(mesh, number, program, scene)
            if mesh in without_backs:
                gl.enable(moderngl.CULL_FACE)
            for mirrored, placement in placements.items():
                gl.cull_face = "front" if mirrored else "back"
                group = self._group(gpu, mirrored, placement)
                self._array(mesh, gpu, group, program).render(instances=len(placement) // INSTANCE_BYTES)
            gl.disable(moderngl.CULL_FACE)

    def _without_backs(self, scene: Scene, view: View) -> Collection[Mesh]:
        """The meshes whose backs the view cannot see, kept for a still camera."""
        if self._seen is None or self._seen[0] is not scene or self._seen[1] is not view:
            self._seen = scene, view, frozenset(with_hidden_backs(scene, view))
        return self._seen[2]

    def _placed(self, scene: Scene) -> Sequence[tuple[Mesh, int, Mapping[bool, bytes]]]:
        """(mesh, its number, {mirrored: the placements of its instances}), kept for as long as the scene lives.

        Meshes with patterns come last: they may be drawn by a pass of their own.
        """
        if scene not in self._scenes:
            groups: dict[Mesh, list[np.ndarray]] = {mesh: [] for mesh in scene.meshes}
            for instance in scene.instances:
                groups[instance.mesh].append(instance.world_from_local)
            numbered = [(mesh, number, groups[mesh]) for number, mesh in enumerate(groups)]
            numbered.sort(key=lambda entry: entry[0] in scene.patterned)
            self._scenes[scene] = [(mesh, number, _placements(some, scene)) for mesh, number, some in numbered]
        return self._scenes[scene]

    def _group(self, gpu: _GpuMesh, mirrored: bool, placement: bytes) -> _Group:
        group = gpu.groups.get(mirrored)
        if group is None:
            group = gpu.groups[mirrored] = _Group(context.get().buffer(placement), placement)
        elif group.placement != placement:
            group.instances.orphan(len(placement))
            group.instances.write(placement)
            group.placement = placement
        return group

    def _of(self, mesh: Mesh) -> _GpuMesh:
        if mesh not in self._meshes:
            self._meshes[mesh] = self._upload(mesh)
        return self._meshes[mesh]

    def _upload(self, mesh: Mesh) -> _GpuMesh:
        gl = context.get()
        assert mesh.normals is not None  # Mesh makes them
        count = len(mesh.vertices)
        uv = np.zeros((count, 2), np.float32) if mesh.uv is None else mesh.uv
        colors = np.ones((count, 4), np.float32) if mesh.colors is None else mesh.colors
        baked = np.ones((count, 1), np.float32) if mesh.visibility is None else mesh.visibility
        interleaved = np.concatenate([mesh.vertices, mesh.normals, uv, colors, baked], axis=1, dtype=np.float32)
        gpu = _GpuMesh(gl.buffer(interleaved), gl.buffer(mesh.faces))
        refuse_exhaustion(f"mesh '{mesh.name}' of {interleaved.nbytes / 1e6:.0f} MB")
        return gpu

    def _array(self, mesh: Mesh, gpu: _GpuMesh, group: _Group, program: Program) -> moderngl.VertexArray:
        key = program.gl.glo
        if key not in group.arrays:
            content = [
                (gpu.attributes, "3f 3f 2f 4f 1f", *ATTRIBUTES),
                (group.instances, "16f 1f/i", "world_from_local", "instance_number"),
            ]
            if "local_tangent" in program.gl:
                if gpu.tangents is None:
                    tangents = np.zeros((len(mesh.vertices), 4)) if mesh.tangents is None else mesh.tangents
                    gpu.tangents = context.get().buffer(tangents.astype(np.float32))
                content.append((gpu.tangents, "4f", "local_tangent"))
            group.arrays[key] = context.get().vertex_array(program.gl, content, gpu.indices, skip_errors=True)
        return group.arrays[key]

    def _use_material(self, mesh: Mesh, number: int, program: Program, scene: Scene) -> None:
        material = mesh.material
        values = MESH_UNIFORMS | {
            "base_color": (*stored(material.base_color), material.alpha),
            "alpha_cutoff": -1.0 if material.alpha_cutoff is None else material.alpha_cutoff,
            "blended": material.blend,
            "mesh_number": float(number),
            "single_sided": not material.double_sided,
            "has_shares": material.texture is not None and material.texture.mipmaps,
            "emission": material.emission,
            "normal_scale": material.normal_scale,
            "normal_mapped": material.normal_texture is not None,
            "relief_number": 0 if material.height is None else 1 + scene.height_maps.index(material.height),
            "is_smooth": mesh.is_smooth,
        }
        cutoff = material.alpha_cutoff
        if cutoff is not None:
            cutoff /= max(material.alpha, 1e-6)  # the texture's own alpha at which the material cuts
        textures = [self._texture(material.texture, cutoff), self._texture(material.emission_texture, None)]
        if scene.bends_normals:
            textures.append(self._texture(material.normal_texture, None, colors=False))
        for name, value in values.items():
            if name in program.uniforms:  # a compiler may find that an edited shader does not need it
                program.write(name, value)
        for unit, texture in enumerate(textures):  # after all uploads, which use unit 0
            texture.use(unit)

    def _texture(self, texture: Texture | None, cutoff: float | None, colors: bool = True) -> moderngl.Texture:
        """The texture; None is white. Without `colors`, its values are linear numbers."""
        if texture is None:
            self._white = self._white or context.get().texture((1, 1), 4, b"\xff" * 4)
            return self._white
        known = self._textures.setdefault(texture, {})
        key = cutoff if colors else "numbers"
        if key not in known:
            known[key] = upload(texture, cutoff, colors)
        return known[key]
