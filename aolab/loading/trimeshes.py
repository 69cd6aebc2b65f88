"""From trimesh's objects to ours."""

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..errors import Notice, SceneError
from ..pictures.images import MAX_PIXELS, linear_from_srgb
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..scene.lights import Light
from ..scene.mesh import Material, Mesh, Texture
from ..scene.scene import Instance, Scene

MASK_CUTOFF = 0.5  # glTF's default alphaCutoff; also where blended surfaces are cut, as there is no blending


def scene_from_trimesh(source: Any, textures: Mapping[str, Texture] | None = None) -> Scene:
    """A `Scene` from a `trimesh.Scene` or `trimesh.Trimesh`, with the scene's camera, if it was given one.

    `textures` are already decoded images by the name that the file gives them. Normals count as given when trimesh
    holds some (it also keeps those that it computed itself, once asked); else they are made, smooth up to a crease.
    trimesh's lights, which it makes up by itself, are not taken. Raises `SceneError` where no triangle is left.
    """
    import trimesh

    if isinstance(source, trimesh.Trimesh):
        source = trimesh.Scene({"mesh": source})
    if not isinstance(source, trimesh.Scene):
        raise SceneError(f"cannot draw a trimesh.{type(source).__name__}: it holds no triangles")
    keep_texture: dict[int, Texture] = {}
    placed = placed_meshes(source, lambda geometry, name: _mesh(geometry, name, textures or {}, keep_texture))
    instances = [Instance(mesh, matrix, node) for node, mesh, matrix in placed]
    camera = None
    if source.has_camera:
        camera = camera_from_pose(source.camera_transform, float(source.camera.fov[1]))
    return Scene(tuple(instances), camera=camera)


def placed_meshes(source: Any, make_mesh: Callable[[Any, str], Mesh]) -> list[tuple[str, Mesh, np.ndarray]]:
    """Name, mesh and world_from_local (4, 4) of each node of a `trimesh.Scene` that has triangles.

    Nodes with the same geometry share the `Mesh`. The rest (points, lines) is left out with a `Notice`. Raises
    `SceneError` if there is nothing else.
    """
    import trimesh

    meshes: dict[int, Mesh] = {}
    placed, others = [], {}
    for node in source.graph.nodes_geometry:
        matrix, geometry_name = source.graph[node]
        geometry = source.geometry[geometry_name]
        if not isinstance(geometry, trimesh.Trimesh):
            others[geometry_name] = f"'{geometry_name}' ({type(geometry).__name__})"
            continue
        if id(geometry) not in meshes:
            meshes[id(geometry)] = make_mesh(geometry, str(geometry_name))
        placed.append((str(node), meshes[id(geometry)], matrix))
    if not placed:
        held = f"only {', '.join(others.values())}" if others else "no geometry"
        raise SceneError(f"no triangles: it holds {held}")
    if others:
        warnings.warn(f"left out, as they hold no triangles: {', '.join(others.values())}", Notice, stacklevel=4)
    return placed


def lit_scene(instances: list[Instance], lights: list[Light], camera: Camera | None) -> Scene:
    """A scene whose source has lights but no environment: a sky is added, so that ambient light has a source too."""
    return Scene(tuple(instances), tuple(lights), Environment.sky() if lights else None, camera)


def camera_from_pose(world_from_camera: np.ndarray, fov: float) -> Camera:
    """A camera at a node: it looks down -z with y up. A scale of the node does not matter, as in glTF."""
    eye, forward, up = world_from_camera[:3, 3], -world_from_camera[:3, 2], world_from_camera[:3, 1]
    forward, up = (axis / max(float(np.linalg.norm(axis)), 1e-300) for axis in (forward, up))
    return Camera(eye=tuple(eye), target=tuple(eye + forward), up=tuple(up), fov=fov)


def alpha_of(mode: str | None, cutoff: float | None, what: str) -> float | None:
    """`Material.alpha_cutoff` for glTF's alphaMode; BLEND is drawn as a mask, with a `Notice`."""
    if mode == "BLEND":
        warnings.warn(
            f"{what} is blended; drawn as a mask, cut at alpha {MASK_CUTOFF}: there is no blending",
            Notice,
            stacklevel=4,
        )
        return MASK_CUTOFF
    if mode != "MASK":
        return None
    return MASK_CUTOFF if cutoff is None else cutoff


