"""glTF 2.0, `.glb` and `.gltf`: trimesh reads geometry and hierarchy; materials, cameras and lights are read here.

Why: trimesh rounds colours to 8 bits, decodes every image unasked, drops what hangs below a camera's node, and has no
lights. So it is given the file's JSON with names replaced by indices, by which its answer is put together with ours.
"""

import base64
import binascii
import io
import json
import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from ..camera import Camera
from ..errors import FileError, Notice, SceneError
from ..lights import DirectionalLight, Light, PointLight, SpotLight
from ..mesh import Material, Mesh, Texture
from ..scene import Instance, Scene
from .files import read_trimesh
from .folder import Folder
from .images import read_image
from .trimeshes import alpha_of, camera_from_pose, linear_colors, lit_scene, placed_meshes

Json = dict[str, Any]

GLB_MAGIC, JSON_CHUNK, BINARY_CHUNK = b"glTF", b"JSON", b"BIN\0"
TRIANGLES, TRIANGLE_STRIP = 4, 5
# required extensions that the result is right without, or that are read here
UNDERSTOOD = {"KHR_lights_punctual", "KHR_texture_transform", "EXT_texture_webp", "KHR_xmp_json_ld"}
WIDEST_SPOT = 89.9  # degrees; glTF allows 90, where a shadow map has no projection


def scene_from_gltf(path: Path, folder: Folder) -> Scene:
    """The scene in a glTF file. Raises `FileError` and `SceneError`; the caller names the file in all others."""
    header, binary = read_header(path)
    _check(header)
    nodes = _nodes_in_scene(header)
    buffers = _buffers(header, binary, folder)
    geometry = read_trimesh(io.BytesIO(json.dumps(_for_trimesh(header)).encode()), "gltf", buffers)
    materials = _Materials(header, buffers, folder)
    order = {node: place for place, node in enumerate(nodes)}
    placed = [(int(name.split("_")[0]), mesh, matrix) for name, mesh, matrix in placed_meshes(geometry, materials.mesh)]
    placed.sort(key=lambda entry: order[entry[0]])  # trimesh lists the last node first
    instances = [Instance(mesh, matrix, _node_name(header, node)) for node, mesh, matrix in placed]
    poses = {node: geometry.graph[str(node)][0] for node in nodes}
    return lit_scene(instances, _lights(header, poses), _camera(header, poses))


def read_header(path: Path) -> tuple[Json, bytes]:
    """The JSON of a `.gltf` or `.glb` file, and the binary chunk of the latter. Raises `FileError` where broken."""
    data = path.read_bytes()
    if path.suffix.lower() == ".gltf":
        return _parse(data, path), b""
    if data[:4] != GLB_MAGIC or len(data) < 20:
        raise FileError(f"{path} is not a GLB file: it starts with {data[:4]!r}, not {GLB_MAGIC!r}")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise FileError(f"{path} is GLB version {version}; only 2 is read")
    if length > len(data):
        raise FileError(f"{path} is truncated: {len(data)} of {length} bytes")
    chunks: dict[bytes, bytes] = {}
    start = 12
    while start + 8 <= length:
        size, kind = struct.unpack_from("<I4s", data, start)
        if start + 8 + size > length:
            raise FileError(f"{path} is corrupt: its chunk {kind!r} of {size} bytes reaches beyond the end")
        chunks.setdefault(kind, data[start + 8 : start + 8 + size])
        start += 8 + size
    if JSON_CHUNK not in chunks:
        raise FileError(f"{path} is corrupt: it has no JSON chunk")
    return _parse(chunks[JSON_CHUNK], path), chunks.get(BINARY_CHUNK, b"")


def _parse(data: bytes, path: Path) -> Json:
    try:
        header = json.loads(data.decode("utf-8-sig"))
    except ValueError as error:
        raise FileError(f"{path} is corrupt: its JSON cannot be parsed: {error}") from error
    if not isinstance(header, dict):
        raise FileError(f"{path} is not glTF: its JSON is a {type(header).__name__}, not an object")
    return header


