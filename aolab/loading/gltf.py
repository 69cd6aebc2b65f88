"""glTF 2.0, `.glb` and `.gltf`: trimesh reads geometry and hierarchy; materials, cameras and lights are read here.

Why: trimesh rounds colours to 8 bits, decodes every image unasked, drops what hangs below a camera's node, and has no
lights. So it is given the file's JSON with names replaced by indices, by which its answer is put together with ours.
"""

import io
import json
import warnings
from pathlib import Path

import numpy as np

from ..errors import FileError, Notice, SceneError
from ..scene.camera import Camera
from ..scene.lights import DirectionalLight, Light, PointLight, SpotLight
from ..scene.scene import Instance, Scene
from .folder import Folder
from .gltf_file import Json, check, node_name, nodes_in_scene, read_buffers, read_header
from .gltf_materials import Materials
from .reading import read_trimesh
from .trimeshes import camera_from_pose, lit_scene, placed_meshes

TRIANGLES, TRIANGLE_STRIP = 4, 5
WIDEST_SPOT = 89.9  # degrees; glTF allows 90, where a shadow map has no projection


def scene_from_gltf(path: Path, folder: Folder) -> Scene:
    """The scene in a glTF file. Raises `FileError` and `SceneError`; the caller names the file in all others."""
    header, binary = read_header(path)
    check(header)
    nodes = nodes_in_scene(header)
    buffers = read_buffers(header, binary, folder)
    geometry = read_trimesh(io.BytesIO(json.dumps(_for_trimesh(header)).encode()), "gltf", buffers)
    materials = Materials(header, buffers, folder)
    order = {node: place for place, node in enumerate(nodes)}
    placed = [(int(name.split("_")[0]), mesh, matrix) for name, mesh, matrix in placed_meshes(geometry, materials.mesh)]
    placed.sort(key=lambda entry: order[entry[0]])  # trimesh lists the last node first
    instances = [Instance(mesh, matrix, node_name(header, node)) for node, mesh, matrix in placed]
    poses = {node: geometry.graph[str(node)][0] for node in nodes}
    return lit_scene(instances, _lights(header, poses), _camera(header, poses))


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
            lights.append(_light(kinds[index], pose, node_name(header, node)))
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
