"""Meshes and their textures on the GPU, kept for as long as the mesh lives."""

import warnings
import weakref
from dataclasses import dataclass, field

import moderngl
import numpy as np
from PIL import Image

from ..errors import Notice
from ..gl import context
from ..gl.program import Program
from ..gl.texture import refuse_exhaustion
from ..scene.mesh import Mesh, Texture
from ..scene.scene import Instance, Scene

GL_SRGB8_ALPHA8 = 0x8C43


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
        self._textures: weakref.WeakKeyDictionary[Texture, moderngl.Texture] = weakref.WeakKeyDictionary()
        self._white: moderngl.Texture | None = None

    def draw(self, scene: Scene, program: Program) -> None:
        """Draw every instance; sets the program's base_color and alpha_cutoff, and puts base_texture on unit 0."""
        for mesh, placements in self._by_mesh(scene).items():
            gpu = self._place(mesh, placements)
            self._use_material(mesh, program)
            self._array(gpu, program).render(instances=len(placements))

    @staticmethod
    def _by_mesh(scene: Scene) -> dict[Mesh, list[Instance]]:
        groups: dict[Mesh, list[Instance]] = {}
        for instance in scene.instances:
            groups.setdefault(instance.mesh, []).append(instance)
        return groups

    def _place(self, mesh: Mesh, placements: list[Instance]) -> _GpuMesh:
        # GLSL matrices are stored column by column
        matrices = np.array([i.world_from_local.T for i in placements], np.float32).tobytes()
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

    def _use_material(self, mesh: Mesh, program: Program) -> None:
        material = mesh.material
        cutoff = -1.0 if material.alpha_cutoff is None else material.alpha_cutoff
        for name, value in {"base_color": (*material.base_color, material.alpha), "alpha_cutoff": cutoff}.items():
            if name in program.uniforms:  # a compiler may find that an edited shader does not need it
                program.uniforms[name].value = value
        texture = self._white_texture() if material.texture is None else self._texture(material.texture)
        texture.use(0)

    def _white_texture(self) -> moderngl.Texture:
        if self._white is None:
            self._white = context.get().texture((1, 1), 4, b"\xff" * 4)
        return self._white

    def _texture(self, texture: Texture) -> moderngl.Texture:
        if texture not in self._textures:
            self._textures[texture] = _upload_texture(texture)
        return self._textures[texture]


def _upload_texture(texture: Texture) -> moderngl.Texture:
    gl = context.get()
    limit = gl.info["GL_MAX_TEXTURE_SIZE"]
    pixels = texture.pixels
    height, width = pixels.shape[:2]
    if max(width, height) > limit:
        scale = limit / max(width, height)
        size = max(1, int(width * scale)), max(1, int(height * scale))
        warnings.warn(
            f"texture '{texture.name}' of {width}x{height} is over the driver's {limit}: drawn at {size[0]}x{size[1]}",
            Notice,
            stacklevel=2,
        )
        pixels = np.asarray(Image.fromarray(pixels).resize(size, Image.Resampling.BOX))
        height, width = pixels.shape[:2]
    flipped = np.ascontiguousarray(pixels[::-1])  # GL's first row is the bottom one
    uploaded = gl.texture((width, height), 4, flipped.tobytes(), internal_format=GL_SRGB8_ALPHA8)
    refuse_exhaustion(f"texture '{texture.name}' of {width}x{height}")
    uploaded.build_mipmaps()
    uploaded.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    return uploaded
