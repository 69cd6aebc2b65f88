"""The pictures and the HTML of frames, scenes, environments and comparisons in notebooks.

The functions take any object with the attributes that they read: the classes stand in folders above this one.
"""

from collections.abc import Iterable
from itertools import count
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..errors import ParameterError
from . import html
from .buffers import buffer_picture, buffer_pixels, first_buffer, scale_of
from .tone import shown

if TYPE_CHECKING:
    from PIL import Image

PREVIEW = (320, 180)  # pixels: the render beside a scene's table
MOST_ROWS = 12
_page = count()  # a number for each output: names on one page must differ


class Shown(Protocol):
    """A frame, as far as its picture needs it."""

    info: dict[str, Any]
    timings: dict[str, float]
    frame_ms: float

    @property
    def buffers(self) -> list[str]: ...

    def __getitem__(self, name: str) -> np.ndarray: ...


def frame_picture(frame: Shown, buffer: str = "") -> "Image.Image":
    """A buffer of a frame, with a colour bar. The default is the image, or else the first buffer."""
    name = buffer or first_buffer(frame.buffers)
    return buffer_picture(name, frame[name], f"{name} of {frame.info.get('module', 'a frame')}")


def frame_pixels(frame: Shown, buffer: str = "") -> np.ndarray:
    """(H, W, 3) uint8: a buffer of a frame without a bar. A buffer of other than 1 or 3 channels shows its first."""
    name = buffer or first_buffer(frame.buffers)
    values = frame[name]
    if values.ndim == 3 and values.shape[2] not in (1, 3):
        values = values[..., 0]
    return buffer_pixels(name, values, scale_of(name, values))


def frame_png(frame: Shown) -> bytes:
    """The bytes of a PNG file: the image as it is, or else the first buffer with its bar."""
    return html.png(frame["image"] if "image" in frame.buffers else frame_picture(frame))


def frame_html(frame: Shown) -> str:
    """The image, then every other buffer, of which one is open at a time; then the times of the passes."""
    from PIL import Image

    first = first_buffer(frame.buffers)
    names = [first, *(name for name in frame.buffers if name != first and not name.endswith("_raw"))]
    parts = []
    for name in names:
        whole = name == "image"
        picture = Image.fromarray(frame[name]) if whole else html.smaller(buffer_picture(name, frame[name]))
        parts.append((name, html.img(picture, f"{name} of {frame.info.get('module', 'the frame')}")))
    rows = [(step, f"{ms:.1f}") for step, ms in frame.timings.items()]
    if frame.frame_ms:
        rows.append(("whole call", f"{frame.frame_ms:.1f}"))
    if rows:
        parts.append(("timings", html.table(("pass", "ms"), rows, str(frame.info.get("renderer", "")))))
    return html.tabs(parts, f"aolab-{id(frame)}-{next(_page)}")


def scene_html(scene: Any, picture: np.ndarray) -> str:
    """The picture of a scene beside a table of its meshes, the largest first."""
    uses: dict[int, list] = {}
    for instance in scene.instances:
        uses.setdefault(id(instance.mesh), [instance.mesh, 0])[1] += 1
    largest = sorted(uses.values(), key=lambda use: -len(use[0].faces) * use[1])
    rows = [
        (mesh.name, len(mesh.faces), times, mesh.material.name or _rgb(mesh.material.base_color))
        for mesh, times in largest[:MOST_ROWS]
    ]
    if more := len(largest) - MOST_ROWS:
        rows += [(f"{more} more", "", "", "")] if more > 0 else []
    meshes = html.table(("mesh", "triangles", "instances", "material"), rows)
    lights = [(type(light).__name__, str(light)) for light in scene.lights]
    light = html.table(("light", ""), [*lights, ("Environment", repr(scene.environment))])
    return (
        f"<div>{html.escape(repr(scene))}</div>{html.img(picture, f'A render of {scene.name}')}{meshes}"
        f"<details><summary>light</summary>{light}</details>"
    )


def comparison_html(comparison: Any) -> str:
    """Truth and result under a handle, the picture of the error, and the table of measures."""
    one = next(iter(comparison.buffers.values()))
    values = [values if values.shape[2] in (1, 3) else values[..., :1] for values in (one.reference, one.result)]
    scale = scale_of(one.name, values[0][..., 0] if values[0].shape[2] == 1 else values[0])
    truth, result = (buffer_pixels(one.name, side, scale) for side in values)
    names = f"{comparison.names[1]} (truth)", comparison.names[0]
    text = f'<pre style="overflow-x: auto; white-space: pre">{html.escape(str(comparison))}</pre>'
    error = html.img(comparison.picture(), f"{one.name}: result, truth and error")
    parts = [(f"{one.name}: truth | result", html.slider(truth, result, names)), ("error", error), ("measures", text)]
    return html.tabs(parts, f"aolab-{id(comparison)}-{next(_page)}")


def environment_png(radiance: np.ndarray) -> bytes:
    """The bytes of a PNG file: an equirectangular map (H, W, 3), tone mapped, at least 256 pixels wide."""
    from PIL import Image

    enlarged = max(1, 256 // radiance.shape[1])
    pixels = shown(radiance).repeat(enlarged, axis=0).repeat(enlarged, axis=1)
    return html.png(html.smaller(Image.fromarray(pixels)))


def titled(frame: Any, number: int) -> str:
    """The caption of a frame on a sheet: its module, or its number."""
    return str(frame.info.get("module", f"frame {number + 1}")) if hasattr(frame, "info") else f"picture {number + 1}"


def captioned(pictures: Any) -> list[tuple[str, Any]]:
    """(caption, picture) of each picture; a tuple has its own. Raises `ParameterError` for anything but a list."""
    if not isinstance(pictures, Iterable):
        raise ParameterError(f"pictures = {pictures!r:.80} is not a list of pictures")
    return [item if isinstance(item, tuple) else (titled(item, number), item) for number, item in enumerate(pictures)]


def pixels_of(picture: Any) -> np.ndarray:
    """(H, W, 3) uint8 of a frame, an image or an array. Raises `ParameterError` for anything else."""
    from PIL import Image

    if hasattr(picture, "buffers"):
        return frame_pixels(picture)
    if isinstance(picture, Image.Image):
        return np.asarray(picture.convert("RGB"))
    array = np.asarray(picture)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] != 3:
        raise ParameterError(
            f"a picture is a frame, an image or (H, W, 3) uint8, not {type(picture).__name__} of shape {array.shape}, "
            f"type {array.dtype}; aolab.gray makes a picture of shares"
        )
    return array


def _rgb(color: tuple[float, float, float]) -> str:
    return "rgb " + ", ".join(f"{part:.2g}" for part in color)
