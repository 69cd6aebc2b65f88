"""From pyrender's scenes to ours. pyrender itself is not imported: its objects are read by their attributes."""

from typing import Any

import numpy as np

from ..errors import SceneError
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..scene.lights import Light
from ..scene.mesh import Material, Texture
from ..scene.scene import Scene
from .materials import alpha_drawn, linear_colors
from .parts import Content, Notes, Part, Placed, scene_of
from .placing import camera_at, light_at

TRIANGLES = 4  # GL's number, which pyrender uses


def scene_from_pyrender(source: Any) -> Scene:
    """A `Scene` from a `pyrender.Scene`: visible meshes, lights, its main camera, its ambient light if it has one.

    Textures are sRGB, factors and vertex colours linear, as pyrender shades them. Its ambient light is an environment
    of that radiance. Points and lines are left out with a `Notice`; raises `SceneError` where no triangle is left.
    """
    if not hasattr(source, "mesh_nodes"):
        raise SceneError(f"cannot draw a pyrender.{type(source).__name__}; give a pyrender.Scene")
    # `source.nodes` is a set, whose order changes from run to run; the graph keeps the order in which they were added
    poses = {node: source.get_pose(node) for node in source._digraph.nodes if node in source.nodes}
    parts: dict[int, Part] = {}
    textures: dict[int, Texture] = {}
    content = Content()
    for node, pose in poses.items():
        if node.mesh is None or not node.mesh.is_visible:
            continue
        for index, primitive in enumerate(node.mesh.primitives):
            name = node.mesh.name or node.name or "mesh"
            name = name if len(node.mesh.primitives) == 1 else f"{name} {index}"
            if primitive.mode != TRIANGLES:
                content.left_out.append(f"'{name}' holds no triangles (mode {primitive.mode})")
                continue
            if id(primitive) not in parts:
                parts[id(primitive)] = _part(primitive, name, textures, content.notes)
            offsets = [np.eye(4)] if primitive.poses is None else primitive.poses
            part = parts[id(primitive)]
            content.placed += [Placed(part, pose @ offset, node.name or name) for offset in offsets]
    content.lights = [_light(node.light, pose) for node, pose in poses.items() if node.light is not None]
    content.camera = _camera(source, poses, content.notes)
    if np.any(source.ambient_light):
        content.environment = Environment.constant(source.ambient_light)
    return scene_of(content)


def _part(primitive: Any, name: str, textures: dict[int, Texture], notes: Notes) -> Part:
    indices = primitive.indices
    return Part(
        vertices=primitive.positions,
        faces=np.arange(len(primitive.positions)).reshape(-1, 3) if indices is None else indices.reshape(-1, 3),
        normals=primitive.normals,
        uv=None if primitive.texcoord_0 is None else primitive.texcoord_0[:, :2],
        colors=None if primitive.color_0 is None else linear_colors(primitive.color_0, srgb=False),
        material=_material(primitive, name, textures, notes),
        name=name,
    )


def _material(primitive: Any, mesh: str, textures: dict[int, Texture], notes: Notes) -> Material:
    source = primitive.material
    if source is None:
        return Material()
    name = source.name or f"of {mesh}"
    is_glossy = hasattr(source, "diffuseFactor")
    factor = source.diffuseFactor if is_glossy else source.baseColorFactor
    image = source.diffuseTexture if is_glossy else source.baseColorTexture
    texture = None
    if image is not None and image.source is not None:
        if id(image) not in textures:
            textures[id(image)] = Texture(_rgba(image.source), image.name or name)
        texture = textures[id(image)]
    # pyrender's default material is BLEND; it blends only what has an alpha below 1
    mode = source.alphaMode if source.alphaMode != "BLEND" or primitive.is_transparent else None
    drawn = alpha_drawn(mode, source.alphaCutoff, f"'{name}'", notes)
    rgb, alpha = tuple(np.asarray(factor, float)[:3].tolist()), float(factor[3])
    return Material(rgb, texture, alpha, name=name, double_sided=bool(source.doubleSided), **drawn)


def _rgba(pixels: Any) -> np.ndarray:
    """(H, W, 3 or 4) uint8, as pyrender keeps colour textures, with an alpha of 255 where there is none."""
    pixels = np.asarray(pixels)
    alpha = np.full((*pixels.shape[:2], 4), 255, np.uint8)
    alpha[..., : pixels.shape[2]] = pixels
    return alpha


def _camera(source: Any, poses: dict[Any, np.ndarray], notes: Notes) -> Camera | None:
    node = source.main_camera_node
    if node is None:
        return None
    camera = node.camera
    planes = {"near": camera.znear or None, "far": camera.zfar}
    if hasattr(camera, "ymag"):
        return camera_at(poses[node], ortho=2 * float(camera.ymag), **planes)
    if hasattr(camera, "yfov"):
        return camera_at(poses[node], fov=float(np.degrees(camera.yfov)), **planes)
    kind = type(camera).__name__
    notes.add(f"a pyrender {kind} cannot be used; a perspective camera frames the scene instead")
    return None


def _light(light: Any, pose: np.ndarray) -> Light:
    color = np.asarray(light.color, float)[:3] * light.intensity
    cone = None
    if hasattr(light, "outerConeAngle"):
        cone = np.degrees([light.innerConeAngle, light.outerConeAngle]).tolist()
    return light_at(pose, color, has_position=cone is not None or hasattr(light, "range"), cone=cone)
