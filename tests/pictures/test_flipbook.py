"""A flipbook holds all its pictures, and its slider chooses the visible one."""

import base64
import re
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

import aolab

COLORS = {"red": (200, 30, 30), "green": (30, 200, 30), "blue <b>": (30, 30, 200)}


def book(**options) -> aolab.Flipbook:
    return aolab.Flipbook([(name, np.full((8, 16, 3), c, np.uint8)) for name, c in COLORS.items()], **options)


def test_every_picture_is_inside_and_the_first_is_visible():
    html = book(about="A square", first=1)._repr_html_()
    data = re.findall(r'src="data:image/webp;base64,([^"]+)"', html)
    pictures = [np.asarray(Image.open(BytesIO(base64.b64decode(one))).convert("RGB")) for one in data]
    assert [picture.shape for picture in pictures] == [(8, 16, 3)] * 3
    assert np.abs(np.array([picture.mean(axis=(0, 1)) for picture in pictures]) - [*COLORS.values()]).max() < 12
    assert re.findall(r"<div data-page( style=\"display: none\")?>", html) == [
        ' style="display: none"',
        "",
        ' style="display: none"',
    ]
    assert 'alt="A square: blue &lt;b&gt;"' in html
    assert "<b>" not in html


def test_no_pictures_and_a_first_picture_beyond_the_last_are_refused():
    with pytest.raises(aolab.ParameterError, match="at least one picture"):
        aolab.Flipbook([])
    with pytest.raises(aolab.ParameterError, match=r"first = 3 is outside \[0, 2\]"):
        book(first=3)


@pytest.mark.browser
def test_the_slider_turns_the_pages(chromium):
    page = chromium.new_page()
    page.set_default_timeout(60_000)
    page.set_content(book()._repr_html_() + book(first=2)._repr_html_())
    sliders = page.get_by_role("slider")
    sliders.first.press("ArrowRight")
    visible = [img.get_attribute("alt") for img in page.locator("img").all() if img.is_visible()]
    assert visible == ["green", "blue <b>"]  # the second book stays as it is
