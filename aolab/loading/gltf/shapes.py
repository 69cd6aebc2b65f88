"""The triangles of a glTF primitive: read, morphed, and bent by a skin."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from ...errors import FileError, SceneError
from ...input import TooLarge
from ..parts import Notes
from .accessors import Accessors
from .draco import decoded
from .nodes import Poses
from .schema import Gltf, Primitive

TRIANGLES, STRIP, FAN = 4, 5, 6
ALREADY = ("POSITION", "NORMAL")
NEEDED = ("POSITION", "JOINTS", "WEIGHTS")  # the beginnings of attributes without which nothing can be drawn
# written by `aolab.baking.write_glb`: the visibility of vertices, and their colour without it
OCCLUSION, COLOR = "_OCCLUSION", "_COLOR"


@dataclass
class Shape:
    """`vertices` (V, 3), `faces` (F, 3), `normals` (V, 3) or None, and the other attributes as the file names them."""

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray | None
    attributes: dict[str, np.ndarray]


class Shapes:
    """The primitives of a file as shapes."""

    def __init__(self, gltf: Gltf, accessors: Accessors, notes: Notes) -> None:
        self._gltf, self._accessors, self._notes = gltf, accessors, notes
        self._skins: dict[int, np.ndarray] = {}
        self._quantized = "KHR_mesh_quantization" in {*gltf.extensions_used, *gltf.extensions_required}

    def shape(self, primitive: Primitive, name: str, weights: tuple[float, ...], used: Collection[str]) -> Shape:
        """A primitive with its morph targets at `weights`, and with those of the attributes `used` that it has.

        Raises `SceneError`, with the primitive's `name`, for one without triangles, `FileError` for broken accessors.
        """
        if primitive.mode < TRIANGLES:
            raise SceneError(f"mesh '{name}' holds {'points' if primitive.mode == 0 else 'lines'}, no triangles")
        attributes, indices, mode = self._arrays(primitive, name, used)
        if "POSITION" not in attributes:
            raise SceneError(f"mesh '{name}' has no POSITION")
        vertices, normals = attributes["POSITION"], attributes.get("NORMAL")
        for target, weight in zip(primitive.targets, weights, strict=False):
            if not weight:  # an unused target may hold anything
                continue
            for attribute, accessor in target.items():
                if attribute in ALREADY:
                    delta = self._accessors.floats(accessor, "VEC3").astype(np.float64) * weight
                    if len(delta) != len(vertices):
                        raise SceneError(
                            f"mesh '{name}': a morph target moves {len(delta)} of {len(vertices)} vertices"
                        )
                    if attribute == "POSITION":
                        vertices = vertices + delta
                    elif normals is not None:
                        normals = normals + delta
        if indices is None:
            indices = np.arange(len(vertices))
        others = {key: value for key, value in attributes.items() if key not in ALREADY}
        if primitive.targets:
            others.pop("TANGENT", None)  # those of the shape at rest; new ones are made
        return Shape(vertices, triangles(indices, mode), normals, others)

    def _arrays(
        self, primitive: Primitive, name: str, used: Collection[str]
    ) -> tuple[dict[str, np.ndarray], np.ndarray | None, int]:
        """The attributes by name, the indices, if there are some, and the mode in which to take them.

        An attribute that cannot be read, and without which there is a shape, is left out with a note.
        """
        if primitive.extensions.draco is not None:
            arrays = decoded(self._gltf, self._accessors, primitive, name, self._notes)
            if arrays is not None:
                return *arrays, TRIANGLES
        attributes = {}
        for attribute, accessor in primitive.attributes.items():
            if attribute not in used:
                continue
            try:
                attributes[attribute] = self._attribute(attribute, accessor)
            except TooLarge:
                raise
            except FileError as error:
                if attribute.startswith(NEEDED):
                    raise
                self._notes.add(f"{attribute} of mesh ", f"'{name}'", f" was left out: {error}")
        indices = None
        if primitive.indices is not None:
            indices = self._accessors.stored(primitive.indices)
            if indices.ndim != 1 or indices.dtype.kind == "f":
                raise FileError(f"accessors[{primitive.indices}]: no list of whole numbers, as indices are")
        return attributes, indices, primitive.mode

    def _attribute(self, name: str, accessor: int) -> np.ndarray:
        kinds = _KINDS[name if name in (OCCLUSION, COLOR) else name.partition("_")[0]]
        if name.startswith("JOINTS"):
            return self._accessors.stored(accessor)
        # integers are fractions even where `normalized` was forgotten, unless the file may hold others
        fractions = name.startswith(("COLOR", "WEIGHTS")) or not self._quantized
        return self._accessors.floats(accessor, *kinds, fractions=fractions)

    def bent(self, shape: Shape, skin: int, poses: Poses, name: str) -> Shape:
        """The shape in world space, as its joints carry it; the node that holds it has no say (glTF 2.0, 3.7.3.3)."""
        if skin not in self._skins:
            self._skins[skin] = self._joint_matrices(skin, poses)
        matrices = self._skins[skin]
        sets = sorted(key for key in shape.attributes if key.startswith("JOINTS_"))
        sets = [key for key in sets if key.replace("JOINTS", "WEIGHTS") in shape.attributes]
        if not sets:
            raise SceneError(f"mesh '{name}' has a skin, but no JOINTS_0 and WEIGHTS_0")
        joints = np.concatenate([shape.attributes[key] for key in sets], axis=1).astype(np.int64)
        weights = np.concatenate([shape.attributes[key.replace("JOINTS", "WEIGHTS")] for key in sets], axis=1)
        if joints.shape != weights.shape or len(joints) != len(shape.vertices):
            raise SceneError(f"mesh '{name}': its joints and weights do not match its {len(shape.vertices)} vertices")
        joints = np.where(weights != 0, joints, 0)
        if joints.size and not 0 <= joints.min() <= joints.max() < len(matrices):
            raise SceneError(f"mesh '{name}' names joint {joints.max()} of {len(matrices)}")
        weights = weights.astype(np.float64)
        total = weights.sum(axis=1, keepdims=True)
        weights[total[:, 0] == 0, 0] = 1  # a vertex that no joint carries stays with the first
        blend = np.zeros((len(joints), 3, 4))
        for joint, weight in zip(joints.T, (weights / np.where(total == 0, 1, total)).T, strict=True):
            blend += weight[:, None, None] * matrices[joint, :3]
        vertices = np.einsum("vij,vj->vi", blend[..., :3], shape.vertices.astype(np.float64)) + blend[..., 3]
        normals = None
        if shape.normals is not None:
            a, b, c = np.moveaxis(blend[..., :3], 2, 0)
            cofactor = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=2)
            normals = np.einsum("vij,vj->vi", cofactor, shape.normals.astype(np.float64))
        attributes = {key: value for key, value in shape.attributes.items() if key != "TANGENT"}  # made anew
        return Shape(vertices, shape.faces, normals, attributes)

    def _joint_matrices(self, skin: int, poses: Poses) -> np.ndarray:
        """(joints, 4, 4): world_from_mesh of each joint."""
        joints, accessor = self._gltf.skins[skin].joints, self._gltf.skins[skin].inverse_bind_matrices
        world = np.array([poses.world[joint] for joint in joints]).reshape(-1, 4, 4)
        if accessor is None:
            return world
        inverse = self._accessors.floats(accessor, "MAT4").astype(np.float64)
        if len(inverse) < len(joints):
            raise FileError(f"skins[{skin}]: {len(inverse)} inverse bind matrices for {len(joints)} joints")
        return world @ inverse[: len(joints)]


# the attributes that are read, by the beginning of their names, and their types
_KINDS = {
    "POSITION": ("VEC3",),
    "NORMAL": ("VEC3",),
    "TANGENT": ("VEC4",),
    "TEXCOORD": ("VEC2",),
    "COLOR": ("VEC3", "VEC4"),
    "JOINTS": ("VEC4",),
    "WEIGHTS": ("VEC4",),
    OCCLUSION: ("SCALAR",),
    COLOR: ("VEC4",),
}


def triangles(indices: np.ndarray, mode: int) -> np.ndarray:
    """(F, 3) from the indices of triangles, a strip or a fan. One or two indices left over at the end are dropped."""
    indices = indices.astype(np.int64)
    if mode == TRIANGLES:
        return indices[: len(indices) // 3 * 3].reshape(-1, 3)
    if len(indices) < 3:
        return np.zeros((0, 3), np.int64)
    if mode == FAN:
        return np.column_stack([np.full(len(indices) - 2, indices[0]), indices[1:-1], indices[2:]])
    faces = np.column_stack([indices[:-2], indices[1:-1], indices[2:]])
    faces[1::2] = faces[1::2, ::-1]  # every second one runs the other way round
    return faces
