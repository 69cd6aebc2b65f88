"""A widget for notebooks: a click on a pixel shows its glyph."""

from typing import TYPE_CHECKING

from ..extras import missing
from ..pipeline.frame import Frame

if TYPE_CHECKING:
    from .widget import GlyphPicker


def glyph_picker(frame: Frame) -> "GlyphPicker":
    """A widget that shows `frame.image` and, beside it, the glyph of the clicked pixel (`aolab.glyph`).

    If the image has the focus, the arrow keys move the pixel by one, with Shift by ten. `picker.pixel` is the
    (column, row) and can be set. `picker.glyph` is the pixel's `Glyph`, or None. Raises `ParameterError` if anywidget
    is not installed, or if the frame has no image or no spherical harmonics.
    """
    try:
        from .widget import GlyphPicker
    except ImportError as error:
        raise missing("notebook", error) from error
    return GlyphPicker(frame)
