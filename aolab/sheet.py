"""Contact sheets: frames side by side, each with its caption."""

from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

MARGIN, CAPTION = 8, 26  # pixels
_PAPER, _INK = (250, 250, 248), (40, 40, 40)


def gray(values: np.ndarray) -> np.ndarray:
    """(H, W) in [0, 1] as (H, W, 3) uint8; NaN, the background, is white."""
    scaled = np.clip(np.nan_to_num(values, nan=1.0), 0, 1) * 255
    return np.repeat((scaled + 0.5).astype(np.uint8)[..., None], 3, axis=2)


def contact_sheet(pictures: Sequence[tuple[str, np.ndarray]], columns: int = 2) -> Image.Image:
    """Put captioned pictures, each (H, W, 3) uint8 of one size, into rows of `columns`."""
    height, width = pictures[0][1].shape[:2]
    rows = -(-len(pictures) // columns)
    cell = width + MARGIN, height + CAPTION + MARGIN
    sheet = Image.new("RGB", (columns * cell[0] + MARGIN, rows * cell[1] + MARGIN), _PAPER)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(size=15)
    for index, (caption, picture) in enumerate(pictures):
        x, y = MARGIN + index % columns * cell[0], MARGIN + index // columns * cell[1]
        sheet.paste(Image.fromarray(picture), (x, y))
        draw.text((x + 2, y + height + 4), caption, _INK, font=font)
    return sheet
