"""A small glTF file of each feature, drawn by aolab, against a rasteriser that shares no code with it."""

import math

import numpy as np
import pytest
from gltf_file import GltfFile
from PIL import Image
from rasteriser import Triangles, draw

import aolab
from aolab.errors import Notice

SIZE = (48, 32)
EYE = np.eye(4)
EYE[2, 3] = 6.0
FOV = 40.0
# lopsided, in depth too, so that nothing turned or mirrored passes
CORNERS = np.array([(-1.0, -1.0, 0.0), (1.2, -0.8, 0.4), (-0.5, 1.0, -0.3)])
SQUARE = np.array([(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (-1.0, 1.0, 0.0)])
SQUARE_UV = np.array([(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)])  # v downwards
TWO = np.array([0, 1, 2, 0, 2, 3])
WHITE = np.ones((1, 1, 3))
FEATURES = {}


def feature(function):
    """A function that fills a file and returns what a picture of it has to show."""
    FEATURES[function.__name__] = function
    return function


class File(GltfFile):
    """The file with a camera, and the lopsided triangle in node 0."""

    def __init__(self, folder):
        super().__init__(folder)
        self.header["accessors"].clear()
        self.load = {}
        self.camera = {"fov": FOV}
        self.header["cameras"] = [{"type": "perspective", "perspective": {"yfov": math.radians(FOV), "znear": 0.01}}]
        self.header["nodes"] = [{"mesh": 0}, {"camera": 0, "matrix": EYE.T.reshape(-1).tolist()}]
        self.header["scenes"] = [{"nodes": [0, 1]}]
        self.positions(CORNERS)

    def positions(self, values, indices=None):
        self.attribute("POSITION", np.asarray(values, np.float32))
        if indices is not None:
            self.header["meshes"][0]["primitives"][0]["indices"] = self.accessor(np.asarray(indices, np.uint16))

    @property
    def primitive(self):
        return self.header["meshes"][0]["primitives"][0]

    def node(self, **more):
        self.header["nodes"][0].update(more)

    def textured(self, pixels, sampler=None, uv=SQUARE_UV, **material):
        """A square of the given texture, from (-1, -1) to (1, 1)."""
        self.positions(SQUARE, TWO)
        self.attribute("TEXCOORD_0", np.asarray(uv, np.float32))
        path = self.folder / "texture.png"
        Image.fromarray(np.asarray(pixels, np.uint8)).save(path)
        self.image(uri="texture.png")
        self.header["materials"][0].update(material)
        if sampler is not None:
            self.header["samplers"], self.header["textures"][0]["sampler"] = [sampler], 0

    def animated(self, path, times, values, interpolation="LINEAR", node=0):
        inputs, outputs = (self.accessor(np.asarray(array, np.float32)) for array in (times, values))
        self.header["animations"] = [{
            "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
            "samplers": [{"input": inputs, "output": outputs, "interpolation": interpolation}],
        }]  # fmt: skip


def one(corners=CORNERS, matrix=None, **look):
    """Expected: a triangle, or several (T, 3, 3), moved by `matrix`."""
    corners = np.asarray(corners, float).reshape(-1, 3, 3)
    if matrix is not None:
        corners = corners @ matrix[:3, :3].T + matrix[:3, 3]
    return Triangles(corners, **look)


def square(texel, uv=SQUARE_UV, **look):
    return Triangles(SQUARE[TWO].reshape(-1, 3, 3), WHITE, np.asarray(uv)[TWO].reshape(-1, 3, 2), texel, **look)


def moved(x=0.0, y=0.0, z=0.0, linear=None):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    if linear is not None:
        matrix[:3, :3] = linear
    return matrix


def about_z(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([(c, -s, 0), (s, c, 0), (0, 0, 1)])


def turn_z(degrees):
    """A quaternion."""
    return [0, 0, math.sin(math.radians(degrees) / 2), math.cos(math.radians(degrees) / 2)]


# --- geometry


@feature
def triangle(file):
    return one()


@feature
def indices_of_bytes(file):
    file.primitive["indices"] = file.accessor(np.array([2, 0, 1], np.uint8))
    return one()


@feature
def indices_of_32_bits(file):
    file.primitive["indices"] = file.accessor(np.array([1, 2, 0], np.uint32))
    return one()


@feature
def triangle_strip(file):
    file.positions([SQUARE[0], SQUARE[1], SQUARE[3], SQUARE[2]])
    file.primitive["mode"] = 5
    return one(SQUARE[TWO])


@feature
def triangle_fan(file):
    file.positions(SQUARE)
    file.primitive["mode"] = 6
    return one(SQUARE[TWO])


@feature
def interleaved_attributes(file):
    rows = np.column_stack([CORNERS, np.tile([0.0, 0.6, 0.8], (3, 1))]).astype(np.float32)
    view = file.view(rows.tobytes())
    file.header["bufferViews"][view]["byteStride"] = 24
    for offset, name in ((0, "POSITION"), (12, "NORMAL")):
        accessor = {"bufferView": view, "byteOffset": offset, "componentType": 5126, "count": 3, "type": "VEC3"}
        file.header["accessors"].append(accessor)
        file.primitive["attributes"][name] = len(file.header["accessors"]) - 1
    return one()


@feature
def sparse_positions(file):
    index = file.accessor(np.add(CORNERS, [(0, 0, 0), (9, 9, 9), (0, 0, 0)]).astype(np.float32))
    places, values = file.view(np.array([1], np.uint16).tobytes()), file.view(CORNERS[1].astype("f4").tobytes())
    file.header["accessors"][index]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": places, "componentType": 5123},
        "values": {"bufferView": values},
    }
    file.primitive["attributes"]["POSITION"] = index
    return one()


@feature
def sparse_positions_without_a_base(file):
    corners = CORNERS - CORNERS[0]
    places = file.view(np.array([1, 2], np.uint8).tobytes())
    values = file.view(corners[1:].astype("f4").tobytes())
    sparse = {
        "count": 2,
        "indices": {"bufferView": places, "componentType": 5121},
        "values": {"bufferView": values},
    }
    file.header["accessors"].append({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": sparse})
    file.primitive["attributes"]["POSITION"] = len(file.header["accessors"]) - 1
    return one(corners)


@feature
def quantized_positions(file):
    stored = np.round(CORNERS / 2 * 32767).astype(np.int16)
    view = file.view(np.column_stack([stored, np.zeros(3, np.int16)]).tobytes())
    file.header["bufferViews"][view]["byteStride"] = 8
    accessor = {"bufferView": view, "componentType": 5122, "normalized": True, "count": 3, "type": "VEC3"}
    file.header["accessors"].append(accessor)
    file.primitive["attributes"]["POSITION"] = len(file.header["accessors"]) - 1
    file.header["extensionsUsed"] = file.header["extensionsRequired"] = ["KHR_mesh_quantization"]
    file.node(scale=[2, 2, 2])
    return one()


@feature
def compressed_by_draco(file):
    DracoPy = pytest.importorskip("DracoPy", reason="the extra draco")
    data = DracoPy.encode(CORNERS.astype(np.float32), np.array([[0, 1, 2]], np.uint32), quantization_bits=20)
    identity = DracoPy.decode(data).attributes[0]["unique_id"]
    draco = {"bufferView": file.view(data), "attributes": {"POSITION": identity}}
    file.header["accessors"].append({"componentType": 5126, "count": 3, "type": "VEC3"})
    file.primitive["attributes"]["POSITION"] = len(file.header["accessors"]) - 1
    file.primitive["extensions"] = {"KHR_draco_mesh_compression": draco}
    file.header["extensionsUsed"] = file.header["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    return one()


def meshopt_view(file, stride, count, mode, data, **more):
    """The index of a bufferView whose own bytes are in a buffer without data."""
    compressed = {**file.header["bufferViews"][file.view(data)], "byteStride": stride, "count": count, "mode": mode}
    extension = {"EXT_meshopt_compression": {**compressed, **more}}
    file.header["bufferViews"].append({"buffer": 1, "byteLength": stride * count, "extensions": extension})
    file.more_buffers = [{"byteLength": 1000, "extensions": {"EXT_meshopt_compression": {"fallback": True}}}]
    file.header["extensionsUsed"] = file.header["extensionsRequired"] = ["EXT_meshopt_compression"]
    return len(file.header["bufferViews"]) - 1


def meshopt_triangle(file, indices, mode, version, **more):
    meshopt = pytest.importorskip("meshopt", reason="the extra meshopt")
    corners = CORNERS.astype(np.float32)
    rows = meshopt.encode_filter_exp(corners, 24) if more else corners
    attributes = meshopt.encode_gltf_buffer(rows, "ATTRIBUTES", version)
    places = meshopt.encode_gltf_buffer(np.array(indices, np.uint16), mode)
    file.header["accessors"] = [
        {"bufferView": meshopt_view(file, 12, 3, "ATTRIBUTES", attributes, **more),
         "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": meshopt_view(file, 2, len(indices), mode, places),
         "componentType": 5123, "count": len(indices), "type": "SCALAR"},
    ]  # fmt: skip
    file.primitive["attributes"]["POSITION"], file.primitive["indices"] = 0, 1
    return one()


@feature
def compressed_by_meshopt(file):
    return meshopt_triangle(file, [1, 2, 0], "TRIANGLES", 0)


@feature
def compressed_by_meshopt_with_a_filter_in_version_1(file):
    file.primitive["mode"] = 5
    return meshopt_triangle(file, [2, 0, 1], "INDICES", 1, filter="EXPONENTIAL")


# --- nodes


@feature
def matrix_of_a_node(file):
    matrix = moved(0.3, -0.2, -1, about_z(30) * (1.2, 0.8, 1))
    file.node(matrix=matrix.T.reshape(-1).tolist())
    return one(matrix=matrix)


@feature
def translation_rotation_scale(file):
    file.node(translation=[0.3, -0.2, -1], rotation=turn_z(30), scale=[1.2, 0.8, 1])
    return one(matrix=moved(0.3, -0.2, -1, about_z(30) * (1.2, 0.8, 1)))


@feature
def node_in_a_node(file):
    file.header["nodes"].append({"children": [0], "rotation": turn_z(90)})
    file.header["scenes"] = [{"nodes": [2, 1]}]
    file.node(translation=[0.5, 0, 0])
    return one(matrix=moved(linear=about_z(90)) @ moved(0.5))


@feature
def mirrored_node(file):
    file.node(scale=[-1, 1, 1])
    return one(matrix=np.diag([-1.0, 1, 1, 1]))


@feature
def one_mesh_in_two_nodes(file):
    file.header["nodes"].append({"mesh": 0, "translation": [1, 0.5, -3], "scale": [0.5] * 3})
    file.header["scenes"][0]["nodes"].append(2)
    return one(np.stack([CORNERS, CORNERS * 0.5 + (1, 0.5, -3)]))


@feature
def instances_of_a_node(file):
    places, sizes = np.array([(-1.0, 0, 0), (0.8, 0.2, -2)]), np.array([(0.5, 0.5, 0.5), (1.0, 0.5, 1.0)])
    file.node(
        translation=[0, 0.25, 0],
        extensions={
            "EXT_mesh_gpu_instancing": {
                "attributes": {
                    "TRANSLATION": file.accessor(places.astype("f4")),
                    "ROTATION": file.accessor(np.array([turn_z(0), turn_z(45)], "f4")),
                    "SCALE": file.accessor(sizes.astype("f4")),
                    "_ID": file.accessor(np.arange(2, dtype="f4")),
                }
            }
        },
    )
    file.header["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    turned = [CORNERS * sizes[0], (CORNERS * sizes[1]) @ about_z(45).T]
    return one(np.stack([each + place + (0, 0.25, 0) for each, place in zip(turned, places, strict=True)]))


@feature
def node_without_extent_beside_another(file):
    file.header["nodes"].append({"mesh": 0, "scale": [0, 0, 0], "name": "hidden"})
    file.header["scenes"][0]["nodes"].append(2)
    file.note = "left out: instance 'hidden': its transform is singular"
    return one()


@feature
def empty_primitive_beside_another(file):
    file.header["meshes"][0]["primitives"].append({"attributes": {"POSITION": file.accessor(np.zeros((0, 3), "f4"))}})
    file.note = "left out: mesh 'triangle 1' is empty"
    return one()


@feature
def lines_beside_triangles(file):
    file.header["meshes"][0]["primitives"].append({**file.primitive, "mode": 1})
    file.note = "left out: mesh 'triangle 1' holds lines, no triangles"
    return one()


def broken(file, kind):
    """An accessor that reaches far beyond its buffer view."""
    file.header["accessors"].append({"bufferView": 0, "componentType": 5126, "count": 900, "type": kind})
    return len(file.header["accessors"]) - 1


@feature
def broken_attributes_that_nothing_uses(file):
    for name, kind in (("TANGENT", "VEC4"), ("TEXCOORD_3", "VEC2"), ("COLOR_1", "VEC4"), ("JOINTS_0", "VEC4")):
        file.primitive["attributes"][name] = broken(file, kind)
    return one()


@feature
def broken_normals(file):
    file.primitive["attributes"]["NORMAL"] = broken(file, "VEC3")
    file.note = "NORMAL of mesh 'triangle' was left out: accessors.1.: its 900 elements end at byte"
    return one()


@feature
def mesh_of_broken_positions_beside_another(file):
    file.header["meshes"].append(
        {"name": "damaged", "primitives": [{"attributes": {"POSITION": broken(file, "VEC3")}}]}
    )
    file.header["nodes"].append({"mesh": 1})
    file.header["scenes"][0]["nodes"].append(2)
    file.note = "left out: mesh 'damaged': accessors.1.: its 900 elements end at byte"
    return one()


@feature
def colours_and_uv_that_are_not_finite(file):
    file.attribute("COLOR_0", np.array([(1, 1, 1), (np.nan, 1, 1), (1, 1, 1)], np.float32))
    file.attribute("TEXCOORD_0", np.full((3, 2), np.inf, np.float32))
    file.note = "left out: uv of mesh 'triangle', of which 3 are not finite; colors of mesh 'triangle', of which 1 "
    return one(colors=WHITE)


@feature
def colours_beyond_one(file):
    file.attribute("COLOR_0", np.array([(2, -1, 0.5)] * 3, np.float32))
    file.note = "the colours of mesh 'triangle' are outside"
    return one(colors=np.array([[(1, 0, 0.5)]]))


@feature
def nodes_that_are_not_visible(file):
    """With all below them (KHR_node_visibility)."""
    file.header["nodes"] += [
        {"children": [3], "extensions": {"KHR_node_visibility": {"visible": False}}},
        {"mesh": 0, "translation": [0.5, 0, 0]},
    ]
    file.header["scenes"][0]["nodes"].append(2)
    file.header["extensionsUsed"] = ["KHR_node_visibility"]
    return one()


@feature
def z_up(file):
    y_from_z = np.array([(1.0, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)])
    for node, pose in ((0, moved(0.2, 0.1)), (1, EYE)):
        file.header["nodes"][node]["matrix"] = (np.linalg.inv(y_from_z) @ pose).T.reshape(-1).tolist()
    file.load = {"up_axis": "z"}
    return one(matrix=moved(0.2, 0.1))


# --- skins, morph targets, animations


def skinned(file):
    """Joint 2 carries the lower corners, joint 3 the upper one; the mesh's own node has a scale that has no effect."""
    file.attribute("JOINTS_0", np.array([(0, 0, 0, 0), (0, 0, 0, 0), (1, 0, 0, 0)], np.uint8))
    file.attribute("WEIGHTS_0", np.array([(1, 0, 0, 0)] * 3, np.float32))
    view = file.view(np.stack([np.eye(4), moved(-0.5)]).transpose(0, 2, 1).astype("f4").tobytes())
    file.header["accessors"].append({"bufferView": view, "componentType": 5126, "count": 2, "type": "MAT4"})
    file.header["skins"] = [{"joints": [2, 3], "inverseBindMatrices": len(file.header["accessors"]) - 1}]
    file.header["nodes"] += [{"translation": [0.2, 0, 0], "children": [3]}, {"translation": [0.5, 0.3, 0]}]
    file.header["scenes"] = [{"nodes": [0, 1, 2]}]
    file.node(skin=0, scale=[50, 50, 50])
    return np.add(CORNERS, [(0.2, 0, 0), (0.2, 0, 0), (0.2 + 0.5 - 0.5, 0.3, 0)])


@feature
def skin_at_rest(file):
    return one(skinned(file))


@feature
def skin_of_an_animated_joint(file):
    corners = skinned(file)
    file.animated("translation", [0, 2], [(0.5, 0.3, 0), (0.5, -0.7, 0)], node=3)
    file.load = {"time": 1.0}
    corners[2] += (0, -0.5, 0)
    return one(corners)


@feature
def weights_that_do_not_add_up_to_one(file):
    corners = skinned(file)
    file.attribute("WEIGHTS_0", np.array([(2, 0, 0, 0)] * 3, np.float32))
    return one(corners)


def morphed(file):
    file.primitive["targets"] = [
        {"POSITION": file.accessor(np.array([(0, 0, 0), (0, 0, 0), (0.8, 0, 0)], "f4"))},
        {"POSITION": file.accessor(np.array([(0, -0.4, 0), (0, 0, 0), (0, 0, 0)], "f4"))},
    ]


@feature
def default_weights_of_morph_targets(file):
    morphed(file)
    file.header["meshes"][0]["weights"] = [0.5, 0.25]
    return one(np.add(CORNERS, [(0, -0.1, 0), (0, 0, 0), (0.4, 0, 0)]))


@feature
def weights_of_a_node(file):
    morphed(file)
    file.header["meshes"][0]["weights"] = [1, 1]
    file.node(weights=[0.5, 0.0])
    return one(np.add(CORNERS, [(0, 0, 0), (0, 0, 0), (0.4, 0, 0)]))


@feature
def animated_weights(file):
    morphed(file)
    file.animated("weights", [0, 1], [0, 0, 1, 0.5])
    file.load = {"time": 0.5}
    return one(np.add(CORNERS, [(0, -0.1, 0), (0, 0, 0), (0.4, 0, 0)]))


@feature
def unread_morph_target(file):
    """Nothing of a target with the weight 0 is looked at, and this one is broken."""
    file.header["accessors"].append({"bufferView": 0, "componentType": 5126, "count": 900, "type": "VEC3"})
    file.primitive["targets"] = [{"POSITION": len(file.header["accessors"]) - 1}]
    return one()


@feature
def spherical_rotation(file):
    """The shorter way round, although the second quaternion has the other sign."""
    file.animated("rotation", [0, 1], [turn_z(0), [-part for part in turn_z(80)]])
    file.load = {"time": 0.25}
    return one(matrix=moved(linear=about_z(20)))


@feature
def animated_scale(file):
    file.animated("scale", [0, 1], [(1, 1, 1), (0.5, 1.5, 1)])
    file.load = {"time": 7.0}  # behind the last key
    return one(matrix=np.diag([0.5, 1.5, 1, 1]))


TIMES = (0.0, 1.0, 3.0)
ROWS = {
    "translation": [(0, 0, 0), (0.5, 0.2, -0.5), (-0.3, 0.1, 0.2)],
    "rotation": [turn_z(0), turn_z(100), turn_z(-60)],
    "scale": [(1, 1, 1), (0.5, 1.2, 1), (1.3, 0.7, 1)],
    "weights": [(0, 0), (1, 0.5), (0.2, 0.8)],
}
SLOPES = np.random.default_rng(3).normal(scale=0.3, size=(3, 2, 4))  # into and out of each key


def animation(path, interpolation):
    """A feature: the triangle at 1.8 seconds, 0.4 of the way from the second key to the last."""

    def feature(file):
        rows, share = np.array(ROWS[path], float), 0.4
        slopes = SLOPES[..., : rows.shape[1]]
        value = {"STEP": rows[1], "LINEAR": 0.6 * rows[1] + 0.4 * rows[2]}.get(interpolation)
        if value is None:  # the basis of Hermite; slopes are per second, and the span is 2 seconds
            basis = np.array([(2, -2, 1, 1), (-3, 3, -2, -1), (0, 0, 1, 0), (1, 0, 0, 0)])
            powers = np.array([share**3, share**2, share, 1])
            value = powers @ basis @ np.stack([rows[1], rows[2], 2 * slopes[1, 1], 2 * slopes[2, 0]])
        elif path == "rotation" and interpolation == "LINEAR":
            value = np.array(turn_z(100 - 0.4 * 160))
        stored = rows if interpolation != "CUBICSPLINE" else np.stack([slopes[:, 0], rows, slopes[:, 1]], axis=1)
        if path == "weights":
            morphed(file)
            stored = stored.reshape(-1)
        file.animated(path, TIMES, stored.reshape(-1, rows.shape[1]) if path != "weights" else stored, interpolation)
        file.load = {"time": 1.8}
        if path == "weights":
            return one(np.add(CORNERS, [(0, -0.4 * value[1], 0), (0, 0, 0), (0.8 * value[0], 0, 0)]))
        if path == "rotation":
            return one(matrix=moved(linear=turned_by(value / np.linalg.norm(value))))
        return one(matrix=moved(*value) if path == "translation" else np.diag([*value, 1]))

    return feature


def turned_by(quaternion):
    """The rotation as Rodrigues states it: axis and angle."""
    angle, axis = 2 * np.arccos(quaternion[3]), quaternion[:3] / np.linalg.norm(quaternion[:3])
    x, y, z = axis
    cross = np.array([(0, -z, y), (z, 0, -x), (-y, x, 0)])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


for _path in ROWS:
    for _interpolation in ("LINEAR", "STEP", "CUBICSPLINE"):
        FEATURES[f"{_path} {_interpolation}"] = animation(_path, _interpolation)


@feature
def animation_by_name(file):
    file.animated("translation", [0], [(5, 5, 0)])
    other = dict(file.header["animations"][0])
    file.animated("translation", [0], [(0.4, 0, 0)])
    file.header["animations"] = [other, {**file.header["animations"][0], "name": "walk"}]
    file.load = {"animation": "walk"}
    return one(matrix=moved(0.4))


@feature
def rest_without_a_time(file):
    file.animated("translation", [0, 1], [(5, 5, 0), (6, 6, 0)])
    return one()


# --- materials


@feature
def base_colour(file):
    file.material(pbrMetallicRoughness={"baseColorFactor": [0.9, 0.5, 0.1, 1]})
    return one(colors=np.array([[(0.9, 0.5, 0.1)]]))


@feature
def diffuse_of_specular_glossiness(file):
    glossy = {"diffuseFactor": [0.2, 0.7, 0.4, 1]}
    file.material(extensions={"KHR_materials_pbrSpecularGlossiness": glossy})
    file.header["extensionsUsed"] = ["KHR_materials_pbrSpecularGlossiness"]
    return one(colors=np.array([[(0.2, 0.7, 0.4)]]))


@feature
def colours_of_bytes(file):
    file.attribute("COLOR_0", np.array([(255, 0, 0, 255), (0, 255, 0, 255), (0, 0, 255, 255)], np.uint8))
    file.header["accessors"][-1]["normalized"] = True
    return one(colors=np.eye(3)[None])


@feature
def colours_times_base_colour(file):
    file.attribute("COLOR_0", np.array([(1, 0.2, 0.4), (0.3, 1, 0.2), (0.5, 0.5, 1)], np.float32))
    file.material(pbrMetallicRoughness={"baseColorFactor": [0.5, 1, 0.25, 1]})
    colors = np.array([(1, 0.2, 0.4), (0.3, 1, 0.2), (0.5, 0.5, 1)]) * (0.5, 1, 0.25)
    return one(colors=colors[None])


# 255 and 0 are the same in sRGB and linear: the rasteriser needs no transfer curve
CHECKS = np.array([[(255, 0, 0, 255), (0, 255, 0, 255)], [(0, 0, 255, 255), (255, 255, 255, 255)]])


def nearest(pixels, wrap_u=np.mod, wrap_v=np.mod):
    """The texel at u, v; how to bring a coordinate into [0, 1)."""
    height, width = pixels.shape[:2]

    def texel(u, v):
        row, column = int(wrap_v(v, 1.0) * height), int(wrap_u(u, 1.0) * width)
        return pixels[min(row, height - 1), min(column, width - 1), :3] / 255

    return texel


def clamp(value, _):
    return min(max(value, 0.0), 1.0)


def mirror(value, _):
    return abs((value + 1) % 2 - 1)


NEAREST = {"magFilter": 9728, "minFilter": 9728}


@feature
def texture_of_nearest_texels(file):
    file.textured(CHECKS, NEAREST)
    return square(nearest(CHECKS))


@feature
def texture_between_texels(file):
    """Between the centres of two texels a colour is their mean by distance; beyond, it is the texel's at the edge."""
    ramp = np.array([[(0, 0, 0, 255), (255, 255, 255, 255)]])
    file.textured(ramp, {"wrapS": 33071, "wrapT": 33071, "minFilter": 9729})
    return square(lambda u, _v: np.full(3, np.clip(2 * u - 0.5, 0, 1)))


@feature
def second_set_of_uv(file):
    file.textured(CHECKS, NEAREST)
    file.attribute("TEXCOORD_0", np.zeros((4, 2), np.float32))
    file.attribute("TEXCOORD_1", SQUARE_UV.astype(np.float32))
    file.header["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1
    return square(nearest(CHECKS))


WIDE = SQUARE_UV * 3 - 1  # from -1 to 2


@feature
def texture_repeated(file):
    file.textured(CHECKS, NEAREST, WIDE)
    return square(nearest(CHECKS), WIDE)


@feature
def texture_clamped(file):
    file.textured(CHECKS, {**NEAREST, "wrapS": 33071, "wrapT": 33071}, WIDE)
    return square(nearest(CHECKS, clamp, clamp), WIDE)


@feature
def texture_mirrored_in_u_and_clamped_in_v(file):
    file.textured(CHECKS, {**NEAREST, "wrapS": 33648, "wrapT": 33071}, WIDE)
    return square(nearest(CHECKS, mirror, clamp), WIDE)


@feature
def texture_moved_and_scaled(file):
    transform = {"offset": [0.25, 0.5], "scale": [0.5, 2.0]}
    file.textured(CHECKS, NEAREST)
    info = file.header["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    info["extensions"] = {"KHR_texture_transform": transform}
    file.header["extensionsUsed"] = ["KHR_texture_transform"]
    return square(nearest(CHECKS), SQUARE_UV * (0.5, 2.0) + (0.25, 0.5))


@feature
def texture_turned(file):
    """The example of the extension: the lower left quadrant of the image, rotated clockwise by 90 degrees."""
    quarter = np.array([(0.0, 0.5), (0.0, 1.0), (0.5, 1.0), (0.5, 0.5)])  # of the corners of `SQUARE_UV`
    pixels = np.zeros((4, 4, 4), np.uint8)
    pixels[2:, :2] = CHECKS
    pixels[..., 3] = 255
    file.textured(pixels, NEAREST)
    info = file.header["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    transform = {"offset": [0, 1], "rotation": math.pi / 2, "scale": [0.5, 0.5]}
    info["extensions"] = {"KHR_texture_transform": transform}
    file.header["extensionsUsed"] = ["KHR_texture_transform"]
    turned = {tuple(uv): tuple(place) for uv, place in zip(SQUARE_UV, _turned(SQUARE_UV), strict=True)}
    assert sorted(turned.values()) == sorted(map(tuple, quarter))
    return square(nearest(pixels), [turned[tuple(uv)] for uv in SQUARE_UV])


def _turned(uv):
    """Which corner of the lower left quadrant each corner shows: the image's own lower left is at the upper left."""
    return [
        {(0, 0): (0.0, 1.0), (1, 0): (0.0, 0.5), (1, 1): (0.5, 0.5), (0, 1): (0.5, 1.0)}[tuple(p)]
        for p in uv.astype(int)
    ]


@feature
def cut_out(file):
    holes = CHECKS.copy()
    holes[0, 1, 3] = 100
    file.textured(holes, NEAREST, alphaMode="MASK", alphaCutoff=0.5)
    colour = nearest(CHECKS)
    return square(lambda u, v: None if u > 0.5 and v < 0.5 else colour(u, v))


@feature
def single_sided(file):
    """A red triangle behind a black one that is seen from its back."""
    front = CORNERS[::-1] * 1.1 + (0, 0, 1)
    file.header["meshes"].append(
        {"primitives": [{"attributes": {"POSITION": file.accessor(front.astype("f4"))}, "material": 1}]}
    )
    file.material(pbrMetallicRoughness={"baseColorFactor": [0.9, 0.1, 0.1, 1]})
    file.header["materials"].append({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "doubleSided": False})
    file.header["nodes"].append({"mesh": 1})
    file.header["scenes"][0]["nodes"].append(2)
    colors = np.array([[(0.9, 0.1, 0.1)], [(0, 0, 0)]])
    return Triangles(np.stack([CORNERS, front]), colors, one_sided=True)


@feature
def single_sided_in_a_mirrored_node(file):
    """Mirroring turns the corners round; the side that is seen stays (glTF 2.0, 3.7.4)."""
    file.material(doubleSided=False)
    file.node(scale=[-1, 1, 1])
    return one(matrix=np.diag([-1.0, 1, 1, 1]), colors=WHITE)


@feature
def double_sided(file):
    file.positions(CORNERS[::-1])
    file.material(doubleSided=True)
    return one(CORNERS[::-1], colors=WHITE)


# --- cameras


@feature
def orthographic_camera(file):
    magnified = {"xmag": 2.25, "ymag": 1.5, "znear": 0.01, "zfar": 100}
    file.header["cameras"] = [{"type": "orthographic", "orthographic": magnified}]
    file.camera = {"ortho": 3.0}
    return one()


@feature
def near_plane_of_a_file(file):
    """A triangle of 20 units 4 km wide, and one a step before the camera, which far / 1000 would cut away."""
    near = CORNERS * 0.1 + (0, 0, 5.7)
    ground = np.array([(-2000.0, -3, 2000), (2000, -3, 2000), (0, -3, -2000)])
    file.positions(np.concatenate([near, ground]), range(6))
    return one(np.stack([near, ground]))


# --- the test


@pytest.mark.parametrize("name", FEATURES)
def test_feature(name, lab, tmp_path):
    file = File(tmp_path)
    expected = FEATURES[name](file)
    path = file.gltf() if name == "double_sided" else file.glb()  # both containers
    if hasattr(file, "note"):
        with pytest.warns(Notice, match=file.note):
            scene = aolab.load(path, **file.load)
    else:
        scene = aolab.load(path, **file.load)
    frame = lab.render(scene, "none", size=SIZE)
    right = draw(expected, SIZE, EYE, **file.camera)
    assert right.covered.sum() > 40, "the picture shows too little to be a test"
    np.testing.assert_array_equal(frame.mask[right.sure], right.covered[right.sure])
    inside = right.sure & right.covered
    np.testing.assert_allclose(
        -frame["viewZ"][inside], right.depth[inside], rtol=1e-3
    )  # of vertices on a grid of 1/256 of a pixel
    np.testing.assert_allclose(frame["albedo"][inside][:, :3], right.color[inside], atol=0.02)


def test_the_corpus_is_large_enough():
    assert len(FEATURES) >= 40
