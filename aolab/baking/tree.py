"""The parts of a glTF file that trimesh does not write: camera, lights, tangents, and factors of materials."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..maths.transforms import look_along
from ..scene.camera import Camera
from ..scene.lights import DirectionalLight, Light, PointLight, SpotLight
from ..scene.mesh import Material
from ..scene.scene import Scene

LIGHTS, STRENGTH = "KHR_lights_punctual", "KHR_materials_emissive_strength"
# of the scene's radius: clip planes that glTF demands of a camera without
NEAR, FAR = 1e-4, 1e3


def complete(tree: dict[str, Any], scene: Scene, materials: Iterable[tuple[str, Material]]) -> None:
    """Add the camera and the lights to the JSON of a file, and complete its materials, which are given by name."""
    for mesh in tree["meshes"]:
        for primitive in mesh["primitives"]:
            if tangents := primitive["attributes"].pop("_TANGENT", None):
                primitive["attributes"]["TANGENT"] = tangents
    named = {material["name"]: material for material in tree.get("materials", ())}
    for name, material in materials:
        if material.normal_texture is not None:
            named[name]["normalTexture"]["scale"] = material.normal_scale
        if max(material.emission) > 1:
            named[name].setdefault("extensions", {})[STRENGTH] = {"emissiveStrength": max(material.emission)}
            _use(tree, STRENGTH)
    if scene.lights:
        tree.setdefault("extensions", {})[LIGHTS] = {"lights": [_light(light) for light in scene.lights]}
        _use(tree, LIGHTS)
    for number, light in enumerate(scene.lights):
        place = (0, 0, 0) if isinstance(light, DirectionalLight) else light.position
        direction = (0, 0, -1) if isinstance(light, PointLight) else light.direction
        _add(
            tree,
            look_along(np.asarray(place, float), np.asarray(direction, float)),
            {"extensions": {LIGHTS: {"light": number}}},
        )
    if scene.camera is not None:
        tree["cameras"] = [_camera(scene.camera, scene.radius)]
        _add(tree, scene.camera.view_from_world, {"camera": 0})


def _use(tree: dict[str, Any], extension: str) -> None:
    used = tree.setdefault("extensionsUsed", [])
    if extension not in used:
        used.append(extension)


def _add(tree: dict[str, Any], view_from_world: np.ndarray, node: dict[str, Any]) -> None:
    """A node of the scene that looks down the -z axis of `view_from_world`."""
    matrix = np.linalg.inv(view_from_world).T.ravel().tolist()  # column by column
    tree["scenes"][tree.get("scene", 0)]["nodes"].append(len(tree["nodes"]))
    tree["nodes"].append({"matrix": matrix, **node})


def _light(light: Light) -> dict[str, Any]:
    color = np.asarray(light.irradiance if isinstance(light, DirectionalLight) else light.intensity, float)
    intensity = float(color.max())
    found: dict[str, Any] = {"intensity": intensity, "color": (color / (intensity or 1.0)).tolist()}
    if isinstance(light, SpotLight):
        cone = {"innerConeAngle": np.radians(light.inner).item(), "outerConeAngle": np.radians(light.outer).item()}
        return {"type": "spot", "spot": cone, **found}
    return {"type": "point" if isinstance(light, PointLight) else "directional", **found}


def _camera(camera: Camera, radius: float) -> dict[str, Any]:
    lens: dict[str, float] = {"znear": camera.near or NEAR * radius}
    if camera.ortho is not None:
        half = camera.ortho / 2
        return {
            "type": "orthographic",
            "orthographic": {**lens, "xmag": half, "ymag": half, "zfar": camera.far or FAR * radius},
        }
    if camera.far is not None:
        lens["zfar"] = camera.far
    return {"type": "perspective", "perspective": {**lens, "yfov": np.radians(camera.fov).item()}}
