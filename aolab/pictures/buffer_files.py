"""Buffers in files: `.npz` for NumPy, multi-layer `.exr` for compositing programs and viewers."""

import tempfile
from collections import defaultdict
from collections.abc import Container, Mapping
from os import PathLike
from pathlib import Path
from typing import IO

import numpy as np

from ..errors import FileError
from ..input import as_path
from ..output import replacing

SUFFIXES = (".npz", ".exr")
CHANNELS = {1: "Y", 2: "XY", 3: "RGB", 4: "XYZW"}  # a viewer takes a channel A for opacity, which no buffer is


def check_suffix(path: str | PathLike[str]) -> None:
    """Raise `FileError` unless buffers can be written to a file of this name; names without a suffix mean .npz."""
    suffix = as_path(path).suffix.lower()
    if suffix and suffix not in SUFFIXES:
        raise FileError(f"cannot write {path}: buffers are written as {' or '.join(SUFFIXES)}")


def save_buffers(path: str | PathLike[str], buffers: Mapping[str, np.ndarray], directions: Container[str] = ()) -> None:
    """Write buffers (H, W) or (H, W, channels) by name; replaces `path` atomically.

    An .exr has a layer for each buffer, all float32: the channel Y of a scalar, R, G, B of a colour, X, Y, Z of the
    buffers in `directions`, X, Y, Z, W of four numbers. 8-bit values become numbers in [0, 1]. Buffers of another size
    are in a part of their own. Raises `FileError`.
    """
    check_suffix(path)
    with replacing(path) as file:
        if Path(path).suffix.lower() == ".exr":
            _write_exr(file, buffers, directions)
        else:
            np.savez_compressed(file, **buffers)  # type: ignore[arg-type]


def _write_exr(file: IO[bytes], buffers: Mapping[str, np.ndarray], directions: Container[str]) -> None:
    import OpenEXR

    layers: dict[tuple[int, ...], dict[str, np.ndarray]] = defaultdict(dict)
    for name, values in buffers.items():
        if values.dtype == np.uint8:
            values = values / np.float32(255)
        planes = values.reshape(*values.shape[:2], -1).astype(np.float32)
        names = "XYZ" if name.removesuffix("_raw") in directions else CHANNELS[planes.shape[2]]
        for index, channel in enumerate(names):
            layers[values.shape[:2]][f"{name}.{channel}"] = np.ascontiguousarray(planes[..., index])
    window = _window(*max(layers))  # all parts are shown in the largest size; the format allows no other
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "displayWindow": window}
    parts = [
        OpenEXR.Part({**header, "dataWindow": _window(height, width)}, channels, f"{width}x{height}")
        for (height, width), channels in layers.items()
    ]
    with tempfile.TemporaryDirectory() as folder:  # the library writes to a name, not to an open file
        path = Path(folder) / "buffers.exr"
        OpenEXR.File(parts).write(str(path))
        file.write(path.read_bytes())


def _window(height: int, width: int) -> tuple[np.ndarray, np.ndarray]:
    return np.zeros(2, np.int32), np.array([width - 1, height - 1], np.int32)
