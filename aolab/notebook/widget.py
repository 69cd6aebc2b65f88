"""The widget of `aolab.glyph_picker`: the half in Python. The other half, in the browser, is widget.js."""

import asyncio
import threading
from pathlib import Path

import anywidget
import traitlets

from ..errors import Error
from ..pipeline.frame import Frame
from .glyph import Glyph
from .reading import glyph, lit_scene

HINT = "Click a pixel, or press an arrow key."


class GlyphPicker(anywidget.AnyWidget):
    """An image to click in. The browser sets `pixel`; Python answers with `picture`, a PNG or empty, and `message`."""

    _esm = Path(__file__).with_name("widget.js")

    image = traitlets.Bytes().tag(sync=True)
    pixel = traitlets.Tuple(traitlets.Int(), traitlets.Int(), default_value=None, allow_none=True).tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)
    message = traitlets.Unicode(HINT).tag(sync=True)

    def __init__(self, frame: Frame) -> None:
        lit_scene(frame)  # what no pixel could show is refused at once
        super().__init__(image=frame._repr_png_())
        self.frame = frame
        self.glyph: Glyph | None = None
        self._thread = threading.get_ident()
        try:
            self._loop = asyncio.get_running_loop()
        except RuntimeError:  # not in a notebook
            self._loop = None
        self.observe(self._picked, names="pixel")

    def _picked(self, _: object) -> None:
        """JupyterLab may deliver a click in a thread of its own; OpenGL answers only in the one that rendered."""
        if self._loop is None or threading.get_ident() == self._thread:
            self._show()
        else:
            self._loop.call_soon_threadsafe(self._show)

    def _show(self) -> None:
        try:
            self.glyph = None if self.pixel is None else glyph(self.frame, self.pixel)
            message = HINT if self.glyph is None else _described(self.glyph)
        except Error as error:
            self.glyph, message = None, str(error)
        with self.hold_sync():  # a picture and its description arrive together
            self.picture = b"" if self.glyph is None else self.glyph._repr_png_()
            self.message = message


def _described(glyph: Glyph) -> str:
    """For those who do not see the picture."""
    red, green, blue = glyph.irradiance
    return f"Pixel {glyph.pixel}: {glyph.visibility:.0%} open, irradiance {red:.2f}, {green:.2f}, {blue:.2f}."
