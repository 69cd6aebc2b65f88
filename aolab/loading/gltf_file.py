"""A glTF file as bytes and JSON: the header, its checks, its nodes, its buffers and the resources it names."""

import base64
import binascii
import json
import struct
import warnings
from pathlib import Path
from typing import Any

from ..errors import FileError, Notice
from .folder import Folder

Json = dict[str, Any]

GLB_MAGIC, JSON_CHUNK, BINARY_CHUNK = b"glTF", b"JSON", b"BIN\0"
# required extensions that the result is right without, or that are read here
UNDERSTOOD = {"KHR_lights_punctual", "KHR_texture_transform", "EXT_texture_webp", "KHR_xmp_json_ld"}


def read_header(path: Path) -> tuple[Json, bytes]:
    """The JSON of a `.gltf` or `.glb` file, and the binary chunk of the latter. Raises `FileError` where broken."""
    data = path.read_bytes()
    if path.suffix.lower() == ".gltf":
        return _parse(data, path), b""
    if data[:4] != GLB_MAGIC or len(data) < 20:
        raise FileError(f"{path} is not a GLB file: it starts with {data[:4]!r}, not {GLB_MAGIC!r}")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise FileError(f"{path} is GLB version {version}; only 2 is read")
    if length > len(data):
        raise FileError(f"{path} is truncated: {len(data)} of {length} bytes")
    chunks: dict[bytes, bytes] = {}
    start = 12
    while start + 8 <= length:
        size, kind = struct.unpack_from("<I4s", data, start)
        if start + 8 + size > length:
            raise FileError(f"{path} is corrupt: its chunk {kind!r} of {size} bytes reaches beyond the end")
        chunks.setdefault(kind, data[start + 8 : start + 8 + size])
        start += 8 + size
    if JSON_CHUNK not in chunks:
        raise FileError(f"{path} is corrupt: it has no JSON chunk")
    return _parse(chunks[JSON_CHUNK], path), chunks.get(BINARY_CHUNK, b"")


def _parse(data: bytes, path: Path) -> Json:
    try:
        header = json.loads(data.decode("utf-8-sig"))
    except ValueError as error:
        raise FileError(f"{path} is corrupt: its JSON cannot be parsed: {error}") from error
    if not isinstance(header, dict):
        raise FileError(f"{path} is not glTF: its JSON is a {type(header).__name__}, not an object")
    return header


def read_buffers(header: Json, binary: bytes, folder: Folder) -> dict[str, bytes]:
    """The contents of the buffers by their index. Raises `FileError` for one that is missing, refused or too short."""
    buffers = {}
    for index, buffer in enumerate(header.get("buffers", ())):
        try:
            data = resource(buffer["uri"], folder) if "uri" in buffer else binary
        except FileNotFoundError:
            raise FileError(f"its buffer '{buffer['uri']}' is missing") from None
        if len(data) < buffer["byteLength"]:
            raise FileError(f"its buffer {index} is truncated: {len(data)} of {buffer['byteLength']} bytes")
        buffers[str(index)] = data
    for index, view in enumerate(header.get("bufferViews", ())):
        start, size, length = view.get("byteOffset", 0), view["byteLength"], len(buffers[str(view["buffer"])])
        if start < 0 or size < 0 or start + size > length:
            raise FileError(f"its bufferView {index} is bytes {start} to {start + size} of a buffer of {length}")
    return buffers


def resource(uri: str, folder: Folder) -> bytes:
    """What a URI names: data in itself, or a file of the folder."""
    if not uri.startswith("data:"):
        return folder.get(uri)
    meta, _, payload = uri.partition(",")
    if not meta.endswith(";base64"):
        raise FileError(f"it holds a data URI that is not base64: '{uri[:40]}...'")
    try:
        return base64.b64decode(payload, validate=True)
    except binascii.Error as error:
        raise FileError(f"it holds a corrupt data URI '{uri[:40]}...': {error}") from error


def node_name(header: Json, index: int) -> str:
    return header["nodes"][index].get("name") or f"node {index}"


def check(header: Json) -> None:
    version = str(header.get("asset", {}).get("version", "missing"))
    if version.split(".")[0] != "2":
        raise FileError(f"its glTF version is {version}; only 2 is read")
    required = set(header.get("extensionsRequired", ()))
    unknown = sorted(name for name in required - UNDERSTOOD if not name.startswith("KHR_materials_"))
    if unknown:
        raise FileError(f"it requires {', '.join(unknown)}, which is not read; export it without (say, uncompressed)")
    if header.get("skins") or any(
        "targets" in part for mesh in header.get("meshes", ()) for part in mesh["primitives"]
    ):
        warnings.warn("skins and morph targets are not applied; drawn in the rest pose", Notice, stacklevel=5)
    for index, accessor in enumerate(header.get("accessors", ())):
        if "sparse" in accessor:
            raise FileError(f"its accessor {index} is sparse, which is not read")
        if "bufferView" not in accessor and "KHR_draco_mesh_compression" not in header.get("extensionsUsed", ()):
            raise FileError(f"its accessor {index} has no data (no bufferView)")


def nodes_in_scene(header: Json) -> list[int]:
    """The nodes of the default scene, parents first. Raises `FileError` unless they form trees, as glTF demands."""
    nodes = header.get("nodes", [])
    children = {child for node in nodes for child in node.get("children", ())}
    # without scenes, all that nothing contains
    header.setdefault("scenes", [{"nodes": [index for index in range(len(nodes)) if index not in children]}])
    header.setdefault("scene", 0)
    found: dict[int, None] = {}
    waiting = list(reversed(header["scenes"][header["scene"]].get("nodes", [])))
    while waiting:
        index = waiting.pop()
        if not isinstance(index, int) or not 0 <= index < len(nodes):
            raise FileError(f"it refers to node {index}, but has {len(nodes)} nodes")
        if index in found:
            raise FileError(f"its node '{node_name(header, index)}' is reached twice: nodes must form a tree")
        found[index] = None
        waiting.extend(reversed(nodes[index].get("children", [])))
    return list(found)
