"""PNG files with the settings that made them, in a JSON text chunk named `aolab`."""

import io
import json
from os import PathLike
from typing import Any

import numpy as np

from ..errors import FileError
from ..input import Budget, as_path, read_file
from ..output import replacing

KEYWORD = "aolab"


def save_png(path: str | PathLike[str], image: np.ndarray, info: dict[str, Any]) -> None:
    """Write `image` (H, W, 3) uint8 as PNG, with `info` as JSON in its metadata. Raises `FileError`.

    An existing file is replaced atomically.
    """
    from PIL import Image, PngImagePlugin  # here: not every render is saved

    if as_path(path).suffix.lower() != ".png":
        raise FileError(f"cannot write {path}: images are written as .png")
    text = PngImagePlugin.PngInfo()
    text.add_text(KEYWORD, json.dumps(info))
    with replacing(path) as file:
        # a render's noise hardly compresses: level 1 is several times faster than level 6, and the file 4 % larger
        Image.fromarray(image).save(file, "PNG", pnginfo=text, compress_level=1)


def read_png(path: str | PathLike[str]) -> dict[str, Any]:
    """The `info` of a PNG that `save_png` wrote. Raises `FileError` if the file is missing, or has none."""
    from PIL import Image, UnidentifiedImageError

    data = read_file(path, str(path), Budget())
    try:
        with Image.open(io.BytesIO(data), formats=["PNG"]) as image:
            text = getattr(image, "text", {}).get(KEYWORD)
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        raise FileError(f"{path} is no readable PNG") from error
    if text is None:
        raise FileError(f"{path} has no aolab metadata: it was not saved by aolab")
    try:
        info = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FileError(f"{path}: its aolab metadata is damaged: {error}") from error
    if not isinstance(info, dict):
        raise FileError(f"{path}: its aolab metadata is damaged: no JSON object")
    return info
