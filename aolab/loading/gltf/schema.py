"""The facts of glTF 2.0's schema that a reader relies on, checked before the file is read any further.

Source: the JSON schemas of glTF 2.0 (Khronos Group, 2.0.1, github.com/KhronosGroup/glTF, specification/2.0/schema) and
of the extensions named here. Where exporters are laxer than the schema (`null`, empty lists), so is this check. A
property that no class declares is not read; `unread` names it.
"""

import json
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    AliasChoices,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic.alias_generators import to_camel
from pydantic_core import ErrorDetails, PydanticCustomError

from ...errors import FileError, shorten

# extensions that are read here, or without which the picture is the same
READ = {
    "KHR_lights_punctual",
    "KHR_texture_transform",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization",
    "KHR_draco_mesh_compression",
    "KHR_meshopt_compression",
    "EXT_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_node_visibility",
    "KHR_xmp_json_ld",
}
# extensions of surfaces: without them the shapes are right, so that a file that requires them is drawn
SURFACES = ("KHR_materials_", "KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif")
ANIMATED = {"translation", "rotation", "scale", "weights"}
COLLECTIONS = ("accessors", "animations", "bufferViews", "buffers", "cameras", "images", "materials", "meshes",
               "nodes", "samplers", "scenes", "skins", "textures")  # fmt: skip


def _index_of(collection: str) -> AfterValidator:
    """A check that a number is an index into one of the file's lists."""

    def check(value: int, info: ValidationInfo) -> int:
        count = info.context[collection] if info.context else 0
        if not 0 <= value < count:
            told = {"value": value, "count": count, "collection": collection}
            raise PydanticCustomError("index", "index {value} of {count} {collection}", told)
        return value

    return AfterValidator(check)


AccessorIndex = Annotated[int, _index_of("accessors")]
BufferIndex = Annotated[int, _index_of("buffers")]
BufferViewIndex = Annotated[int, _index_of("bufferViews")]
CameraIndex = Annotated[int, _index_of("cameras")]
ImageIndex = Annotated[int, _index_of("images")]
LightIndex = Annotated[int, _index_of("lights")]
MaterialIndex = Annotated[int, _index_of("materials")]
MeshIndex = Annotated[int, _index_of("meshes")]
NodeIndex = Annotated[int, _index_of("nodes")]
SamplerIndex = Annotated[int, _index_of("samplers")]
SceneIndex = Annotated[int, _index_of("scenes")]
SkinIndex = Annotated[int, _index_of("skins")]
TextureIndex = Annotated[int, _index_of("textures")]
Whole = Annotated[int, Field(ge=0)]
Name = Annotated[str, BeforeValidator(lambda name: name if isinstance(name, str) else json.dumps(name)),
                 AfterValidator(shorten)]  # fmt: skip
Two = Annotated[list[float], Field(min_length=2, max_length=2)]
Three = Annotated[list[float], Field(min_length=3, max_length=3)]
Four = Annotated[list[float], Field(min_length=4, max_length=4)]
Sixteen = Annotated[list[float], Field(min_length=16, max_length=16)]


class Object(BaseModel):
    """A JSON object. Properties that are not declared are kept in `model_extra`; a null property counts as absent."""

    model_config = ConfigDict(extra="allow", alias_generator=to_camel, populate_by_name=False, allow_inf_nan=False)

    extras: Any = None

    @model_validator(mode="before")
    @classmethod
    def _without_nulls(cls, data: Any) -> Any:
        return {key: value for key, value in data.items() if value is not None} if isinstance(data, dict) else data


class Extensions(Object):
    """The `extensions` of an object: those that are not declared are not read."""


class Asset(Object):
    version: str
    min_version: str | None = None
    generator: Any = None
    copyright: Any = None


class SceneObject(Object):
    name: Any = None
    nodes: list[NodeIndex] = []


class LightReference(Object):
    light: LightIndex


class Instancing(Object):
    attributes: dict[str, AccessorIndex]


class Visibility(Object):
    visible: bool = True


class NodeExtensions(Extensions):
    light: LightReference | None = Field(default=None, alias="KHR_lights_punctual")
    instancing: Instancing | None = Field(default=None, alias="EXT_mesh_gpu_instancing")
    visibility: Visibility = Field(default=Visibility(), alias="KHR_node_visibility")


