"""From trimesh's objects to ours."""

from typing import Any

import numpy as np

from ..errors import SceneError
from ..pictures.images import MAX_PIXELS
from ..scene.mesh import Material, Texture
from ..scene.scene import Scene
from .materials import alpha_drawn, linear_colors
from .parts import Content, Part, Placed, scene_of
from .placing import camera_at


def scene_from_trimesh(source: Any) -> Scene:
    """A `Scene` from a `trimesh.Scene` or `trimesh.Trimesh`, with the scene's camera, if it was given one.

    Normals count as given when trimesh holds some (it also keeps those that it computed itself, once asked); else they
    are made, smooth up to a crease. trimesh's lights, which it makes up by itself, are not taken. Raises `SceneError`
    where no triangle is left.
    """
    import trimesh

    if isinstance(source, trimesh.Trimesh):
        source = trimesh.Scene({"mesh": source})
    if not isinstance(source, trimesh.Scene):
        raise SceneError(f"cannot draw a trimesh.{type(source).__name__}: it holds no triangles")
    content = Content()
    parts: dict[int, Part] = {}
    textures: dict[int, Texture] = {}
    for node in source.graph.nodes_geometry:
        matrix, name = source.graph[node]
        geometry = source.geometry[name]
        if not isinstance(geometry, trimesh.Trimesh):
            content.left_out.append(f"'{name}' holds no triangles ({type(geometry).__name__})")
            continue
        if id(geometry) not in parts:
            parts[id(geometry)] = _part(geometry, str(name), textures, content)
        content.placed.append(Placed(parts[id(geometry)], matrix, str(node)))
    if source.has_camera:
        try:
            content.camera = camera_at(source.camera_transform, fov=float(source.camera.fov[1]))
        except (ValueError, SceneError) as error:  # ValueError: the graph has no place for it
            content.notes.add(f"its camera cannot be used ({error}); another one frames the scene")
    return scene_of(content)


def _part(geometry: Any, name: str, textures: dict[int, Texture], content: Content) -> Part:
    vertices, faces = np.asarray(geometry.vertices), np.asarray(geometry.faces)
    # trimesh computes `vertex_normals` when they are read: only normals in its cache were given
    normals = geometry.vertex_normals if "vertex_normals" in geometry._cache else None
    visual, uv, colors, material = geometry.visual, None, None, None
    if visual.kind == "texture":
        material = _material(visual.material, textures, name, content)
        uv, colors = visual.uv, visual.vertex_attributes.get("color")
    elif visual.kind == "vertex":
        colors = visual.vertex_colors
    elif visual.kind == "face" and len(faces) and faces.min() >= 0 and faces.max() < len(vertices):
        colors = np.repeat(visual.face_colors, 3, axis=0)
        vertices, normals = vertices[faces.reshape(-1)], None if normals is None else normals[faces.reshape(-1)]
        faces = np.arange(len(vertices)).reshape(-1, 3)
    if material is None:
        material = Material() if colors is None else Material(base_color=(1.0, 1.0, 1.0))
    rgba = None if colors is None else linear_colors(colors, srgb=True)
    return Part(vertices, faces, normals, uv, rgba, material, name)


def _material(source: Any, textures: dict[int, Texture], mesh: str, content: Content) -> Material | None:
    """PBR factors are linear, as in glTF. Diffuse colours are taken as sRGB, as web viewers take those of MTL."""
    from trimesh.visual.color import DEFAULT_COLOR
    from trimesh.visual.material import MultiMaterial, PBRMaterial, color_image

    if isinstance(source, MultiMaterial):
        content.notes.add("mesh ", f"'{mesh}'", " has a material for each face; drawn with the first")
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
        texture = textures.get(id(image)) or textures.setdefault(id(image), _texture(image, f"{source.name} of {mesh}"))
    rgba = linear_colors(np.array([[255] * 4 if factor is None else factor], np.uint8), srgb=not is_pbr)[0]
    mode, cutoff = (source.alphaMode, source.alphaCutoff) if is_pbr else (None, None)
    drawn = alpha_drawn(mode, cutoff, f"'{source.name}'", content.notes)
    glow = getattr(source, "emissiveFactor", None)
    red, green, blue = (0.0, 0.0, 0.0) if glow is None else np.clip(np.asarray(glow, float)[:3], 0, None).tolist()
    return Material(
        tuple(rgba[:3].tolist()),
        texture,
        float(rgba[3]),
        name=str(source.name or ""),
        emission=(red, green, blue),
        **drawn,
    )


def _texture(image: Any, name: str) -> Texture:
    """A `Texture` from a PIL image. Raises `SceneError` for one that is too large or cannot be decoded."""
    width, height = image.size
    if width * height > MAX_PIXELS:
        raise SceneError(f"texture '{name}' has {width}×{height} pixels; the limit is {MAX_PIXELS}")
    try:
        return Texture(np.array(image.convert("RGBA")), name)
    except (OSError, SyntaxError, ValueError) as error:
        raise SceneError(f"texture '{name}' cannot be decoded: {error}") from error
