"""Decoder for Radiance pictures (.hdr): Ward 1991, "Real Pixels", Graphics Gems II; the Radiance file format notes.

This is own code because no well-kept package reads the format: Pillow does not, and imageio misreads HDR files.
"""

import re

import numpy as np

MAX_HEADER = 1 << 16  # bytes; real headers are a few hundred
RUN_WIDTHS = range(8, 0x8000)  # scanline widths that the new run-length encoding can store


def read_header(data: bytes) -> tuple[int, int, np.ndarray, int]:
    """Height, width, the factors (3,) by which pixels must be divided, and the offset of the first pixel in bytes.

    Raises ValueError if `data` is not an RGBE picture stored row by row from the top left.
    """
    end = data.find(b"\n\n", 0, MAX_HEADER)
    if not data.startswith((b"#?RADIANCE", b"#?RGBE")) or end < 0:
        raise ValueError("it has no Radiance header")
    exposure = np.ones(3)
    for line in data[:end].decode("ascii", "replace").split("\n"):
        key, _, value = line.partition("=")
        if key == "FORMAT" and value.strip() != "32-bit_rle_rgbe":
            raise ValueError(f"its FORMAT is '{value.strip()[:40]}', not '32-bit_rle_rgbe'")
        if key in ("EXPOSURE", "COLORCORR"):  # the writer multiplied the pixels by each of them
            try:
                exposure *= np.array(value.split(), float)
            except ValueError:
                raise ValueError(f"its {key} is '{value[:40].strip()}', not a number or three") from None
    if not (np.isfinite(exposure).all() and (exposure > 0).all()):
        raise ValueError(f"its exposure is {exposure.tolist()}")
    start = data.find(b"\n", end + 2, end + 2 + 64) + 1
    resolution = data[end + 2 : start].decode("ascii", "replace").strip()
    size = re.fullmatch(r"-Y\s+(\d{1,9})\s+\+X\s+(\d{1,9})", resolution)
    if size is None:
        raise ValueError(f"its resolution line is '{resolution[:64]}', not '-Y <height> +X <width>'")
    return int(size[1]), int(size[2]), exposure, start


def decode(data: bytes, start: int, height: int, width: int) -> np.ndarray:
    """The pixels (height, width, 4) uint8: red, green and blue mantissas, and their exponent. ValueError if corrupt."""
    if width in RUN_WIDTHS and data[start : start + 2] == b"\2\2" and data[start + 2 : start + 3] < b"\x80":
        return _new_runs(data, start, height, width)
    return _flat_or_old_runs(data, start, height, width)


def _new_runs(data: bytes, at: int, height: int, width: int) -> np.ndarray:
    """A scanline starts with 2, 2 and its width. Its four components follow one by one, in runs and literals."""
    marker = bytes([2, 2, width >> 8, width & 255])
    scanlines = bytearray()
    try:
        for row in range(height):
            if data[at : at + 4] != marker:
                raise ValueError(f"row {row} of {height} does not begin as a row of {width} pixels")
            at += 4
            for _ in range(4):
                full = len(scanlines) + width
                while len(scanlines) < full:
                    count = data[at]
                    if count > 128:  # a run
                        scanlines += data[at + 1 : at + 2] * (count - 128)
                        at += 2
                    else:
                        scanlines += data[at + 1 : at + 1 + count]
                        at += 1 + count
                    if not count:
                        raise ValueError(f"row {row} of {height} has an empty run")
                if len(scanlines) > full:
                    raise ValueError(f"row {row} of {height} is longer than {width} pixels")
    except IndexError:
        raise ValueError(f"it ends in row {len(scanlines) // (4 * width)} of {height}") from None
    return np.frombuffer(scanlines, np.uint8).reshape(height, 4, width).transpose(0, 2, 1)


def _flat_or_old_runs(data: bytes, start: int, height: int, width: int) -> np.ndarray:
    """Plain pixels. A pixel 1, 1, 1, n repeats the pixel before it n times; the n of a second one counts 256-fold."""
    codes = np.frombuffer(data, np.uint8, (len(data) - start) // 4 * 4, start).reshape(-1, 4)
    repeats = (codes[:, :3] == 1).all(axis=1)
    if len(codes) >= height * width and not repeats[: height * width].any():
        return codes[: height * width].reshape(height, width, 4)
    index = np.arange(len(codes))
    source = np.maximum.accumulate(np.where(repeats, -1, index))  # the pixel that each code repeats
    if (source < 0).any():
        raise ValueError("it begins with a repetition, but there is no pixel to repeat")
    place = np.minimum(index - source - 1, 3).clip(0)  # a fourth digit counts beyond any picture already
    counts = np.where(repeats, codes[:, 3].astype(np.int64) << 8 * place, 1)
    ends = np.cumsum(counts)
    last = int(np.searchsorted(ends, height * width))
    if last == len(ends):
        raise ValueError(f"it ends after {ends[-1] if last else 0} of {height * width} pixels")
    if ends[last] != height * width:
        raise ValueError(f"its runs are longer than {height * width} pixels")
    return np.repeat(codes[source[: last + 1]], counts[: last + 1], axis=0).reshape(height, width, 4)


def radiance(rgbe: np.ndarray) -> np.ndarray:
    """Radiance (..., 3) float32 from `rgbe` (..., 4) uint8: mantissa / 256 · 2^(exponent - 128).

    An exponent of 0 gives 0. Ward's half step on the mantissa is left out, as in most readers: 0 stays 0, 1 stays 1.
    """
    scale = np.ldexp(np.float32(1), np.arange(256) - 136).astype(np.float32)
    scale[0] = 0
    return np.multiply(rgbe[..., :3], scale[rgbe[..., 3]][..., None], order="C")
