"""Click a pixel in a notebook and see its glyph."""

from typing import TYPE_CHECKING

from ..errors import ParameterError
from ..pipeline.frame import Frame

if TYPE_CHECKING:
    from .widget import GlyphPicker


def glyph_picker(frame: Frame) -> "GlyphPicker":
    """A widget that shows `frame.image` and, beside it, the glyph of the pixel that is clicked (`aolab.glyph`).

    With the image in focus, the arrow keys move by one pixel, with Shift by ten. `picker.pixel` is the (column, row),
    to read or to set, and `picker.glyph` its `Glyph`, or None. Raises `ParameterError` without anywidget, and for a
    frame that has no image or no spherical harmonics.
    """
    try:
        from .widget import GlyphPicker
    except ImportError as error:
        raise ParameterError(f"glyph_picker needs anywidget: pip install anywidget ({error})") from error
    return GlyphPicker(frame)
