"""A check of an OpenEXR file's header, before the library reads the file.

The library's Python wrapper turns names and texts of the header into Python strings. A text that is not UTF-8 ends the
whole process there (OpenEXR 3.5.3), so a damaged header is refused here. Layout: "OpenEXR File Layout", openexr.com.
"""

import struct
from collections.abc import Iterator

MAGIC = b"v/1\x01"
MULTIPART, DEEP = 0x1000, 0x0800  # bits of the version field


def check_header(data: bytes) -> None:
    """Raises ValueError for a file whose header is truncated, or holds a name or text that is not UTF-8."""
    if data[:4] != MAGIC or len(data) < 8:
        raise ValueError("it does not start with OpenEXR's magic number")
    (version,) = struct.unpack_from("<I", data, 4)
    if version & 0xFF != 2:
        raise ValueError(f"its version is {version & 0xFF}, not 2")
    if version & DEEP:
        raise ValueError("it has deep pixels, several depths each; only flat pictures are read")
    at = _check_attributes(data, 8)
    while version & MULTIPART and data[at : at + 1] != b"\0":  # a header a part, and an empty one at the end
        at = _check_attributes(data, at)


def _check_attributes(data: bytes, at: int) -> int:
    """The place behind the header at `at`."""
    while data[at : at + 1] != b"\0":
        name, at = _text(data, at, "an attribute's name")
        kind, at = _text(data, at, f"the type of attribute '{name}'")
        if at + 4 > len(data):
            raise ValueError(f"it ends within attribute '{name}'")
        (size,) = struct.unpack_from("<i", data, at)
        at += 4
        if not 0 <= size <= len(data) - at:
            raise ValueError(f"attribute '{name}' is {size} bytes long, and {len(data) - at} are left")
        for part in _texts(kind, data[at : at + size]):
            _utf8(part, f"attribute '{name}'")
        at += size
    return at + 1


def _texts(kind: str, value: bytes) -> Iterator[bytes]:
    """The texts within an attribute's value."""
    if kind == "string":
        yield value
    elif kind == "stringvector":
        at = 0
        while at + 4 <= len(value):
            (size,) = struct.unpack_from("<i", value, at)
            yield value[at + 4 : at + 4 + max(size, 0)]
            at += 4 + max(size, 0)
    elif kind == "chlist":
        at = 0
        while at < len(value) and value[at]:
            end = value.find(b"\0", at)
            end = len(value) if end < 0 else end
            yield value[at:end]
            at = end + 17  # pixel type, linear, reserved, two samplings


def _text(data: bytes, at: int, what: str) -> tuple[str, int]:
    """The text that a zero ends, and the place behind the zero."""
    end = data.find(b"\0", at, at + 256)
    if end < 0:
        raise ValueError(f"it ends within {what}, or {what} is longer than 255 characters")
    return _utf8(data[at:end], what), end + 1


def _utf8(value: bytes, what: str) -> str:
    try:
        return value.decode("utf-8")
    except UnicodeDecodeError:
        raise ValueError(f"{what} is not UTF-8: {value[:40]!r}") from None
