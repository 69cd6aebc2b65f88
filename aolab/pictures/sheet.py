"""Contact sheets (pictures side by side with captions), and tables drawn as pictures."""

import itertools
from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

MARGIN, LINE, CELL = 8, 24, 12  # pixels; CELL: the padding of a table's cell, left and right
_PAPER, _INK, _FAINT = (250, 250, 248), (40, 40, 40), (200, 200, 196)


def gray(values: np.ndarray) -> np.ndarray:
    """A grey picture (H, W, 3) uint8 of `values` (H, W) in [0, 1]. NaN, the background, is white."""
    scaled = np.clip(np.nan_to_num(values, nan=1.0), 0, 1) * 255
    return np.repeat((scaled + 0.5).astype(np.uint8)[..., None], 3, axis=2)


def contact_sheet(pictures: Sequence[tuple[str, np.ndarray]], columns: int = 2, *, title: str = "") -> Image.Image:
    """A sheet of captioned pictures in rows of `columns`, under a `title`.

    `pictures`: (caption, picture) pairs; the pictures are (H, W, 3) uint8, all of the same size.
    """
    height, width = pictures[0][1].shape[:2]
    font = ImageFont.load_default(size=15)
    captions = [_wrapped(caption, width, font) or [""] for caption, _ in pictures]
    rows = [captions[first : first + columns] for first in range(0, len(captions), columns)]
    lines = _wrapped(title, columns * (width + MARGIN) - MARGIN, font)
    heights = [height + LINE * max(map(len, row)) + MARGIN for row in rows]
    *tops, bottom = itertools.accumulate(heights, initial=MARGIN + LINE * len(lines))
    sheet = Image.new("RGB", (columns * (width + MARGIN) + MARGIN, bottom), _PAPER)
    draw = ImageDraw.Draw(sheet)
    _write(draw, lines, (MARGIN + 2, MARGIN), font)
    for index, (_, picture) in enumerate(pictures):
        x, y = MARGIN + index % columns * (width + MARGIN), tops[index // columns]
        sheet.paste(Image.fromarray(picture), (x, y))
        _write(draw, captions[index], (x + 2, y + height + 4), font)
    return sheet


def table(rows: Sequence[Sequence[str]], *, title: str = "") -> Image.Image:
    """Draw a table under a `title`. The first row is the heading; all rows have equally many cells.

    The first column is aligned left, the others right.
    """
    font = ImageFont.load_default(size=15)
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


_Font = ImageFont.FreeTypeFont | ImageFont.ImageFont


def _write(draw: ImageDraw.ImageDraw, lines: list[str], corner: tuple[int, int], font: _Font) -> None:
    for number, line in enumerate(lines):
        draw.text((corner[0], corner[1] + number * LINE), line, _INK, font=font)


def _wrapped(text: str, width: float, font: _Font) -> list[str]:
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and font.getlength(longer) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
