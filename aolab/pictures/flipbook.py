"""Pictures under a slider: a reader of a static page changes a value, without a kernel."""

from collections.abc import Sequence
from io import BytesIO
from typing import Any

from PIL import Image

from ..errors import ParameterError
from . import html
from .display import captioned, pixels_of

QUALITY = 90  # of WebP: a page with ten pictures of 400 × 225 is lighter than 0.5 MB
MOVE = (
    "const pages = this.closest('figure').querySelectorAll('[data-page]');"
    " pages.forEach((page, number) => page.style.display = number == this.value ? '' : 'none')"
)


class Flipbook:
    """Pictures of which one is visible at a time; a slider under them chooses it.

    >>> aolab.Flipbook([(f"radius {r}", aolab.render("boxes", radius=r)) for r in (0.1, 0.3, 1.0)])

    `pictures` are as for `contact_sheet`: frames, images and arrays (H, W, 3) uint8, or (caption, picture) pairs. The
    caption names the value that changes. `about` describes the pictures for a person who cannot see them. `first` is
    the number of the picture that is visible at first. Arrow keys move the slider.

    A notebook and a static page show it, since it contains all pictures. A viewer that removes scripts and styles shows
    the pictures below each other. Raises `ParameterError` for no pictures, and for a `first` that is none of them.
    """

    def __init__(self, pictures: Sequence[Any], about: str = "", first: int = 0) -> None:
        pairs = captioned(pictures)
        if not pairs:
            raise ParameterError("a flipbook needs at least one picture")
        if not 0 <= first < len(pairs):
            raise ParameterError(f"flipbook: first = {first} is outside [0, {len(pairs) - 1}]")
        self.pages = [(caption, Image.fromarray(pixels_of(picture))) for caption, picture in pairs]
        self.about, self.first = about, first

    def __repr__(self) -> str:
        return f"<Flipbook: {', '.join(caption for caption, _ in self.pages)}>"

    def _repr_html_(self) -> str:
        pages = "".join(self._page(number) for number in range(len(self.pages)))
        slider = (
            f'<input type="range" min="0" max="{len(self.pages) - 1}" value="{self.first}" style="width: 100%"'
            f' aria-label="{html.escape(self.about or "picture")}" oninput="{html.escape(MOVE)}">'
        )
        return f'<figure style="margin: 0">{pages}{slider}</figure>'

    def _page(self, number: int) -> str:
        caption, picture = self.pages[number]
        alt = f"{self.about}: {caption}" if self.about else caption
        style = "" if number == self.first else ' style="display: none"'
        image = html.img(_webp(picture), alt, "width: 100%", "webp")
        return f"<div data-page{style}>{image}<div>{html.escape(caption)}</div></div>"


def _webp(picture: Image.Image) -> bytes:
    data = BytesIO()
    picture.save(data, "WEBP", quality=QUALITY)
    return data.getvalue()
