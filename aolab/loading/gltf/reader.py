"""glTF 2.0, `.glb` and `.gltf`: the parts, lights and camera of the default scene."""

from pathlib import Path

import numpy as np

from ...errors import FileError, SceneError
from ...input import TooLarge
from ...scene.camera import Camera
from ..folder import Folder
from ..options import FileOptions
from ..parts import Content, Notes, Part, Placed
from ..placing import camera_at
from .accessors import Accessors
from .container import Buffers, read_json
from .lights import lights_of, suited
from .materials import Materials
from .nodes import Poses, moved_at, nodes_in_scene, transform
from .schema import Gltf, Primitive, checked, unread
from .shapes import ALREADY, COLOR, OCCLUSION, Shapes

JOINED = ("JOINTS_", "WEIGHTS_")  # the attributes of a skin
INSTANCED = {"TRANSLATION": ("VEC3",), "ROTATION": ("VEC4",), "SCALE": ("VEC3",)}


def read(data: bytes, path: Path, folder: Folder, options: FileOptions, root: np.ndarray) -> Content:
    """The default scene of a glTF file, under the pose `root`. Raises `FileError`, and `ParameterError` for options."""
    return _Reader(data, path, folder, options, root).content()


class _Reader:
    def __init__(self, data: bytes, path: Path, folder: Folder, options: FileOptions, root: np.ndarray) -> None:
        json, binary = read_json(data, path)
        self.gltf: Gltf = checked(json)
        self.nodes = nodes_in_scene(self.gltf)
        self.notes, self.left_out = Notes(), list[str]()
        buffers = Buffers(self.gltf, binary, folder, self.notes)
        self.accessors = Accessors(self.gltf, buffers, folder.budget)
        self.materials = Materials(self.gltf, buffers, folder, self.notes)
        self.shapes = Shapes(self.gltf, self.accessors, self.notes)
        self.broken: list[FileError] = []
        moved = moved_at(self.gltf, self.accessors, options.time, options.animation)
        self.poses, self.root = Poses(self.gltf, root, moved), root

    def content(self) -> Content:
        placed = self.placed()
        lights = suited(lights_of(self.gltf, self.nodes, self.poses, self.notes), placed, self.notes)
        if not placed and self.broken:
            raise self.broken[0]
        content = Content(placed, lights, self.camera(), left_out=self.left_out, notes=self.notes)
        if names := unread(self.gltf):
            self.notes.add(f"read, but not used: {', '.join(names)}")
        return content

    def placed(self) -> list[Placed]:
        """The primitives of each node; nodes with the same mesh, the same weights and no skin share the part."""
        found: dict[tuple[object, ...], Part | None] = {}
        placed = []
        for node in self.nodes:
            source = self.gltf.nodes[node]
            if source.mesh is None:
                continue
            mesh = self.gltf.meshes[source.mesh]
            weights = tuple(self.poses.weights.get(node, source.weights or mesh.weights or ()))
            name = mesh.name or f"mesh {source.mesh}"
            try:
                placements = self._placements(node)
            except TooLarge:
                raise
            except FileError as error:
                self._leave_out(f"node '{self.gltf.node_name(node)}'", error)
                continue
            for number, primitive in enumerate(mesh.primitives):
                key = (source.mesh, number, weights, None if source.skin is None else node)
                if key not in found:
                    found[key] = self._part(primitive, f"{name} {number}" if number else name, weights, source.skin)
                part = found[key]
                if part is not None:
                    placed += [Placed(part, pose, title) for pose, title in placements]
        return placed

    def _part(self, primitive: Primitive, name: str, weights: tuple[float, ...], skin: int | None) -> Part | None:
        """None for a primitive without triangles, which is told as left out."""
        color = COLOR if OCCLUSION in primitive.attributes else "COLOR_0"
        material, uv = self.materials.material(primitive.material, colored=color in primitive.attributes)
        used = {*ALREADY, OCCLUSION, color, f"TEXCOORD_{uv.set}"}
        used |= {"TANGENT"} if material.normal_texture is not None else set()
        used |= {key for key in primitive.attributes if key.startswith(JOINED)} if skin is not None else set()
        try:
            shape = self.shapes.shape(primitive, name, weights, used)
            if skin is not None:
                shape = self.shapes.bent(shape, skin, self.poses, name)
        except SceneError as error:
            self.left_out.append(str(error))
            return None
        except TooLarge:
            raise
        except FileError as error:
            self._leave_out(f"mesh '{name}'", error)
            return None
        visibility = shape.attributes.get(OCCLUSION)
        visibility = None if visibility is None else visibility.reshape(-1, 1)
        colors = shape.attributes.get(color)
        if colors is not None and colors.shape[1] == 3:
            colors = np.column_stack([colors, np.ones(len(colors), np.float32)])
        tangents = shape.attributes.get("TANGENT")
        coordinates = uv.of(shape.attributes)
        return Part(
            shape.vertices, shape.faces, shape.normals, coordinates, colors, material, name, tangents, visibility
        )

    def _leave_out(self, part: str, error: FileError) -> None:
        self.broken.append(error)
        self.left_out.append(f"{part}: {error}")

    def _placements(self, node: int) -> list[tuple[np.ndarray, str]]:
        """Where the node's mesh stands: once, or once an instance (EXT_mesh_gpu_instancing)."""
        source, name = self.gltf.nodes[node], self.gltf.node_name(node)
        if source.skin is not None:  # its joints have placed it
            return [(np.eye(4), name)]
        pose, instancing = self.poses.world[node], source.extensions.instancing
        if instancing is None:
            return [(pose, name)]
        arrays = {
            key: self.accessors.floats(index, *INSTANCED[key]).astype(np.float64)
            for key, index in instancing.attributes.items()
            if key in INSTANCED
        }
        count = {len(array) for array in arrays.values()}
        if len(count) > 1:
            raise FileError(f"nodes[{node}]: its instances' attributes have {' and '.join(map(str, count))} elements")
        return [
            (pose @ transform(**{key.lower(): array[number] for key, array in arrays.items()}), f"{name} {number}")
            for number in range(count.pop() if count else 0)
        ]

    def camera(self) -> Camera | None:
        """The first camera that can be used; None, with a note, if others cannot."""
        for node in self.nodes:
            index = self.gltf.nodes[node].camera
            if index is None:
                continue
            camera = self.gltf.cameras[index]
            lens = camera.perspective or camera.orthographic
            try:
                if lens is None:
                    raise SceneError(f"camera: it lacks '{camera.type}'")
                view = {"near": lens.znear or None, "far": lens.zfar}
                if camera.orthographic is not None:
                    return camera_at(self.poses.world[node], ortho=2 * abs(camera.orthographic.ymag), **view)
                assert camera.perspective is not None
                return camera_at(self.poses.world[node], fov=float(np.degrees(camera.perspective.yfov)), **view)
            except SceneError as error:
                name = f"'{camera.name or self.gltf.node_name(node)}'"
                self.notes.add("camera ", name, f" cannot be used: {str(error).removeprefix('camera: ')}")
        return None
