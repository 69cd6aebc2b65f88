"""A picture of any buffer, with a colour bar: grey for shares, a colour map for numbers, colours for radiance."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import ParameterError
from ..extras import missing
from .tone import shown, srgb

if TYPE_CHECKING:
    from PIL import Image

SHARES = ("visibility", "obscurance", "transfer", "transfer_multibounce", "light_share", "baked")  # in [0, 1], grey
RADIANCE = (  # linear RGB
    "direct", "ambient", "indirect", "emission", "radiance", "irradiance", "bounce", "sender",
    "open_light", "all_light", "rsm_irradiance", "rsm_interpolated", "environment_irradiance", "reflective_irradiance",
)  # fmt: skip
DIRECTIONS = (  # components in [-1, 1]
    "viewNormal", "facetNormal", "geometricNormal", "bent_normal", "tangent", "rsm_normal",
)  # fmt: skip
SPREAD = ("rsm_position", "rsm_flux")  # three numbers of any size, shown as colours from the least to the largest
FIRST = ("image", "ambient", "visibility")  # the buffer of a frame that is shown first

BACKGROUND = np.array((198, 214, 230), np.uint8)  # pale blue: in no colour map used here
PAPER, INK = (250, 250, 248), (40, 40, 40)
BAR, TICK, LINE = 16, 62, 20  # pixels: the width of the bar, of its numbers; the height of a line of text
TICKS = 5


@dataclass(frozen=True)
class Scale:
    """The values at both ends of a colour bar, and the name of the colour map."""

    low: float
    high: float
    colors: str

    def __str__(self) -> str:
        ends = {"gray": ("black ", "white "), "RdBu_r": ("blue ", "red "), "viridis": ("violet ", "yellow ")}[
            self.colors
        ]
        return f"{ends[0]}{self.low:.4g} to {ends[1]}{self.high:.4g}"

    def pixels(self, values: np.ndarray) -> np.ndarray:
        """(H, W, 3) uint8 of `values` (H, W); values that are not finite get the colour of the background."""
        share = np.clip((np.where(np.isfinite(values), values, 0) - self.low) / (self.high - self.low), 0, 1)
        index = np.rint(share * 255).astype(np.uint8)
        return np.where(np.isfinite(values)[..., None], _table(self.colors)[index], BACKGROUND)


def first_buffer(names: Iterable[str]) -> str:
    """The buffer that shows a frame best: its image, else its ambient light or visibility, else the first name."""
    names = list(names)
    if not names:
        raise ParameterError("this frame has no buffer: there is nothing to show")
    return next((name for name in FIRST if name in names), names[0])


def scale_of(name: str, values: np.ndarray) -> Scale | None:
    """The scale of the buffer `name`; None for colours and directions, which need none.

    Shares have the scale 0 to 1. Other numbers: between their percentiles 1 and 99, around 0 if they have both signs.
    """
    kind = name.removesuffix("_raw")
    if values.dtype == np.uint8 or (values.ndim == 3 and values.shape[2] == 3):
        return None
    if kind in SHARES:
        return Scale(0.0, 1.0, "gray")
    finite = values[np.isfinite(values)]
    low, high = np.percentile(finite, (1, 99)).tolist() if finite.size else (0.0, 1.0)
    if low < 0 < high:
        high = max(-low, high)
        return Scale(-high, high, "RdBu_r")
    return Scale(low, high if high > low else low + 1.0, "viridis")


def buffer_pixels(name: str, values: np.ndarray, scale: Scale | None) -> np.ndarray:
    """(H, W, 3) uint8: the picture of a buffer (H, W), (H, W, 1) or (H, W, 3), without its bar."""
    if values.dtype == np.uint8:
        return values
    if scale is not None:
        return scale.pixels(values.reshape(values.shape[:2]))
    known = np.isfinite(values).all(axis=2, keepdims=True)
    values = np.where(known, values, 0)
    kind = name.removesuffix("_raw")
    if kind in SPREAD:
        drawn = values[values.any(axis=2)]
        low, high = np.percentile(drawn, (0, 99.5), axis=0) if len(drawn) else np.zeros((2, 3))
        low, high = (low, high) if kind == "rsm_position" else (0 * low, np.full(3, high.max()))
        return srgb((values - low) / np.maximum(high - low, 1e-30) * values.any(axis=2, keepdims=True))
    if not _is_colour(kind, values):
        drawn = values.any(axis=2, keepdims=True)  # a direction of length 0 is none
        return np.where(drawn, np.rint(np.clip(values * 0.5 + 0.5, 0, 1) * 255).astype(np.uint8), BACKGROUND)
    pixels = shown(np.maximum(values, 0)) if kind in RADIANCE else srgb(values)
    return np.where(known, pixels, BACKGROUND)


def scale_in_words(name: str, values: np.ndarray) -> str:
    """The meaning of the colours in a picture of the buffer. Of 2, 4 or more channels, the picture shows the first."""
    if values.ndim == 3 and values.shape[2] not in (1, 3):
        return f"channel 1 of {values.shape[2]}, {scale_in_words(name, values[..., 0])}"
    kind = name.removesuffix("_raw")
    if (scale := scale_of(name, values)) is not None:
        return str(scale)
    if values.dtype == np.uint8:
        return "sRGB"
    if kind in SPREAD:
        return "black the least to white the largest, in sRGB"
    if kind in RADIANCE:
        return "filmic tone map, exposure 1, sRGB"
    return "linear 0 to 1, in sRGB" if _is_colour(kind, values) else "black -1 to white 1 in each channel"


def _is_colour(kind: str, values: np.ndarray) -> bool:
    """Whether three channels are a colour; otherwise they are the components of a direction."""
    return kind in (*RADIANCE, "albedo") or (kind not in DIRECTIONS and np.nanmin(values, initial=0) >= 0)


def buffer_picture(name: str, values: np.ndarray, title: str = "") -> "Image.Image":
    """The buffer `name` with its values (H, W) or (H, W, channels): a picture under a `title`, with a colour bar.

    Radiance is tone mapped; components of directions are shown as colours, from -1 to 1. A buffer of two, four or
    more channels gives a panel for each channel, all with one scale.
    """
    scale = scale_of(name, values)
    channels = values.shape[2] if values.ndim == 3 else 1
    panels = [values] if channels in (1, 3) else list(np.moveaxis(values, 2, 0))
    pixels = [buffer_pixels(name, panel, scale) for panel in panels]
    columns = 1 if len(pixels) == 1 else 2
    rows = [
        np.concatenate(pixels[i : i + columns], axis=1) for i in range(0, len(pixels) // columns * columns, columns)
    ]
    return framed(np.concatenate(rows, axis=0), scale, title or name)


def framed(pixels: np.ndarray, scale: Scale | None, title: str) -> "Image.Image":
    """`pixels` (H, W, 3) under a title, with the bar of `scale` on the right."""
    from PIL import Image, ImageDraw

    from .font import caption_font

    height, width = pixels.shape[:2]
    sheet = Image.new("RGB", (width + (BAR + TICK if scale else 0), height + LINE), PAPER)
    ImageDraw.Draw(sheet).text((2, 1), title, INK, font=caption_font(12))
    sheet.paste(Image.fromarray(pixels), (0, LINE))
    if scale:
        sheet.paste(bar_picture(scale, height), (width, LINE))
    return sheet


def bar_picture(scale: Scale, height: int) -> "Image.Image":
    """The colour bar of a scale, with numbers beside it."""
    from PIL import Image, ImageDraw

    from .font import caption_font

    bar = Image.new("RGB", (BAR + TICK, height), PAPER)
    draw = ImageDraw.Draw(bar)
    ramp = np.linspace(scale.high, scale.low, height)[:, None].repeat(BAR, axis=1)
    bar.paste(Image.fromarray(scale.pixels(ramp)), (8, 0))
    for share in np.linspace(0, 1, TICKS):
        y = min(max(round((1 - share) * (height - 1)) - 8, 0), height - 15)
        draw.text((BAR + 12, y), f"{scale.low + share * (scale.high - scale.low):.3g}", INK, font=caption_font(12))
    return bar


def _table(name: str) -> np.ndarray:
    """(256, 3) uint8: a colour map of matplotlib's. `gray` needs no matplotlib."""
    if name == "gray":
        return np.repeat(np.arange(256, dtype=np.uint8)[:, None], 3, axis=1)
    try:
        from matplotlib import colormaps
    except ImportError as error:
        raise missing("pictures", error) from error
    return (colormaps[name](np.arange(256))[:, :3] * 255).round().astype(np.uint8)