def _check(header: Json) -> None:
    version = str(header.get("asset", {}).get("version", "missing"))
    if version.split(".")[0] != "2":
        raise FileError(f"its glTF version is {version}; only 2 is read")
    required = set(header.get("extensionsRequired", ()))
    unknown = sorted(name for name in required - UNDERSTOOD if not name.startswith("KHR_materials_"))
    if unknown:
        raise FileError(f"it requires {', '.join(unknown)}, which is not read; export it without (say, uncompressed)")
    if header.get("skins") or any(
        "targets" in part for mesh in header.get("meshes", ()) for part in mesh["primitives"]
    ):
        warnings.warn("skins and morph targets are not applied; drawn in the rest pose", Notice, stacklevel=5)
    for index, accessor in enumerate(header.get("accessors", ())):
        if "sparse" in accessor:
            raise FileError(f"its accessor {index} is sparse, which is not read")
        if "bufferView" not in accessor and "KHR_draco_mesh_compression" not in header.get("extensionsUsed", ()):
            raise FileError(f"its accessor {index} has no data (no bufferView)")


def _nodes_in_scene(header: Json) -> list[int]:
    """The nodes of the default scene, parents first. Raises `FileError` unless they form trees, as glTF demands."""
    nodes = header.get("nodes", [])
    children = {child for node in nodes for child in node.get("children", ())}
    # without scenes, all that nothing contains
    header.setdefault("scenes", [{"nodes": [index for index in range(len(nodes)) if index not in children]}])
    header.setdefault("scene", 0)
    found: dict[int, None] = {}
    waiting = list(reversed(header["scenes"][header["scene"]].get("nodes", [])))
    while waiting:
        index = waiting.pop()
        if not isinstance(index, int) or not 0 <= index < len(nodes):
            raise FileError(f"it refers to node {index}, but has {len(nodes)} nodes")
        if index in found:
            raise FileError(f"its node '{_node_name(header, index)}' is reached twice: nodes must form a tree")
        found[index] = None
        waiting.extend(reversed(nodes[index].get("children", [])))
    return list(found)


def _node_name(header: Json, index: int) -> str:
    return header["nodes"][index].get("name") or f"node {index}"


def _for_trimesh(header: Json) -> Json:
    """The part of the header that trimesh reads: nodes and materials named by index, no camera, no image.

    UV and vertex colours become custom attributes, which trimesh hands over as stored. Primitives that are no
    triangles are left out with a `Notice`, as are meshes that hold nothing else.
    """
    meshes, left_out = [], 0
    for mesh in header.get("meshes", ()):
        primitives = []
        for primitive in mesh["primitives"]:
            if primitive.get("mode", TRIANGLES) not in (TRIANGLES, TRIANGLE_STRIP):
                left_out += 1
                continue
            attributes = {
                name if name in ("POSITION", "NORMAL") else f"_{name}": accessor
                for name, accessor in primitive["attributes"].items()
                if name.startswith(("POSITION", "NORMAL", "TEXCOORD_", "COLOR_0"))
            }
            kept = {key: primitive[key] for key in ("indices", "mode") if key in primitive}
            primitives.append(kept | {"attributes": attributes, "material": primitive.get("material", -1)})
        meshes.append({"name": mesh.get("name") or f"mesh {len(meshes)}", "primitives": primitives})
    if left_out:
        total = left_out + sum(len(mesh["primitives"]) for mesh in meshes)
        text = f"left out {left_out} of {total} primitives: points, lines or triangle fans, not triangles"
        if left_out == total:
            raise SceneError(text)
        warnings.warn(text, Notice, stacklevel=5)
    nodes = []
    for index, node in enumerate(header.get("nodes", ())):
        kept = {key: node[key] for key in ("children", "matrix", "translation", "rotation", "scale") if key in node}
        if "mesh" in node and meshes[node["mesh"]]["primitives"]:
            kept["mesh"] = node["mesh"]
        nodes.append(kept | {"name": str(index)})
    materials = [{"name": str(index)} for index in [*range(len(header.get("materials", ()))), -1]]
    return {
        "asset": {"version": "2.0"},
        "scene": header["scene"],
        "scenes": header["scenes"],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "accessors": header.get("accessors", []),
        "bufferViews": header.get("bufferViews", []),
        "buffers": [{"uri": str(index)} for index in range(len(header.get("buffers", ())))],
    }


