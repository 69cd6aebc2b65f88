"""Pictures from files: textures (8 bits, sRGB) and radiance (linear, floats). Unreadable files raise `FileError`."""

import io
import warnings
from contextlib import closing
from os import PathLike
from pathlib import Path

import numpy as np
from PIL import Image

from ..errors import FileError
from . import rgbe

MAX_PIXELS = 1 << 27  # 16384 × 8192, the largest environment maps in use; 0.5 GB as RGBA, 1.6 GB as float RGB
FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "TGA", "GIF", "TIFF", "PPM")  # not EPS: Pillow runs Ghostscript for it
RADIANCE_SUFFIXES = (".exr", ".hdr")


def read_image(source: str | PathLike[str] | bytes, name: str, max_pixels: int = MAX_PIXELS) -> np.ndarray:
    """A picture, from a path or from the file's bytes, as (H, W, 4) uint8, sRGB and alpha, top row first.

    Palette, grey, 16-bit and CMYK pictures are converted to RGBA. EXIF data is ignored, its rotation included, as glTF
    requires. An animation gives its first frame. `name` is the picture's name in errors.

    Raises `FileError` if the picture is missing, is corrupt, has none of the `FORMATS`, or has more than `max_pixels`
    pixels. The size is checked before anything is decoded.
    """
    data = source if isinstance(source, bytes) else _bytes(Path(source), name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about metadata, and about the size, which is checked below
        try:
            image = Image.open(io.BytesIO(data), formats=FORMATS)
        except Image.DecompressionBombError as error:
            pixels = str(error).split(" exceeds")[0]  # "Image size (... pixels)"
            raise FileError(f"image '{name}' is refused: {pixels} exceeds the limit of {max_pixels}") from None
        except Exception as error:  # decoders raise many types on corrupt data
            raise FileError(f"image '{name}' is corrupt or none of {', '.join(FORMATS)}: {error}") from None
        _refuse_size(f"image '{name}'", image.width, image.height, max_pixels)
        if image.mode == "F":
            raise FileError(f"image '{name}' has floating-point numbers; only .exr and .hdr files may have them")
        try:
            return _rgba(image)
        except Exception as error:
            raise FileError(f"image '{name}' is corrupt: {error}") from None


def _rgba(image: Image.Image) -> np.ndarray:
    if image.mode.startswith("I"):  # Pillow would clip 16-bit values to 255 instead of scaling them
        grey = np.rint(np.clip(np.asarray(image), 0, 65535) / 257).astype(np.uint8)
        return np.dstack([grey, grey, grey, np.full_like(grey, 255)])
    return np.array(image.convert("RGBA"))


def linear_from_srgb(pixels: np.ndarray) -> np.ndarray:
    """Linear float32 in [0, 1] from sRGB uint8 `pixels` of any shape (IEC 61966-2-1)."""
    code = np.arange(256) / 255
    linear = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
    return linear.astype(np.float32)[pixels]


def read_radiance(path: str | PathLike[str], max_pixels: int = MAX_PIXELS) -> np.ndarray:
    """Linear radiance (H, W, 3) float32, top row first, from `.exr` (R, G, B or a single Y) or `.hdr`.

    NaN and infinite pixels are returned as they are. Raises `FileError` if the file is missing, is corrupt, is of
    another kind, lacks channels, or has more than `max_pixels` pixels. The size is checked before anything is decoded.
    """
    path = Path(path)
    what = f"image '{path}'"
    suffix = path.suffix.lower()
    if suffix not in RADIANCE_SUFFIXES:
        raise FileError(f"{what}: '{suffix}' is not a radiance format; known: {', '.join(RADIANCE_SUFFIXES)}")
    return _read_exr(path, what, max_pixels) if suffix == ".exr" else _read_hdr(path, what, max_pixels)


def _read_hdr(path: Path, what: str, max_pixels: int) -> np.ndarray:
    data = _bytes(path, str(path))
    try:
        height, width, exposure, start = rgbe.read_header(data)
        _refuse_size(what, width, height, max_pixels)
        radiance = rgbe.radiance(rgbe.decode(data, start, height, width))
    except ValueError as error:
        raise FileError(f"{what} is not a readable Radiance picture: {error}") from None
    return radiance if (exposure == 1).all() else (radiance / exposure).astype(np.float32)


def _read_exr(path: Path, what: str, max_pixels: int) -> np.ndarray:
    import Imath
    import OpenEXR  # imported here: most scenes need neither

    if not path.is_file():
        raise FileError(f"{what} does not exist")
    try:
        # if the pixels are corrupt, InputFile raises; OpenEXR.File prints to stdout and returns no parts
        with closing(OpenEXR.InputFile(str(path))) as file:
            header = file.header()
            window = header["dataWindow"]
            width, height = window.max.x - window.min.x + 1, window.max.y - window.min.y + 1
            _refuse_size(what, width, height, max_pixels)
            if window != header["displayWindow"]:
                raise FileError(f"{what}: its data window {window} is not its display window {header['displayWindow']}")
            names = _color_channels(header["channels"], what)
            planes = file.channels(names, Imath.PixelType(Imath.PixelType.FLOAT))
    except FileError:
        raise
    except Exception as error:  # the library raises OSError, its wrapper TypeError and others
        raise FileError(f"{what} is not a readable OpenEXR picture: {error}") from None
    pixels = np.stack([np.frombuffer(plane, np.float32).reshape(height, width) for plane in planes], axis=-1)
    return pixels if len(names) == 3 else np.repeat(pixels, 3, axis=2)


def _color_channels(channels: dict, what: str) -> list[str]:
    whole = {name for name, channel in channels.items() if (channel.xSampling, channel.ySampling) == (1, 1)}
    if whole >= {"R", "G", "B"}:
        return ["R", "G", "B"]
    if "Y" in whole and not {"RY", "BY"} & set(channels):
        return ["Y"]
    raise FileError(f"{what} has the channels {', '.join(sorted(channels))}; it needs R, G, B or a single Y")


def _bytes(path: Path, name: str) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise FileError(f"image '{name}' cannot be read: {error.strerror or error}") from None


def _refuse_size(what: str, width: int, height: int, max_pixels: int) -> None:
    if width < 1 or height < 1 or width * height > max_pixels:
        raise FileError(f"{what} is refused: {width}×{height} = {width * height} pixels, the limit is {max_pixels}")