class Node(Object):
    name: Name | None = None
    children: list[NodeIndex] = []
    mesh: MeshIndex | None = None
    skin: SkinIndex | None = None
    camera: CameraIndex | None = None
    matrix: Sixteen | None = None
    translation: Three | None = None
    rotation: Four | None = None
    scale: Three | None = None
    weights: list[float] | None = None
    extensions: NodeExtensions = NodeExtensions()


class Draco(Object):
    buffer_view: BufferViewIndex
    attributes: dict[str, Whole]


class PrimitiveExtensions(Extensions):
    draco: Draco | None = Field(default=None, alias="KHR_draco_mesh_compression")


class Primitive(Object):
    attributes: dict[str, AccessorIndex]
    indices: AccessorIndex | None = None
    material: MaterialIndex | None = None
    mode: Annotated[int, Field(ge=0, le=6)] = 4
    targets: list[dict[str, AccessorIndex]] = []
    extensions: PrimitiveExtensions = PrimitiveExtensions()


class Mesh(Object):
    name: Name | None = None
    primitives: list[Primitive]
    weights: list[float] | None = None


class SparseIndices(Object):
    buffer_view: BufferViewIndex
    byte_offset: Whole = 0
    component_type: Literal[5121, 5123, 5125]


class SparseValues(Object):
    buffer_view: BufferViewIndex
    byte_offset: Whole = 0


class Sparse(Object):
    count: Whole
    indices: SparseIndices
    values: SparseValues


class Accessor(Object):
    name: Any = None
    buffer_view: BufferViewIndex | None = None
    byte_offset: Whole = 0
    component_type: Literal[5120, 5121, 5122, 5123, 5125, 5126]
    count: Whole
    type: Literal["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"]
    normalized: bool = False
    sparse: Sparse | None = None
    min: Any = None
    max: Any = None


class Meshopt(Object):
    buffer: BufferIndex
    byte_offset: Whole = 0
    byte_length: Whole
    byte_stride: Annotated[int, Field(ge=1, le=256)]
    count: Whole
    mode: Literal["ATTRIBUTES", "TRIANGLES", "INDICES"]
    filter: Literal["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"] = "NONE"


class MeshoptBuffer(Object):
    fallback: bool = False


MESHOPT = AliasChoices("KHR_meshopt_compression", "EXT_meshopt_compression")  # the same JSON


class BufferViewExtensions(Extensions):
    meshopt: Meshopt | None = Field(default=None, validation_alias=MESHOPT)


class BufferView(Object):
    name: Any = None
    buffer: BufferIndex
    byte_offset: Whole = 0
    byte_length: Whole
    byte_stride: Annotated[int, Field(ge=1)] | None = None
    target: Any = None
    extensions: BufferViewExtensions = BufferViewExtensions()


class BufferExtensions(Extensions):
    meshopt: MeshoptBuffer = Field(default=MeshoptBuffer(), validation_alias=MESHOPT)


class Buffer(Object):
    name: Any = None
    uri: str | None = None
    byte_length: Whole
    extensions: BufferExtensions = BufferExtensions()

    @property
    def has_data(self) -> bool:
        """False for a buffer that stands only for the decompressed data of its views."""
        return self.uri is not None or not self.extensions.meshopt.fallback


class TextureTransform(Object):
    offset: Two = [0.0, 0.0]
    rotation: float = 0.0
    scale: Two = [1.0, 1.0]
    tex_coord: Whole | None = None


class TextureInfoExtensions(Extensions):
    transform: TextureTransform | None = Field(default=None, alias="KHR_texture_transform")


class TextureInfo(Object):
    index: TextureIndex
    tex_coord: Whole = 0
    extensions: TextureInfoExtensions = TextureInfoExtensions()


class NormalTexture(TextureInfo):
    scale: float = 1.0


class MetallicRoughness(Object):
    base_color_factor: Four = [1.0, 1.0, 1.0, 1.0]
    base_color_texture: TextureInfo | None = None
    metallic_factor: float = 0.0  # 1 by the schema; only a factor that the file states is told
    roughness_factor: Any = None  # a diffuse surface has none


class SpecularGlossiness(Object):
    diffuse_factor: Four = [1.0, 1.0, 1.0, 1.0]
    diffuse_texture: TextureInfo | None = None


class EmissiveStrength(Object):
    emissive_strength: Annotated[float, Field(ge=0)] = 1.0


