"""A glTF file as JSON and bytes: the GLB container, URIs, buffers."""

import base64
import binascii
import json
import struct
from pathlib import Path
from typing import Any

from ...errors import FileError, shorten
from ...input import TooLarge
from ..folder import Folder
from ..parts import Notes
from .meshopt import decompressed
from .schema import BufferView, Gltf, Meshopt

GLB_MAGIC, JSON_CHUNK, BINARY_CHUNK = b"glTF", b"JSON", b"BIN\0"


def read_json(data: bytes, path: Path) -> tuple[Any, bytes]:
    """The JSON of a `.gltf` or `.glb` file, and the binary chunk of the latter. Raises `FileError` where broken."""
    if path.suffix.lower() == ".gltf" and data[:4] != GLB_MAGIC:
        return _parse(data), b""
    if data[:4] != GLB_MAGIC or len(data) < 20:
        raise FileError(f"is not a GLB file: it starts with {data[:4]!r}, not {GLB_MAGIC!r}")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise FileError(f"is GLB version {version}; only 2 is read")
    if length > len(data):
        raise FileError(f"is truncated: {len(data)} of {length} bytes")
    chunks: dict[bytes, bytes] = {}
    start = 12
    while start + 8 <= length:
        size, kind = struct.unpack_from("<I4s", data, start)
        if start + 8 + size > length:
            raise FileError(f"is corrupt: its chunk {kind!r} of {size} bytes reaches beyond the end")
        chunks.setdefault(kind, data[start + 8 : start + 8 + size])
        start += 8 + size
    if JSON_CHUNK not in chunks:
        raise FileError("is corrupt: it has no JSON chunk")
    return _parse(chunks[JSON_CHUNK]), chunks.get(BINARY_CHUNK, b"")


def _parse(data: bytes) -> Any:
    try:
        return json.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise FileError(f"is corrupt: its JSON is not UTF-8 at byte {error.start}") from error
    except json.JSONDecodeError as error:
        raise FileError(f"is corrupt: its JSON cannot be parsed: {error}") from error
    except (ValueError, RecursionError) as error:  # a number of 5000 digits; brackets within brackets
        raise FileError(
            "is corrupt: its JSON cannot be parsed: a number is too long, or the nesting too deep"
        ) from error


class Buffers:
    """The bytes of a file's buffers and images, each read when first asked for."""

    def __init__(self, gltf: Gltf, binary: bytes, folder: Folder, notes: Notes) -> None:
        self._gltf, self._binary, self._folder, self._notes = gltf, binary, folder, notes
        self._read: dict[int, bytes] = {}
        self._decompressed: dict[int, memoryview | None] = {}

    def buffer(self, index: int) -> bytes:
        """The bytes of `buffers[index]`. Raises `FileError` for a buffer that is missing, refused or too short."""
        if index not in self._read:
            buffer, where = self._gltf.buffers[index], f"buffers[{index}]"
            try:
                data = self._binary if buffer.uri is None else resource(buffer.uri, self._folder)
            except FileNotFoundError:
                raise FileError(f"{where}: the file '{shorten(buffer.uri or '')}' is missing") from None
            if len(data) < buffer.byte_length:
                raise FileError(f"{where} is truncated: {len(data)} of {buffer.byte_length} bytes")
            self._read[index] = data
        return self._read[index]

    def view(self, index: int) -> memoryview:
        """The bytes of `bufferViews[index]`, decompressed.

        Raises `FileError` where they reach beyond the buffer, or cannot be decompressed.
        """
        view = self._gltf.buffer_views[index]
        if view.extensions.meshopt is not None:
            if index not in self._decompressed:
                self._decompressed[index] = self._by_meshopt(index, view.extensions.meshopt)
            data = self._decompressed[index]
            if data is not None:
                return data
        return self._slice(index, view)

    def _slice(self, index: int, view: BufferView | Meshopt) -> memoryview:
        data, end = self.buffer(view.buffer), view.byte_offset + view.byte_length
        if end > len(data):
            raise FileError(
                f"bufferViews[{index}]: bytes {view.byte_offset} to {end} of buffers[{view.buffer}], "
                f"which has {len(data)}"
            )
        return memoryview(data)[view.byte_offset : end]

    def _by_meshopt(self, index: int, meshopt: Meshopt) -> memoryview | None:
        """The decompressed bytes; None, with a note, where they cannot be had, and the file has the plain ones too."""
        try:
            return decompressed(self._slice(index, meshopt), meshopt, f"bufferViews[{index}]", self._folder.budget)
        except TooLarge:
            raise
        except FileError as error:
            if not self._gltf.buffers[self._gltf.buffer_views[index].buffer].has_data:
                raise
            self._notes.add("drawn from its plain arrays: ", str(error), separator="; ")
            return None


def resource(uri: str, folder: Folder) -> bytes:
    """The bytes that a URI stands for: data in the URI itself, or a file of the folder.

    Raises `FileError` for a file that is refused, `FileNotFoundError` for a missing one.
    """
    if not uri.startswith("data:"):
        return folder.get(uri)
    meta, _, payload = uri.partition(",")
    folder.budget.take(len(payload) * 3 // 4, f"the data URI '{uri[:40]}...'")
    if not meta.endswith(";base64"):
        raise FileError(f"it holds a data URI that is not base64: '{uri[:40]}...'")
    try:
        return base64.b64decode(payload, validate=True)
    except (binascii.Error, ValueError):
        raise FileError(f"it holds a data URI that is no valid base64: '{uri[:40]}...'") from None
