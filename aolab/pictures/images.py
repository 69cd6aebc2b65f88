"""Pictures from files: textures (8 bits, sRGB) and radiance (linear, floats). Unreadable files raise `FileError`."""

import io
import warnings
from contextlib import closing
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import FileError, shorten
from ..input import Budget, TooLarge, read_file
from . import exr, rgbe

if TYPE_CHECKING:
    from PIL import Image

MAX_PIXELS = 1 << 27  # 16384 × 8192, the largest environment maps in use; 0.5 GB as RGBA, 1.6 GB as float RGB
FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "TGA", "GIF", "TIFF", "PPM")  # not EPS: Pillow runs Ghostscript for it
RADIANCE_SUFFIXES = (".exr", ".hdr")


def read_image(
    source: str | PathLike[str] | bytes, name: str, max_pixels: int = MAX_PIXELS, budget: Budget | None = None
) -> np.ndarray:
    """A picture, from a path or from the file's bytes, as (H, W, 4) uint8, sRGB and alpha, top row first.

    Palette, grey, 16-bit and CMYK pictures are converted to RGBA. EXIF data is ignored, its rotation included, as glTF
    requires. An animation gives its first frame. `name` is the picture's name in errors. `budget` counts 4 bytes a
    pixel.

    Raises `FileError` if the picture is missing, is corrupt, has none of the `FORMATS`, has more than `max_pixels`
    pixels, or does not fit the budget. The size is checked before anything is decoded.
    """
    from PIL import Image  # here: most scenes have no pictures

    what, budget = f"image '{shorten(name)}'", budget or Budget()
    data = source if isinstance(source, bytes) else read_file(source, what, budget)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about metadata, and about the size, which is checked below
        try:
            image = Image.open(io.BytesIO(data), formats=FORMATS)
        except Image.DecompressionBombError as error:
            pixels = str(error).split(" exceeds")[0]  # "Image size (... pixels)"
            raise TooLarge(f"{what} is refused: {pixels} exceeds the limit of {max_pixels}") from None
        except Exception as error:  # decoders raise many types on corrupt data
            raise FileError(f"{what} is corrupt or none of {', '.join(FORMATS)}") from error
        _refuse_size(what, image.width, image.height, max_pixels)
        budget.take(4 * image.width * image.height, what)
        if image.mode == "F":
            raise FileError(f"{what} has floating-point numbers; only .exr and .hdr files may have them")
        try:
            converted = _rgba(image)
            del image  # Pillow's copy in another mode: without it, decoding takes at most three times the array
            return np.asarray(converted)
        except MemoryError:
            raise
        except Exception as error:
            raise FileError(f"{what} is corrupt{_reason(error)}") from error


def _reason(error: Exception) -> str:
    """Pillow's own words for a corrupt picture; the errors of Python that its decoders pass on are left out."""
    return f": {error}" if isinstance(error, (OSError, SyntaxError)) and str(error) and not error.args[1:] else ""


def _rgba(image: "Image.Image") -> "Image.Image":
    from PIL import Image

    if image.mode.startswith("I"):  # Pillow would clip 16-bit values to 255 instead of scaling them
        image = Image.fromarray(np.rint(np.clip(np.asarray(image), 0, 65535) / 257).astype(np.uint8))
    return image if image.mode == "RGBA" else image.convert("RGBA")


def linear_from_srgb(pixels: np.ndarray) -> np.ndarray:
    """Linear float32 from sRGB `pixels` of any shape, uint8 or floats in [0, 1] (IEC 61966-2-1)."""
    code = np.arange(256) / 255 if pixels.dtype == np.uint8 else np.asarray(pixels, np.float64)
    linear = np.where(code <= 0.04045, code / 12.92, ((np.maximum(code, 0) + 0.055) / 1.055) ** 2.4).astype(np.float32)
    return linear[pixels] if pixels.dtype == np.uint8 else linear


