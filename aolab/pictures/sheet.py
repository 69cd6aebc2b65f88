"""Contact sheets (pictures side by side with captions), and tables drawn as pictures."""

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from ..errors import ParameterError
from .buffers import buffer_picture, buffer_pixels, first_buffer, framed, scale_of
from .display import captioned, pixels_of, titled
from .font import Font, caption_font

MARGIN, LINE, CELL = 8, 24, 12  # pixels; CELL: the padding of a table's cell, left and right
_PAPER, _INK, _FAINT = (250, 250, 248), (40, 40, 40), (200, 200, 196)


def gray(values: np.ndarray) -> np.ndarray:
    """A grey picture (H, W, 3) uint8 of `values` (H, W) in [0, 1]. NaN, the background, is white.

    Raises `ParameterError` for anything else.
    """
    if not isinstance(values, np.ndarray) or values.ndim != 2 or values.dtype.kind not in "fiub":
        shape = f"an array {values.shape}" if isinstance(values, np.ndarray) else f"a {type(values).__name__}"
        raise ParameterError(f"gray: {shape} is no array (H, W) of shares; write aolab.gray(frame['visibility'])")
    scaled = np.clip(np.nan_to_num(values, nan=1.0), 0, 1) * 255
    return np.repeat((scaled + 0.5).astype(np.uint8)[..., None], 3, axis=2)


def contact_sheet(pictures: Sequence[Any], columns: int = 2, *, title: str = "") -> Image.Image:
    """A sheet of captioned pictures in rows of `columns`, under a `title`.

    `pictures`: frames, images and arrays (H, W, 3) uint8, or (caption, picture) pairs of these. A frame without a
    caption gets the name of its module; a frame without an image shows its first buffer. Smaller pictures are
    enlarged by whole numbers as far as they fit. Raises `ParameterError` for anything else, and for no pictures.
    """
    pairs = captioned(pictures)
    if not pairs:
        raise ParameterError("a contact sheet needs at least one picture")
    cells = [(caption, pixels_of(picture)) for caption, picture in pairs]
    height, width = (max(pixels.shape[axis] for _, pixels in cells) for axis in (0, 1))
    columns = min(columns, len(cells))
    font = caption_font(13)
    captions = [_wrapped(caption, width, font) or [""] for caption, _ in cells]
    rows = [captions[first : first + columns] for first in range(0, len(captions), columns)]
    lines = _wrapped(title, columns * (width + MARGIN) - MARGIN, font)
    heights = [height + LINE * max(map(len, row)) + MARGIN for row in rows]
    *tops, bottom = itertools.accumulate(heights, initial=MARGIN + LINE * len(lines))
    sheet = Image.new("RGB", (columns * (width + MARGIN) + MARGIN, bottom), _PAPER)
    draw = ImageDraw.Draw(sheet)
    _write(draw, lines, (MARGIN + 2, MARGIN), font)
    for index, (_, pixels) in enumerate(cells):
        x, y = MARGIN + index % columns * (width + MARGIN), tops[index // columns]
        enlarged = max(1, min(width // pixels.shape[1], height // pixels.shape[0]))
        sheet.paste(Image.fromarray(pixels.repeat(enlarged, axis=0).repeat(enlarged, axis=1)), (x, y))
        _write(draw, captions[index], (x + 2, y + height + 4), font)
    return sheet


def show(*pictures: Any, buffer: str = "", columns: int = 3, **named: Any) -> Image.Image:
    """Frames side by side, all with the same `buffer` and one colour bar.

    >>> aolab.show(frame, truth)
    >>> aolab.show(frame, truth=truth, buffer="visibility")

    The default buffer is the image, if every frame has one, or else the first buffer that all frames have. A keyword
    is the caption of its frame; other captions are the modules' names. Images and arrays (H, W, 3) uint8 may stand
    beside frames. Raises `ParameterError` if a frame lacks the buffer.
    """
    pairs = [*((titled(frame, number), frame) for number, frame in enumerate(pictures)), *named.items()]
    frames = [frame for _, frame in pairs if hasattr(frame, "buffers")]
    if not frames:
        return contact_sheet(pairs, columns)
    name = buffer or first_buffer(set.intersection(*(set(frame.buffers) for frame in frames)))
    values = [frame[name] for frame in frames]
    if any(one.ndim == 3 and one.shape[2] not in (1, 3) for one in values):  # panels, each with its own bar
        scale, draw = None, lambda frame: buffer_picture(name, frame[name])
    else:
        scale = scale_of(name, np.concatenate([one.reshape(-1, *one.shape[2:]) for one in values])[None])
        draw = lambda frame: buffer_pixels(name, frame[name], scale)  # noqa: E731
    cells = [(caption, draw(one) if hasattr(one, "buffers") else one) for caption, one in pairs]
    return framed(np.asarray(contact_sheet(cells, columns)), scale, name)


def table(rows: Sequence[Sequence[str]], *, title: str = "") -> Image.Image:
    """Draw a table under a `title`. The first row is the heading; all rows have equally many cells.

    The first column is aligned left, the others right.
    """
    font = caption_font(13)
    widths = [int(max(font.getlength(row[column]) for row in rows)) + 2 * CELL for column in range(len(rows[0]))]
    lines = _wrapped(title, sum(widths), font)
    top = MARGIN + LINE * len(lines)
    picture = Image.new("RGB", (sum(widths) + 2 * MARGIN, top + LINE * len(rows) + MARGIN), _PAPER)
    draw = ImageDraw.Draw(picture)
    _write(draw, lines, (MARGIN + 2, MARGIN), font)
    for number, row in enumerate(rows):
        y, right = top + number * LINE, MARGIN
        for column, (text, width) in enumerate(zip(row, widths, strict=True)):
            right += width
            left = right - width + CELL if column == 0 else right - CELL - font.getlength(text)
            draw.text((left, y + 3), text, _INK, font=font)
        draw.line((MARGIN, y + LINE, right, y + LINE), _FAINT if number else _INK)
    return picture


def _write(draw: ImageDraw.ImageDraw, lines: list[str], corner: tuple[int, int], font: Font) -> None:
    for number, line in enumerate(lines):
        draw.text((corner[0], corner[1] + number * LINE), line, _INK, font=font)


def _wrapped(text: str, width: float, font: Font) -> list[str]:
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and font.getlength(longer) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