def _buffers(header: Json, binary: bytes, folder: Folder) -> dict[str, bytes]:
    """The contents of the buffers by their index. Raises `FileError` for one that is missing, refused or too short."""
    buffers = {}
    for index, buffer in enumerate(header.get("buffers", ())):
        try:
            data = _resource(buffer["uri"], folder) if "uri" in buffer else binary
        except FileNotFoundError:
            raise FileError(f"its buffer '{buffer['uri']}' is missing") from None
        if len(data) < buffer["byteLength"]:
            raise FileError(f"its buffer {index} is truncated: {len(data)} of {buffer['byteLength']} bytes")
        buffers[str(index)] = data
    for index, view in enumerate(header.get("bufferViews", ())):
        start, size, length = view.get("byteOffset", 0), view["byteLength"], len(buffers[str(view["buffer"])])
        if start < 0 or size < 0 or start + size > length:
            raise FileError(f"its bufferView {index} is bytes {start} to {start + size} of a buffer of {length}")
    return buffers


def _resource(uri: str, folder: Folder) -> bytes:
    """What a URI names: data in itself, or a file of the folder."""
    if not uri.startswith("data:"):
        return folder.get(uri)
    meta, _, payload = uri.partition(",")
    if not meta.endswith(";base64"):
        raise FileError(f"it holds a data URI that is not base64: '{uri[:40]}...'")
    try:
        return base64.b64decode(payload, validate=True)
    except binascii.Error as error:
        raise FileError(f"it holds a corrupt data URI '{uri[:40]}...': {error}") from error


class _Materials:
    """The file's materials and textures, each made once, when first used."""

    def __init__(self, header: Json, buffers: dict[str, bytes], folder: Folder) -> None:
        self.header, self.buffers, self.folder = header, buffers, folder
        self.materials: dict[int, tuple[Material, int]] = {}
        self.textures: dict[int, Texture | None] = {}

    def mesh(self, geometry: Any, name: str) -> Mesh:
        """Ours from a `trimesh.Trimesh` as `_for_trimesh` lets it be read."""
        attributes = geometry.vertex_attributes
        index = int(geometry.visual.material.name)
        if index not in self.materials:
            self.materials[index] = self._material(index)
        material, uv_set = self.materials[index]
        uv, colors = attributes.get(f"_TEXCOORD_{uv_set}"), attributes.get("_COLOR_0")
        if uv is not None:
            scale = np.iinfo(uv.dtype).max if uv.dtype.kind in "ui" else 1
            uv = np.stack([uv[:, 0] / scale, 1 - uv[:, 1] / scale], axis=1)  # glTF's v points down
        if colors is not None and index < 0:
            material = Material(base_color=(1.0, 1.0, 1.0))
        return Mesh(
            vertices=geometry.vertices,
            faces=geometry.faces,
            normals=geometry.vertex_normals if "vertex_normals" in geometry._cache else None,
            uv=uv,
            colors=None if colors is None else linear_colors(colors, srgb=False),
            material=material,
            name=name,
        )

    def _material(self, index: int) -> tuple[Material, int]:
        """A material and the number of the UV set that its texture uses; index -1 is none."""
        if index < 0:
            return Material(), 0
        source = self.header["materials"][index]
        name = source.get("name") or f"material {index}"
        surface = source.get("pbrMetallicRoughness", {})
        factor, info = surface.get("baseColorFactor"), surface.get("baseColorTexture")
        glossy = source.get("extensions", {}).get("KHR_materials_pbrSpecularGlossiness")
        if glossy is not None:
            factor, info = glossy.get("diffuseFactor"), glossy.get("diffuseTexture")
        red, green, blue, alpha = factor or (1.0, 1.0, 1.0, 1.0)
        cutoff = alpha_of(source.get("alphaMode"), source.get("alphaCutoff"), f"material '{name}'")
        texture = None if info is None else self._texture(info, name)
        uv_set = 0 if info is None else info.get("texCoord", 0)
        return Material((red, green, blue), texture, float(alpha), cutoff, name), uv_set

    def _texture(self, info: Json, material: str) -> Texture | None:
        if "KHR_texture_transform" in info.get("extensions", {}):
            text = f"material '{material}': the transform of its texture (KHR_texture_transform) is not applied"
            warnings.warn(text, Notice, stacklevel=5)
        texture = self.header["textures"][info["index"]]
        webp = texture.get("extensions", {}).get("EXT_texture_webp", {})
        index = webp.get("source", texture.get("source"))
        if index is None:
            kinds = ", ".join(texture.get("extensions", {})) or "no image"
            text = f"material '{material}': its texture is in no known format ({kinds}); drawn without"
            warnings.warn(text, Notice, stacklevel=5)
            return None
        if index not in self.textures:
            self.textures[index] = self._image(index, material)
        return self.textures[index]

    def _image(self, index: int, material: str) -> Texture | None:
        image = self.header["images"][index]
        uri = image.get("uri", "")
        name = image.get("name") or (uri if uri and not uri.startswith("data:") else f"image {index}")
        if "bufferView" in image:
            view = self.header["bufferViews"][image["bufferView"]]
            start = view.get("byteOffset", 0)
            data = self.buffers[str(view["buffer"])][start : start + view["byteLength"]]
        else:
            try:
                data = _resource(image["uri"], self.folder)
            except FileNotFoundError:
                text = f"{self.folder.model}: the texture '{uri}' of material '{material}' is missing; drawn without"
                warnings.warn(text, Notice, stacklevel=5)
                return None
        return Texture(read_image(data, name), name)


