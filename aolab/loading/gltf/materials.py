"""Materials and textures of a glTF file, each made once, when first used."""

from dataclasses import dataclass

import numpy as np

from ...errors import Error, FileError, shorten
from ...input import TooLarge
from ...pictures.images import read_image
from ...scene.environment import HALF_MAX
from ...scene.mesh import Material, Texture, Wrap
from ..folder import Folder
from ..materials import alpha_drawn
from ..parts import Notes
from .container import Buffers, resource
from .schema import Gltf, TextureInfo

WRAPS: dict[int, Wrap] = {10497: "repeat", 33648: "mirror", 33071: "clamp"}
NEAREST = 9728
WITHOUT_MIPMAPS = (9728, 9729)


@dataclass(frozen=True)
class Uv:
    """The UV set that a texture is drawn by, and the transform (2, 3) of its coordinates, v downwards."""

    set: int
    transform: tuple[tuple[float, float, float], ...] = ((1, 0, 0), (0, 1, 0))

    def of(self, attributes: dict[str, np.ndarray]) -> np.ndarray | None:
        """(V, 2), v upwards, from a primitive's attributes; None where it lacks the set."""
        uv = attributes.get(f"TEXCOORD_{self.set}")
        if uv is None:
            return None
        matrix = np.array(self.transform)
        u, v = (uv.astype(np.float64) @ matrix[:, :2].T + matrix[:, 2]).T
        return np.column_stack([u, 1 - v])


class Materials:
    """The file's materials and textures."""

    def __init__(self, gltf: Gltf, buffers: Buffers, folder: Folder, notes: Notes) -> None:
        self._gltf, self._buffers, self._folder, self._notes = gltf, buffers, folder, notes
        self._materials: dict[int, tuple[Material, Uv]] = {}
        self._textures: dict[int, Texture | None] = {}
        self._pixels: dict[int, np.ndarray | None] = {}

    def material(self, index: int | None, colored: bool) -> tuple[Material, Uv]:
        """A material and the UV that its textures use. None is the default: white where the vertices have colours."""
        if index is None:
            return Material(base_color=(1.0, 1.0, 1.0)) if colored else Material(), Uv(0)
        if index not in self._materials:
            self._materials[index] = self._made(index)
        return self._materials[index]

    def _made(self, index: int) -> tuple[Material, Uv]:
        source = self._gltf.materials[index]
        name = source.name or f"material {index}"
        surface, glossy = source.pbr_metallic_roughness, source.extensions.specular_glossiness
        factor, info = surface.base_color_factor, surface.base_color_texture
        if glossy is not None:
            factor, info = glossy.diffuse_factor, glossy.diffuse_texture
        red, green, blue, alpha = np.clip(factor, 0, 1).tolist()
        if not all(0 <= value <= 1 for value in factor):
            self._notes.add("material ", f"'{name}'", ": its base colour is outside [0, 1], and was clipped")
        strength = source.extensions.emissive_strength.emissive_strength
        emission = (np.clip(source.emissive_factor, 0, HALF_MAX) * strength).clip(max=HALF_MAX).tolist()
        glow = source.emissive_texture if any(emission) else None
        uv = self._uv(info or glow or source.normal_texture)
        glow = self._with_uv(glow, uv, "emissive", name)
        bumps = self._with_uv(source.normal_texture, uv, "normal", name)
        return Material(
            base_color=(red, green, blue),
            texture=self._texture(info, name),
            alpha=alpha,
            name=name,
            double_sided=source.double_sided,
            emission=(emission[0], emission[1], emission[2]),
            emission_texture=self._texture(glow, name),
            normal_texture=self._texture(bumps, name),
            normal_scale=1.0 if source.normal_texture is None else source.normal_texture.scale,
            **alpha_drawn(source.alpha_mode, source.alpha_cutoff, f"'{name}'", self._notes),
        ), uv

    def _with_uv(self, info: TextureInfo | None, uv: Uv, what: str, material: str) -> TextureInfo | None:
        """The texture if it has the UV of the material; None, with a note, for other ones."""
        if info is None or self._uv(info) == uv:
            return info
        text = f": its {what} texture was left out, as its UV are not those of the base colour's"
        self._notes.add("material ", f"'{material}'", text)
        return None

    @staticmethod
    def _uv(info: TextureInfo | None) -> Uv:
        """KHR_texture_transform: scaled, turned, moved. The rotation is that of the extension's text and example; its
        GLSL turns the other way."""  # fmt: skip
        if info is None:
            return Uv(0)
        change = info.extensions.transform
        if change is None:
            return Uv(info.tex_coord)
        (u, v), (right, down), angle = change.offset, change.scale, change.rotation
        c, s = float(np.cos(angle)), float(np.sin(angle))
        chosen = info.tex_coord if change.tex_coord is None else change.tex_coord
        return Uv(chosen, ((c * right, s * down, u), (-s * right, c * down, v)))

    def _texture(self, info: TextureInfo | None, material: str) -> Texture | None:
        """The texture, or None, with a note, where it cannot be drawn."""
        if info is None:
            return None
        if info.index not in self._textures:
            self._textures[info.index] = self._made_texture(info.index, material)
        return self._textures[info.index]

    def _made_texture(self, index: int, material: str) -> Texture | None:
        texture = self._gltf.textures[index]
        image = texture.extensions.webp.source
        image = texture.source if image is None else image
        if image is None:
            kinds = ", ".join(texture.extensions.model_extra or {}) or "no image"
            text = f": its texture is in no known format ({shorten(kinds)}); drawn without"
            self._notes.add("material ", f"'{material}'", text)
            return None
        if image not in self._pixels:
            self._pixels[image] = self._image(image, material)
        pixels = self._pixels[image]
        if pixels is None:
            return None
        sampler = None if texture.sampler is None else self._gltf.samplers[texture.sampler]
        return Texture(
            pixels,
            self._image_name(image),
            wrap=("repeat", "repeat") if sampler is None else (WRAPS[sampler.wrap_s], WRAPS[sampler.wrap_t]),
            nearest=sampler is not None and sampler.mag_filter == NEAREST,
            mipmaps=sampler is None or sampler.min_filter not in WITHOUT_MIPMAPS,
        )

    def _image_name(self, index: int) -> str:
        image = self._gltf.images[index]
        uri = image.uri or ""
        return image.name or (shorten(uri) if uri and not uri.startswith("data:") else f"image {index}")

    def _image(self, index: int, material: str) -> np.ndarray | None:
        image, name = self._gltf.images[index], self._image_name(index)
        try:
            if image.buffer_view is not None:
                data = bytes(self._buffers.view(image.buffer_view))
            elif image.uri is not None:
                data = resource(image.uri, self._folder)
            else:
                raise FileError(f"images[{index}] has neither bufferView nor uri")
            return read_image(data, name, budget=self._folder.budget)
        except FileNotFoundError:
            reason = f"its texture '{name}' is missing"
        except TooLarge:
            raise
        except Error as error:
            reason = str(error)
        self._notes.add("material ", f"'{material}'", f": {reason}; drawn without")
        return None
