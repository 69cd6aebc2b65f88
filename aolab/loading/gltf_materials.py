"""Materials and textures of a glTF file, each made once, when first used."""

import warnings
from typing import Any

import numpy as np

from ..errors import Notice
from ..pictures.images import read_image
from ..scene.mesh import Material, Mesh, Texture
from .folder import Folder
from .gltf_file import Json, resource
from .trimeshes import alpha_of, linear_colors


class Materials:
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
                data = resource(image["uri"], self.folder)
            except FileNotFoundError:
                text = f"{self.folder.model}: the texture '{uri}' of material '{material}' is missing; drawn without"
                warnings.warn(text, Notice, stacklevel=5)
                return None
        return Texture(read_image(data, name), name)