class MaterialExtensions(Extensions):
    specular_glossiness: SpecularGlossiness | None = Field(default=None, alias="KHR_materials_pbrSpecularGlossiness")
    emissive_strength: EmissiveStrength = Field(default=EmissiveStrength(), alias="KHR_materials_emissive_strength")


class Material(Object):
    name: Name | None = None
    pbr_metallic_roughness: MetallicRoughness = MetallicRoughness()
    emissive_factor: Three = [0.0, 0.0, 0.0]
    emissive_texture: TextureInfo | None = None
    normal_texture: NormalTexture | None = None
    alpha_mode: Literal["OPAQUE", "MASK", "BLEND"] = "OPAQUE"
    alpha_cutoff: Annotated[float, Field(ge=0)] = 0.5
    double_sided: bool = False
    extensions: MaterialExtensions = MaterialExtensions()


class Source(Object):
    source: ImageIndex | None = None


class TextureExtensions(Extensions):
    webp: Source = Field(default=Source(), alias="EXT_texture_webp")


class Texture(Object):
    name: Name | None = None
    source: ImageIndex | None = None
    sampler: SamplerIndex | None = None
    extensions: TextureExtensions = TextureExtensions()


class Image(Object):
    name: Name | None = None
    uri: str | None = None
    buffer_view: BufferViewIndex | None = None
    mime_type: Any = None


class Sampler(Object):
    name: Any = None
    mag_filter: Literal[9728, 9729] = 9729
    min_filter: Literal[9728, 9729, 9984, 9985, 9986, 9987] = 9987
    wrap_s: Literal[33071, 33648, 10497] = 10497
    wrap_t: Literal[33071, 33648, 10497] = 10497


class Perspective(Object):
    yfov: float
    znear: float | None = None
    zfar: float | None = None
    aspect_ratio: Any = None


class Orthographic(Object):
    xmag: Any = None
    ymag: float
    znear: float | None = None
    zfar: float | None = None


class Camera(Object):
    name: Name | None = None
    type: Literal["perspective", "orthographic"]
    perspective: Perspective | None = None
    orthographic: Orthographic | None = None


class Skin(Object):
    name: Name | None = None
    inverse_bind_matrices: AccessorIndex | None = None
    joints: list[NodeIndex]
    skeleton: Any = None


class Target(Object):
    node: NodeIndex | None = None
    path: str


class Channel(Object):
    sampler: Whole
    target: Target


class AnimationSampler(Object):
    input: AccessorIndex
    output: AccessorIndex
    interpolation: Literal["LINEAR", "STEP", "CUBICSPLINE"] = "LINEAR"


class Animation(Object):
    name: Name | None = None
    channels: list[Channel]
    samplers: list[AnimationSampler]

    @model_validator(mode="after")
    def _indices(self) -> "Animation":
        for place, channel in enumerate(self.channels):
            if channel.sampler >= len(self.samplers):
                told = {"place": place, "value": channel.sampler, "count": len(self.samplers)}
                text = "its channels[{place}].sampler is index {value} of {count} samplers"
                raise PydanticCustomError("index", text, told)
        return self


class Spot(Object):
    inner_cone_angle: float = 0.0
    outer_cone_angle: float = 0.7853981633974483


class Light(Object):
    name: Name | None = None
    type: Literal["directional", "point", "spot"]
    color: Three = [1.0, 1.0, 1.0]
    intensity: float = 1.0
    range: Any = None  # a hint for culling
    spot: Spot = Spot()


class Lights(Object):
    lights: list[Light] = []


class GltfExtensions(Extensions):
    lights: Lights = Field(default=Lights(), alias="KHR_lights_punctual")


class Gltf(Object):
    """The whole file."""

    asset: Asset
    scene: SceneIndex | None = None
    scenes: list[SceneObject] = []
    nodes: list[Node] = []
    meshes: list[Mesh] = []
    accessors: list[Accessor] = []
    buffer_views: list[BufferView] = []
    buffers: list[Buffer] = []
    materials: list[Material] = []
    textures: list[Texture] = []
    images: list[Image] = []
    samplers: list[Sampler] = []
    cameras: list[Camera] = []
    skins: list[Skin] = []
    animations: list[Animation] = []
    extensions_used: list[str] = []
    extensions_required: list[str] = []
    extensions: GltfExtensions = GltfExtensions()

    def node_name(self, index: int) -> str:
        return self.nodes[index].name or f"node {index}"


