"""Small glTF files, made by hand."""

import base64
import io
import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image


def png(color: tuple[int, ...], size: tuple[int, int] = (2, 2)) -> bytes:
    stream = io.BytesIO()
    Image.new("RGBA", size, color).save(stream, "PNG")
    return stream.getvalue()


def png_header(width: int, height: int) -> bytes:
    """A PNG that claims a size and holds no pixels."""
    chunks = {b"IHDR": struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0), b"IDAT": zlib.compress(b""), b"IEND": b""}
    packed = [struct.pack(">I4s", len(d), k) + d + struct.pack(">I", zlib.crc32(k + d)) for k, d in chunks.items()]
    return b"\x89PNG\r\n\x1a\n" + b"".join(packed)


class GltfFile:
    """A glTF file under construction: one triangle in the plane z = 0, in mesh 0; node 0 holds it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.data = b""
        self.more_buffers: list[dict[str, Any]] = []  # of a .glb, behind that of `data`
        self.header: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"name": "first", "mesh": 0}],
            "meshes": [{"name": "triangle", "primitives": [{"attributes": {}}]}],
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
        }
        self.attribute("POSITION", np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32))

    def view(self, data: bytes) -> int:
        """The index of a new bufferView of `data`."""
        self.header["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data + b"\0" * (-len(data) % 4)
        return len(self.header["bufferViews"]) - 1

    def accessor(self, values: np.ndarray, **more: object) -> int:
        values = np.asarray(values)
        kind = "SCALAR" if values.ndim == 1 else f"VEC{values.shape[1]}"
        component = {"u1": 5121, "u2": 5123, "u4": 5125, "f4": 5126}[values.dtype.str[1:]]
        view = self.view(values.tobytes())
        accessor = {"bufferView": view, "componentType": component, "count": len(values), "type": kind, **more}
        self.header["accessors"].append(accessor)
        return len(self.header["accessors"]) - 1

    def attribute(self, name: str, values: np.ndarray, mesh: int = 0) -> None:
        self.header["meshes"][mesh]["primitives"][0]["attributes"][name] = self.accessor(values)

    def material(self, **material: object) -> None:
        self.header["materials"] = [{"name": "paint", **material}]
        self.header["meshes"][0]["primitives"][0]["material"] = 0

    def image(self, **image: object) -> None:
        """A material whose base colour is this image."""
        self.material(pbrMetallicRoughness={"baseColorTexture": {"index": 0}})
        self.header["textures"] = [{"source": 0}]
        self.header["images"] = [image]

    def glb(self, name: str = "model.glb") -> Path:
        self.header["buffers"] = [{"byteLength": len(self.data)}, *self.more_buffers]
        text = json.dumps(self.header).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self.data), b"BIN\0") + self.data
        path = self.folder / name
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
        return path

    def gltf(self, buffer: str | None = None, name: str = "model.gltf") -> Path:
        """The buffer in the file `buffer`, or within the JSON."""
        if buffer is None:
            uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        else:
            uri = buffer
            (self.folder / buffer).write_bytes(self.data)
        self.header["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        path = self.folder / name
        path.write_text(json.dumps(self.header))
        return path