def linear_colors(colors: np.ndarray, srgb: bool) -> np.ndarray:
    """(n, 3 or 4) colours, integers over their type's range or floats in [0, 1], as linear RGBA (n, 4) float32."""
    colors = np.asarray(colors)
    scale = np.iinfo(colors.dtype).max if colors.dtype.kind in "ui" else 1
    values = np.ones((len(colors), 4), np.float32)
    values[:, : colors.shape[1]] = colors / scale
    if srgb:
        values[:, :3] = linear_from_srgb(np.rint(values[:, :3].clip(0, 1) * 255).astype(np.uint8))
    return values


def texture_from_pil(image: Any, name: str) -> Texture:
    """A `Texture` from a PIL image. Raises `SceneError` for one that is too large or cannot be decoded."""
    width, height = image.size
    if width * height > MAX_PIXELS:
        raise SceneError(f"texture '{name}' has {width}×{height} pixels; the limit is {MAX_PIXELS}")
    try:
        return Texture(np.array(image.convert("RGBA")), name)
    except (OSError, SyntaxError, ValueError) as error:
        raise SceneError(f"texture '{name}' cannot be decoded: {error}") from error


def _mesh(geometry: Any, name: str, textures: Mapping[str, Texture], keep: dict[int, Texture]) -> Mesh:
    vertices, faces = np.asarray(geometry.vertices), np.asarray(geometry.faces)
    # asking for `vertex_normals` would make some; only the cache tells which were given
    normals = geometry.vertex_normals if "vertex_normals" in geometry._cache else None
    visual, uv, colors, material = geometry.visual, None, None, None
    if visual.kind == "texture":
        material = _material(visual.material, textures, keep, name)
        uv, colors = visual.uv, visual.vertex_attributes.get("color")
    elif visual.kind == "vertex":
        colors = visual.vertex_colors
    elif visual.kind == "face" and len(faces) and faces.min() >= 0 and faces.max() < len(vertices):
        colors = np.repeat(visual.face_colors, 3, axis=0)
        vertices, normals = vertices[faces.reshape(-1)], None if normals is None else normals[faces.reshape(-1)]
        faces = np.arange(len(vertices)).reshape(-1, 3)
    if material is None:
        material = Material() if colors is None else Material(base_color=(1.0, 1.0, 1.0))
    return Mesh(
        vertices=vertices,
        faces=faces,
        normals=normals,
        uv=uv,
        colors=None if colors is None else linear_colors(colors, srgb=True),
        material=material,
        name=name,
    )


def _material(source: Any, textures: Mapping[str, Texture], keep: dict[int, Texture], mesh: str) -> Material | None:
    """PBR factors are linear, as in glTF. The Kd of an MTL is taken as sRGB, as web viewers do: MTL does not say."""
    from trimesh.visual.color import DEFAULT_COLOR
    from trimesh.visual.material import MultiMaterial, PBRMaterial, color_image

    if isinstance(source, MultiMaterial):
        warnings.warn(f"mesh '{mesh}' has a material for each face; drawn with the first", Notice, stacklevel=4)
        source = source.materials[0] if source.materials else None
    is_pbr = isinstance(source, PBRMaterial)
    factor = getattr(source, "baseColorFactor" if is_pbr else "diffuse", None)
    image = getattr(source, "baseColorTexture" if is_pbr else "image", None)
    if factor is not None and np.array_equal(factor, DEFAULT_COLOR) and "kd" not in getattr(source, "kwargs", "kd"):
        factor = None  # trimesh's grey for a material that gives no colour
    if image is not None and image.size == (2, 2) and image == color_image():
        image = None  # trimesh's stand-in for no material at all
    if factor is None and image is None and not is_pbr:
        return None
    texture = None
    if image is not None:
        texture = textures.get(image.info.get("file_path", "")) or keep.get(id(image))
        texture = texture or keep.setdefault(id(image), texture_from_pil(image, f"{source.name} of {mesh}"))
    rgba = linear_colors(np.array([[255] * 4 if factor is None else factor], np.uint8), srgb=not is_pbr)[0]
    cutoff = alpha_of(source.alphaMode, source.alphaCutoff, f"material '{source.name}'") if is_pbr else None
    return Material(tuple(rgba[:3].tolist()), texture, float(rgba[3]), cutoff, source.name)