def checked(data: Any) -> Gltf:
    """The file's JSON as objects.

    Raises `FileError`, which names the place of a fault, as in `nodes[0].mesh: index 7 of 1 meshes`.
    """
    if not isinstance(data, dict):
        raise FileError("is not glTF: its JSON is no object")
    version = data["asset"].get("version") if isinstance(data.get("asset"), dict) else None
    if str(version).split(".")[0] != "2":
        raise FileError(
            f"its glTF version is {'missing' if version is None else shorten(str(version))}; only 2 is read"
        )
    context = {name: _length(data.get(name)) for name in COLLECTIONS}
    context["lights"] = 0
    extensions = data.get("extensions")
    lights = extensions.get("KHR_lights_punctual") if isinstance(extensions, dict) else None
    if isinstance(lights, dict):
        context["lights"] = _length(lights.get("lights"))
    try:
        gltf = Gltf.model_validate(data, context=context)
    except ValidationError as error:
        first, *others = error.errors(include_url=False)
        more = f" (and {len(others)} more)" if others else ""
        raise FileError(f"is no valid glTF: {_told(first)}{more}") from None
    least = gltf.asset.min_version
    if least not in (None, "2.0", "2"):
        raise FileError(f"it needs a reader of glTF {shorten(least)} (asset.minVersion); only 2.0 is read")
    required = sorted({*gltf.extensions_required} - READ)
    unknown = [name for name in required if not name.startswith(SURFACES)]
    if unknown:
        names = ", ".join(map(shorten, unknown))
        raise FileError(f"it requires {names}, which is not read; export it without (say, uncompressed)")
    return gltf


def _length(value: Any) -> int:
    return len(value) if isinstance(value, list) else 0


def _told(error: ErrorDetails) -> str:
    """A fault in the file's terms: where it is, and what is wrong there."""
    kind, value, context = error["type"], error["input"], error.get("ctx", {})
    shown = shorten(json.dumps(value)) if not isinstance(value, (dict, list)) else ""
    words = {
        "missing": "is missing",
        "finite_number": f"{shown} is not finite",
        "list_type": f"{shown or 'an object'} is no list",
        "string_type": f"{shown or 'a list or object'} is no text",
        "greater_than_equal": f"{shown} is below {context.get('ge')}",
        "less_than_equal": f"{shown} is above {context.get('le')}",
        "literal_error": f"{shown or 'a list or object'} is none of {context.get('expected')}",
        "too_short": f"holds {context.get('actual_length')} numbers, not {context.get('min_length')}",
        "too_long": f"holds more than {context.get('max_length')} numbers",
        "index": error["msg"],
    }
    for beginning, text in {"int": "is no whole number", "float": "is no number", "bool": "is neither true nor false",
                            "model": "is no object", "dict": "is no object"}.items():  # fmt: skip
        if kind.startswith(f"{beginning}_"):
            words[kind] = f"{shown or 'a list or object'} {text}"
    text = words.get(kind, f"{shown} is not valid")
    return _path(error["loc"]) + (" " if text.startswith(("is ", "holds ")) else ": ") + text


def _path(location: tuple[int | str, ...]) -> str:
    """`meshes[0].primitives[0].attributes.POSITION`."""
    parts = [f"[{part}]" if isinstance(part, int) else f".{shorten(part)}" for part in location if part != "[key]"]
    return "".join(parts).lstrip(".")


def unread(gltf: Gltf) -> list[str]:
    """The extensions and properties that the file holds and that are not read, sorted.

    A property stands with the list that holds it: `materials.normalTexture`.
    """
    found = {*gltf.extensions_used, *gltf.extensions_required, *_undeclared(gltf, "")} - READ
    if any(material.pbr_metallic_roughness.metallic_factor > 0 for material in gltf.materials):
        found.add("materials.metallicFactor")
    paths = {channel.target.path for animation in gltf.animations for channel in animation.channels}
    found |= {f"animations of {shorten(path)}" for path in paths - ANIMATED}
    return sorted(map(shorten, found))


def _undeclared(item: Object, owner: str) -> Iterator[str]:
    """The undeclared properties of an object, and of the objects within it."""
    for name in item.model_extra or {}:
        yield name if isinstance(item, Extensions) or not owner else f"{owner}.{name}"
    for name, field in type(item).model_fields.items():
        value = getattr(item, name)
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, Object):
                yield from _undeclared(part, owner or str(field.alias))
