"""From pyrender's scenes to ours. pyrender itself is not imported: its objects are read by their attributes."""

import warnings
from typing import Any

import numpy as np

from ..errors import Notice, SceneError
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..scene.lights import DirectionalLight, Light, PointLight, SpotLight
from ..scene.mesh import Material, Mesh, Texture
from ..scene.scene import Instance, Scene
from .trimeshes import alpha_of, camera_from_pose, linear_colors, lit_scene

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
    meshes: dict[int, Mesh] = {}
    textures: dict[int, Texture] = {}
    instances, left_out = [], []
    for node, pose in poses.items():
        if node.mesh is None or not node.mesh.is_visible:
            continue
        for index, primitive in enumerate(node.mesh.primitives):
            name = node.mesh.name or node.name or "mesh"
            name = name if len(node.mesh.primitives) == 1 else f"{name} {index}"
            if primitive.mode != TRIANGLES:
                left_out.append(f"'{name}' (mode {primitive.mode})")
                continue
            if id(primitive) not in meshes:
                meshes[id(primitive)] = _mesh(primitive, name, textures)
            offsets = [np.eye(4)] if primitive.poses is None else primitive.poses
            instances += [Instance(meshes[id(primitive)], pose @ offset, node.name or name) for offset in offsets]
    if left_out and instances:
        warnings.warn(f"left out, as they hold no triangles: {', '.join(left_out)}", Notice, stacklevel=3)
    if not instances:
        raise SceneError(f"no triangles: the pyrender scene holds only {', '.join(left_out) or 'no visible mesh'}")
    lights = [_light(node.light, pose) for node, pose in poses.items() if node.light is not None]
    scene = lit_scene(instances, lights, _camera(source, poses))
    if np.any(source.ambient_light):
        return scene.replace(environment=Environment.constant(source.ambient_light), lights=tuple(lights))
    return scene


def _mesh(primitive: Any, name: str, textures: dict[int, Texture]) -> Mesh:
    indices = primitive.indices
    return Mesh(
        vertices=primitive.positions,
        faces=np.arange(len(primitive.positions)).reshape(-1, 3) if indices is None else indices.reshape(-1, 3),
        normals=primitive.normals,
        uv=None if primitive.texcoord_0 is None else primitive.texcoord_0[:, :2],
        colors=None if primitive.color_0 is None else linear_colors(primitive.color_0, srgb=False),
        material=_material(primitive, name, textures),
        name=name,
    )


def _material(primitive: Any, mesh: str, textures: dict[int, Texture]) -> Material:
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
    cutoff = alpha_of(mode, source.alphaCutoff, f"material '{name}'")
    return Material(tuple(np.asarray(factor, float)[:3].tolist()), texture, float(factor[3]), cutoff, name)


def _rgba(pixels: Any) -> np.ndarray:
    """(H, W, 3 or 4) uint8, as pyrender keeps colour textures, with an alpha of 255 where there is none."""
    pixels = np.asarray(pixels)
    alpha = np.full((*pixels.shape[:2], 4), 255, np.uint8)
    alpha[..., : pixels.shape[2]] = pixels
    return alpha


def _camera(source: Any, poses: dict[Any, np.ndarray]) -> Camera | None:
    node = source.main_camera_node
    if node is None:
        return None
    if not hasattr(node.camera, "yfov"):
        kind = type(node.camera).__name__
        text = f"a pyrender {kind} cannot be used; a perspective camera frames the scene instead"
        warnings.warn(text, Notice, stacklevel=4)
        return None
    return camera_from_pose(poses[node], float(np.degrees(node.camera.yfov)))


def _light(light: Any, pose: np.ndarray) -> Light:
    red, green, blue = (np.asarray(light.color, float)[:3] * light.intensity).tolist()
    x, y, z = (-pose[:3, 2]).tolist()
    position = tuple(pose[:3, 3].tolist())
    if hasattr(light, "outerConeAngle"):
        inner, outer = np.degrees([light.innerConeAngle, light.outerConeAngle]).tolist()
        return SpotLight(position, (x, y, z), (red, green, blue), inner, outer)
    if hasattr(light, "range"):
        return PointLight(position, (red, green, blue))
    return DirectionalLight((x, y, z), (red, green, blue))
