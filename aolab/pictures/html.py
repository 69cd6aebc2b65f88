"""HTML for notebooks, without scripts and style sheets: it also shows on GitHub and in pages of nbconvert."""

import base64
from collections.abc import Iterable, Mapping, Sequence
from html import escape as escape
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from PIL import Image

WIDEST = 480  # pixels: the width of pictures in tabs
CELL = "text-align: left; padding: 2px 10px; vertical-align: top"


class Listing(dict[str, str]):
    """Names and their descriptions: a dictionary that a notebook shows as a table."""

    def __init__(self, head: str, items: Mapping[str, str]) -> None:
        super().__init__(items)
        self.head = head

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:<{width}}  {text}" for name, text in self.items())

    def _repr_html_(self) -> str:
        return table((self.head, ""), self.items())


def png(picture: "Image.Image | np.ndarray") -> bytes:
    """The bytes of a PNG file. `picture`: an image, or pixels (H, W, 3) uint8."""
    from PIL import Image  # here: scenes are listed without pictures

    data = BytesIO()
    (picture if isinstance(picture, Image.Image) else Image.fromarray(picture)).save(data, "PNG")
    return data.getvalue()


def smaller(picture: "Image.Image", width: int = WIDEST) -> "Image.Image":
    """The picture, reduced to `width` pixels if it is wider."""
    from PIL import Image

    if picture.width <= width:
        return picture
    return picture.resize((width, round(picture.height * width / picture.width)), Image.Resampling.LANCZOS)


def img(
    picture: "Image.Image | np.ndarray | bytes", alt: str, style: str = "max-width: 100%", kind: str = "png"
) -> str:
    """An <img> with the picture in it, as PNG. `picture` may be the bytes of a file of another `kind`."""
    data = base64.b64encode(picture if isinstance(picture, bytes) else png(picture)).decode()
    return f'<img alt="{escape(alt)}" style="{style}" src="data:image/{kind};base64,{data}">'


def table(heads: Sequence[str], rows: Iterable[Sequence[object]], caption: str = "") -> str:
    """A table of texts. The texts are escaped. A table that is wider than the page scrolls."""
    top = "".join(f'<th style="{CELL}">{escape(head)}</th>' for head in heads)
    body = "".join(
        "<tr>" + "".join(f'<td style="{CELL}">{escape(str(cell))}</td>' for cell in row) + "</tr>" for row in rows
    )
    above = f"<caption>{escape(caption)}</caption>" if caption else ""
    return scrolling(f"<table>{above}<thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>")


def scrolling(wide: str) -> str:
    """HTML that scrolls to the side where the page is too narrow for it."""
    return f'<div style="overflow-x: auto">{wide}</div>'


def tabs(parts: Iterable[tuple[str, str]], group: str) -> str:
    """(title, HTML) pairs of which the browser shows one at a time: <details> with one name.

    An old browser lets the reader open several. `group` must be unique on the page.
    """
    return "".join(
        f'<details name="{escape(group)}"{" open" if not number else ""}><summary>{escape(title)}</summary>{part}'
        "</details>"
        for number, (title, part) in enumerate(parts)
    )


def slider(left: np.ndarray, right: np.ndarray, names: tuple[str, str]) -> str:
    """Two pictures of one size, one over the other; the reader draws the left one's edge with its handle.

    Without styles both pictures are shown, one after the other.
    """
    height, width = left.shape[:2]
    over = f"width: {width}px; height: {height}px; max-width: none; margin: 0"
    return (
        f"<div>{escape(names[0])} | {escape(names[1])}: drag the handle at the lower right corner of the left picture"
        f'</div><div style="position: relative; width: {width}px; height: {height}px">'
        f"{img(right, names[1], over)}"
        f'<div style="position: absolute; left: 0; top: 0; width: 50%; height: 100%; max-width: 100%; overflow: hidden;'
        f' resize: horizontal; border-right: 2px solid #d22; box-sizing: border-box">{img(left, names[0], over)}</div>'
        "</div>"
    )