def read_radiance(path: str | PathLike[str], max_pixels: int = MAX_PIXELS, budget: Budget | None = None) -> np.ndarray:
    """Linear radiance (H, W, 3) float32, top row first, from `.exr` (R, G, B or a single Y) or `.hdr`.

    NaN and infinite pixels are returned as they are. `budget` counts the bytes that decoding takes: 16 a pixel for
    `.hdr`, 24 for `.exr`. Raises `FileError` if the file is missing, is corrupt, is of another kind, lacks channels,
    has more than `max_pixels` pixels, or does not fit the budget. The size is checked before anything is decoded.
    """
    path = Path(path)
    what = f"image '{shorten(str(path), 200)}'"
    suffix = path.suffix.lower()
    if suffix not in RADIANCE_SUFFIXES:
        raise FileError(f"{what}: '{suffix}' is not a radiance format; known: {', '.join(RADIANCE_SUFFIXES)}")
    budget = budget or Budget()
    data = read_file(path, what, budget)
    read = _read_exr if suffix == ".exr" else _read_hdr
    return read(data, path, what, max_pixels, budget)


def _read_hdr(data: bytes, path: Path, what: str, max_pixels: int, budget: Budget) -> np.ndarray:
    try:
        height, width, exposure, start = rgbe.read_header(data)
        _refuse_size(what, width, height, max_pixels)
        budget.take(16 * width * height, what)
        radiance = rgbe.radiance(rgbe.decode(data, start, height, width))
    except ValueError as error:
        raise FileError(f"{what} is not a readable Radiance picture: {error}") from None
    return radiance if (exposure == 1).all() else (radiance / exposure).astype(np.float32)


def _read_exr(data: bytes, path: Path, what: str, max_pixels: int, budget: Budget) -> np.ndarray:
    try:
        exr.check_header(data)
    except ValueError as error:
        raise FileError(f"{what} is not a readable OpenEXR picture: {error}") from None
    import Imath
    import OpenEXR  # imported here: most scenes need neither

    try:
        # if the pixels are corrupt, InputFile raises; OpenEXR.File prints to stdout and returns no parts
        with closing(OpenEXR.InputFile(str(path))) as file:
            header = file.header()
            window = header["dataWindow"]
            width, height = window.max.x - window.min.x + 1, window.max.y - window.min.y + 1
            _refuse_size(what, width, height, max_pixels)
            budget.take(24 * width * height, what)
            if window != header["displayWindow"]:
                raise FileError(f"{what}: its data window {window} is not its display window {header['displayWindow']}")
            names = _color_channels(header["channels"], what)
            planes = file.channels(names, Imath.PixelType(Imath.PixelType.FLOAT))
    except FileError:
        raise
    except OSError as error:  # the library's own words
        raise FileError(f"{what} is not a readable OpenEXR picture: {error}") from None
    except Exception as error:  # a type error and others of the library's wrapper
        raise FileError(f"{what} is not a readable OpenEXR picture") from error
    pixels = np.stack([np.frombuffer(plane, np.float32).reshape(height, width) for plane in planes], axis=-1)
    return pixels if len(names) == 3 else np.repeat(pixels, 3, axis=2)


def _color_channels(channels: dict, what: str) -> list[str]:
    whole = {name for name, channel in channels.items() if (channel.xSampling, channel.ySampling) == (1, 1)}
    if whole >= {"R", "G", "B"}:
        return ["R", "G", "B"]
    if "Y" in whole and not {"RY", "BY"} & set(channels):
        return ["Y"]
    names = ", ".join(map(shorten, sorted(channels)))
    raise FileError(f"{what} has the channels {shorten(names, 200)}; it needs R, G, B or a single Y")


def _refuse_size(what: str, width: int, height: int, max_pixels: int) -> None:
    if width < 1 or height < 1 or width * height > max_pixels:
        raise TooLarge(f"{what} is refused: {width}×{height} = {width * height} pixels, the limit is {max_pixels}")
