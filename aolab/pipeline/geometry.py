"""Meshes and their textures on the GPU, kept for as long as the mesh lives."""

import weakref
from dataclasses import dataclass, field

import moderngl
import numpy as np

from ..gl import context
from ..gl.program import Program
from ..gl.source import Constant
from ..gl.texture import refuse_exhaustion
from ..scene.mesh import Mesh, Texture
from ..scene.scene import Instance, Scene
from .textures import upload

# of each mesh in turn; see glsl/lib/base_color.glsl
MESH_UNIFORMS: dict[str, object] = {
    "base_color": (1.0, 1.0, 1.0, 1.0),
    "alpha_cutoff": -1.0,
    "blended": False,
    "mesh_number": 0.0,
    "single_sided": False,
    "emission": (0.0, 0.0, 0.0),
    "is_smooth": False,
}
MESH_TEXTURES = {"base_texture": 0, "emission_texture": 1}  # of each mesh in turn, by their units


def kinds_of(scene: Scene) -> dict[str, Constant]:
    """Constants: whether some mesh of the scene is single-sided, and whether some has holes or is blended.

    Most scenes have none of them, and their shaders are spared the tests.
    """
    materials = [instance.mesh.material for instance in scene.instances]
    return {
        "one_sided": any(not material.double_sided for material in materials),
        "cut_outs": any(material.blend or material.alpha_cutoff is not None for material in materials),
    }


@dataclass
class _GpuMesh:
    attributes: moderngl.Buffer  # position 3f, normal 3f, uv 2f, colour 4f
    indices: moderngl.Buffer
    instances: moderngl.Buffer
    placement: bytes
    arrays: dict[int, moderngl.VertexArray] = field(default_factory=dict)  # by program


class Geometry:
    """Uploads what it has not seen; draws a scene, one call a mesh, instanced."""

    def __init__(self) -> None:
        self._meshes: weakref.WeakKeyDictionary[Mesh, _GpuMesh] = weakref.WeakKeyDictionary()
        self._textures: weakref.WeakKeyDictionary[Texture, dict[float | None, moderngl.Texture]]
        self._textures = weakref.WeakKeyDictionary()  # by the alpha at which it is cut
        self._white: moderngl.Texture | None = None

    def draw(self, scene: Scene, program: Program) -> None:
        """Draw every instance; sets the program's `MESH_UNIFORMS`, and binds `MESH_TEXTURES`."""
        for number, (mesh, placements) in enumerate(self._by_mesh(scene).items()):
            gpu = self._place(mesh, placements, scene.shader_origin)
            self._use_material(mesh, number, program)
            self._array(gpu, program).render(instances=len(placements))

    @staticmethod
    def _by_mesh(scene: Scene) -> dict[Mesh, list[Instance]]:
        groups: dict[Mesh, list[Instance]] = {}
        for instance in scene.instances:
            groups.setdefault(instance.mesh, []).append(instance)
        return groups

    def _place(self, mesh: Mesh, placements: list[Instance], centre: np.ndarray) -> _GpuMesh:
        placed = np.array([instance.world_from_local for instance in placements])
        placed[:, :3, 3] -= centre
        matrices = placed.transpose(0, 2, 1).astype(np.float32).tobytes()  # GLSL stores them column by column
        gpu = self._meshes.get(mesh)
        if gpu is None:
            gpu = self._meshes[mesh] = self._upload(mesh, matrices)
        elif gpu.placement != matrices:
            gpu.instances.orphan(len(matrices))
            gpu.instances.write(matrices)
            gpu.placement = matrices
        return gpu

    def _upload(self, mesh: Mesh, matrices: bytes) -> _GpuMesh:
        gl = context.get()
        assert mesh.normals is not None  # Mesh makes them
        count = len(mesh.vertices)
        uv = np.zeros((count, 2), np.float32) if mesh.uv is None else mesh.uv
        colors = np.ones((count, 4), np.float32) if mesh.colors is None else mesh.colors
        interleaved = np.concatenate([mesh.vertices, mesh.normals, uv, colors], axis=1, dtype=np.float32)
        gpu = _GpuMesh(gl.buffer(interleaved), gl.buffer(mesh.faces), gl.buffer(matrices), matrices)
        refuse_exhaustion(f"mesh '{mesh.name}' of {interleaved.nbytes / 1e6:.0f} MB")
        return gpu

    def _array(self, gpu: _GpuMesh, program: Program) -> moderngl.VertexArray:
        key = program.gl.glo
        if key not in gpu.arrays:
            content = [
                (gpu.attributes, "3f 3f 2f 4f", "local_position", "local_normal", "texture_uv", "vertex_color"),
                (gpu.instances, "16f/i", "world_from_local"),
            ]
            gpu.arrays[key] = context.get().vertex_array(program.gl, content, gpu.indices, skip_errors=True)
        return gpu.arrays[key]

    def _use_material(self, mesh: Mesh, number: int, program: Program) -> None:
        material = mesh.material
        values = MESH_UNIFORMS | {
            "base_color": (*material.base_color, material.alpha),
            "alpha_cutoff": -1.0 if material.alpha_cutoff is None else material.alpha_cutoff,
            "blended": material.blend,
            "mesh_number": float(number),
            "single_sided": not material.double_sided,
            "emission": material.emission,
            "is_smooth": mesh.is_smooth,
        }
        cutoff = material.alpha_cutoff
        if cutoff is not None:
            cutoff /= max(material.alpha, 1e-6)  # the texture's own alpha at which the material cuts
        textures = [self._texture(material.texture, cutoff), self._texture(material.emission_texture, None)]
        for name, value in values.items():
            if name in program.uniforms:  # a compiler may find that an edited shader does not need it
                program.uniforms[name].value = value
        for unit, texture in enumerate(textures):  # after all uploads, which use unit 0
            texture.use(unit)

    def _texture(self, texture: Texture | None, cutoff: float | None) -> moderngl.Texture:
        """The texture; None is white."""
        if texture is None:
            self._white = self._white or context.get().texture((1, 1), 4, b"\xff" * 4)
            return self._white
        known = self._textures.setdefault(texture, {})
        if cutoff not in known:
            known[cutoff] = upload(texture, cutoff)
        return known[cutoff]
