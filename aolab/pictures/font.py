"""The font of captions and numbers in pictures."""

from functools import cache
from importlib.util import find_spec
from pathlib import Path

from PIL import ImageFont

Font = ImageFont.FreeTypeFont | ImageFont.ImageFont


@cache
def caption_font(size: int) -> Font:
    """DejaVu Sans, `size` pixels high, which comes with matplotlib; without matplotlib, Pillow's own font.

    Pillow's font lacks accents, umlauts, ×, ² and Greek letters.
    """
    found = find_spec("matplotlib")
    if found is None or found.origin is None:
        return ImageFont.load_default(size)
    return ImageFont.truetype(Path(found.origin).parent / "mpl-data" / "fonts" / "ttf" / "DejaVuSans.ttf", size)