def _camera(header: Json, poses: dict[int, np.ndarray]) -> Camera | None:
    """The first perspective camera; None, with a `Notice`, if there are only others."""
    found = [(header["cameras"][header["nodes"][node]["camera"]], pose) for node, pose in poses.items()
             if "camera" in header["nodes"][node]]  # fmt: skip
    for camera, pose in found:
        if camera["type"] == "perspective":
            return camera_from_pose(pose, float(np.degrees(camera["perspective"]["yfov"])))
    if found:
        text = f"its {len(found)} orthographic camera(s) cannot be used; a perspective one frames the scene instead"
        warnings.warn(text, Notice, stacklevel=5)
    return None


def _lights(header: Json, poses: dict[int, np.ndarray]) -> list[Light]:
    """KHR_lights_punctual, in the order of the nodes; a light's range is a culling hint and not used."""
    kinds = header.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
    lights = []
    for node, pose in poses.items():
        index = header["nodes"][node].get("extensions", {}).get("KHR_lights_punctual", {}).get("light")
        if index is not None:
            lights.append(_light(kinds[index], pose, _node_name(header, node)))
    return lights


def _light(light: Json, pose: np.ndarray, node: str) -> Light:
    red, green, blue = np.multiply(light.get("color", (1, 1, 1)), light.get("intensity", 1)).tolist()
    x, y, z = (-pose[:3, 2]).tolist()
    position = tuple(pose[:3, 3].tolist())
    if light["type"] == "directional":
        return DirectionalLight((x, y, z), irradiance=(red, green, blue))
    if light["type"] == "point":
        return PointLight(position, intensity=(red, green, blue))
    if light["type"] != "spot":
        raise FileError(f"the light of node '{node}' is of type '{light['type']}'; known: directional, point, spot")
    cone = light.get("spot", {})
    inner, outer = np.degrees([cone.get("innerConeAngle", 0), cone.get("outerConeAngle", np.pi / 4)]).tolist()
    if outer > WIDEST_SPOT:
        text = f"the spot of node '{node}' is {outer:g} degrees wide at the half; narrowed to {WIDEST_SPOT}"
        warnings.warn(text, Notice, stacklevel=5)
        inner, outer = min(inner, WIDEST_SPOT - 0.1), WIDEST_SPOT
    return SpotLight(position, (x, y, z), (red, green, blue), inner, outer)
