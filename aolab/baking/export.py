"""A scene as a glTF file, with its baked occlusion."""

from os import PathLike
from typing import Any

import numpy as np
import trimesh
from PIL import Image
from trimesh.exchange.gltf import export_glb
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from ..errors import FileError
from ..output import replacing
from ..scene.mesh import Material, Mesh, Texture
from ..scene.scene import Scene
from .tree import complete


def write_glb(scene: Scene, path: str | PathLike[str]) -> None:
    """Write the meshes and materials of a scene as .glb; replaces `path` atomically.

    The visibility of vertices multiplies the colour COLOR_0, which other tools draw. It stands besides in the attribute
    `_OCCLUSION`, and the colour without it in `_COLOR`; `aolab.load` reads these two. An occlusion texture is the
    material's occlusionTexture. Camera, lights, normal maps and tangents are written as `aolab.load` reads them. The
    environment, height maps and `shadow=False` of lights have no place in glTF and are not written.
    Raises `FileError` for another suffix, or if the file cannot be written.
    """
    if not str(path).lower().endswith(".glb"):
        raise FileError(f"{path}: a baked scene is written as .glb")
    result, materials = trimesh.Scene(), dict[Material, PBRMaterial]()
    for number, instance in enumerate(scene.instances):
        mesh = instance.mesh
        material = materials.setdefault(mesh.material, _material(mesh.material, len(materials)))
        name = f"{instance.name or mesh.name} {number}"
        result.add_geometry(_mesh(mesh, material), name, name, transform=instance.world_from_local)
    named = [(str(written.name), material) for material, written in materials.items()]
    data = export_glb(result, include_normals=True, tree_postprocessor=lambda tree: complete(tree, scene, named))
    with replacing(path) as file:
        file.write(data)


def _mesh(mesh: Mesh, material: PBRMaterial) -> trimesh.Trimesh:
    visual = TextureVisuals(uv=mesh.uv, material=material)
    attributes: dict[str, Any] = {} if mesh.tangents is None else {"_TANGENT": mesh.tangents}  # renamed in the tree
    if mesh.visibility is not None:
        color = np.ones((len(mesh.vertices), 4)) if mesh.colors is None else mesh.colors.astype(float)
        attributes |= {"_OCCLUSION": mesh.visibility} | ({} if mesh.colors is None else {"_COLOR": mesh.colors})
        color = np.concatenate([color[:, :3] * mesh.visibility, color[:, 3:]], axis=1)
        visual.vertex_attributes["color"] = np.rint(color.clip(0, 1) * 255).astype(np.uint8)
    return trimesh.Trimesh(
        mesh.vertices,
        mesh.faces,
        vertex_normals=mesh.normals,
        visual=visual,
        vertex_attributes=attributes,
        process=False,
        validate=False,
    )


def _material(material: Material, number: int) -> PBRMaterial:
    """The material; its number makes the name unique, as trimesh merges materials that look alike."""
    mode = "BLEND" if material.blend else "MASK" if material.alpha_cutoff is not None else "OPAQUE"
    values: dict[str, Any] = {"alphaCutoff": material.alpha_cutoff} if mode == "MASK" else {}
    return PBRMaterial(
        name=f"{material.name or 'material'} {number}",
        baseColorFactor=[*material.base_color, material.alpha],
        baseColorTexture=_image(material.texture),
        occlusionTexture=_image(material.occlusion_texture),
        emissiveFactor=np.divide(material.emission, max(1.0, *material.emission)),
        emissiveTexture=_image(material.emission_texture),
        normalTexture=_image(material.normal_texture),
        alphaMode=mode,
        doubleSided=material.double_sided,
        metallicFactor=0.0,
        roughnessFactor=1.0,
        **values,
    )


def _image(texture: Texture | None) -> Image.Image | None:
    return None if texture is None else Image.fromarray(texture.pixels)
