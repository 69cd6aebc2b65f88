"""STL, binary and ASCII: triangles without anything else. The facets' normals are not read: the corners tell them.

Source: 3D Systems, "StereoLithography Interface Specification", 1989.
"""

import re
from pathlib import Path

import numpy as np

from ..errors import FileError
from .folder import Folder, utf_16
from .numbers import numbers
from .options import FileOptions
from .parts import Content, Notes, Part, Placed

HEADER, TRIANGLE = 84, 50  # bytes of a binary file's header, with the count, and of a triangle
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
_LINE = re.compile(rb"\bvertex([^\n]*)")
_FACET, _END, _NORMAL = (
    re.compile(word, re.IGNORECASE) for word in (rb"\bouter\s+loop\b", rb"\bendloop\b", rb"\bfacet\s+normal\b")
)


def read(data: bytes, path: Path, folder: Folder, options: FileOptions, root: np.ndarray) -> Content:
    """The part of an STL file, at the pose `root`. Raises `FileError`."""
    notes = Notes()
    if encoding := utf_16(data):
        data = data.decode(encoding, "replace").encode("latin-1", "replace")
    if _is_text(data):
        corners = _ascii(data)
        if b"endsolid" not in data and b"ENDSOLID" not in data:
            notes.add("it does not end with 'endsolid', and may be truncated")
    else:
        corners = _binary(data)
    faces = np.arange(len(corners)).reshape(-1, 3)
    return Content([Placed(Part(corners, faces, name=path.stem), root, path.stem)], notes=notes)


def _is_text(data: bytes) -> bool:
    """Binary files may begin with "solid", too: the word alone does not decide where the size fits a binary file."""
    begins = data[:256].lstrip(b"\xef\xbb\xbf \t\r\n").lower()
    if not begins.startswith((b"solid", b"facet")):
        return False
    count = int.from_bytes(data[80:HEADER], "little")
    fits = len(data) >= HEADER and count > 0 and len(data) == HEADER + TRIANGLE * count
    return not fits and (b"\0" not in data[:HEADER] or _FACET.search(data) is not None)


def _binary(data: bytes) -> np.ndarray:
    """(3 F, 3) float32. Bytes behind the triangles are not read."""
    count = int.from_bytes(data[80:HEADER], "little")
    expected = HEADER + TRIANGLE * count
    if len(data) < expected or len(data) < HEADER:
        raise FileError(f"is truncated or no STL file: {len(data)} of {expected} bytes")
    row = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    return np.frombuffer(data, row, count, HEADER)["corners"].reshape(-1, 3)


def _ascii(data: bytes) -> np.ndarray:
    """(3 F, 3) float64."""
    name, newline, rest = data.replace(b"\r", b"\n").lstrip(b"\xef\xbb\xbf \t\n").partition(b"\n")
    body = rest if newline and _NORMAL.search(name) is None else name + newline + rest
    # exporters write a vertex a line: those lines alone are read; other layouts take three times as long
    lines = _LINE.findall(body)
    facets = body.count(b"outer loop")
    quick = numbers(b" ".join(lines), float, 9 * facets)
    if quick is not None and facets == body.count(b"endloop") > 0:
        return quick.reshape(-1, 3)
    facets, ends = (len(pattern.findall(body)) for pattern in (_FACET, _END))
    words = [word for vertex in _VERTEX.findall(body) for word in vertex]
    if len(words) != 9 * facets or ends != facets:
        found = f"{facets} facets hold {len(words) // 3} vertices of three numbers, and {ends} end"
        raise FileError(f"is truncated or corrupt: {found}")
    values = numbers(b" ".join(words), float, len(words))
    if values is None:
        wrong = next(place for place, word in enumerate(words) if numbers(word, float, 1) is None)
        raise FileError(f"is corrupt: vertex {wrong // 3} holds {words[wrong][:40]!r}, no number")
    return values.reshape(-1, 3)
