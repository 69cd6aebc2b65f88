"""The Python side of the widget `aolab.glyph_picker`. The browser side is widget.js."""

from pathlib import Path

import anywidget
import traitlets

from ..errors import Error
from ..gl.thread import handed, post
from ..pipeline.frame import Frame
from .glyph import Glyph
from .reading import glyph, lit_scene

HINT = "Click a pixel, or press an arrow key."


class GlyphPicker(anywidget.AnyWidget):
    """A clickable image. The browser sets `pixel`; Python sets `picture` (PNG bytes, or empty) and `message`."""

    _esm = Path(__file__).with_name("widget.js")

    image = traitlets.Bytes().tag(sync=True)
    pixel = traitlets.Tuple(traitlets.Int(), traitlets.Int(), default_value=None, allow_none=True).tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)
    message = traitlets.Unicode(HINT).tag(sync=True)

    @handed
    def __init__(self, frame: Frame) -> None:
        lit_scene(frame)  # raises at once if no pixel of this frame can have a glyph
        super().__init__(image=frame._repr_png_())
        self.frame = frame
        self.glyph: Glyph | None = None
        self.observe(lambda _: post(self._show), names="pixel")

    def _show(self) -> None:
        try:
            self.glyph = None if self.pixel is None else glyph(self.frame, self.pixel)
            message = HINT if self.glyph is None else _described(self.glyph)
        except Error as error:
            self.glyph, message = None, str(error)
        with self.hold_sync():  # the browser receives picture and description together
            self.picture = b"" if self.glyph is None else self.glyph._repr_png_()
            self.message = message


def _described(glyph: Glyph) -> str:
    """The picture in words, for readers who cannot see it."""
    red, green, blue = glyph.irradiance
    return f"Pixel {glyph.pixel}: {glyph.visibility:.0%} open, irradiance {red:.2f}, {green:.2f}, {blue:.2f}."
