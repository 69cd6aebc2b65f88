"""The pictures of errors: sizes, colours, scales."""

import numpy as np
import pytest

from aolab.measures import compare
from aolab.measures.pictures import HEAD, MARGIN


def panels(picture, width, height):
    """Result, reference and error, cut out of the picture."""
    pixels = np.asarray(picture)
    left = [MARGIN + column * (width + MARGIN) for column in range(3)]
    return [pixels[HEAD : HEAD + height, x : x + width].astype(int) for x in left]


def picture_of(a, b, name="visibility", **options):
    """Of flat buffers, one panel 300 × 200 pixels large."""
    return panels(compare({name: a}, {name: b}, flip=False).picture(**options), 300, 200)


def flat(value):
    return np.full((200, 300), value, np.float32)


def test_panels_show_the_values():
    result, reference, _ = picture_of(flat(0.2), flat(0.8))
    assert result[100, 150].tolist() == [51, 51, 51]
    assert reference[100, 150].tolist() == [204, 204, 204]


def test_more_is_red_less_is_blue_equal_is_white():
    a = flat(0.5)
    a[:, :100], a[:, 200:] = 0.7, 0.3
    error = picture_of(a, flat(0.5))[2]
    red, white, blue = error[100, 50], error[100, 150], error[100, 250]
    assert red[0] > red[2] + 50
    assert blue[2] > blue[0] + 50
    assert white.min() > 240


def test_a_limit_sets_the_scale():
    a, b = flat(0.6), flat(0.5)
    full, faint = (picture_of(a, b, limit=limit)[2][100, 150] for limit in (0.1, 1.0))
    assert full.sum() < faint.sum() - 200  # the end of the scale is dark, near zero it is light


def test_the_background_is_grey():
    a = flat(0.5)
    a[:100] = np.nan
    for panel in picture_of(a, np.where(np.isnan(a), a, 0.4)):
        assert panel[50, 150].tolist() == [153, 153, 153]


@pytest.mark.parametrize(
    ("size", "panel"), [((10, 20), (260, 130)), ((400, 800), (480, 240)), ((200, 300), (300, 200))]
)
def test_small_pictures_are_enlarged_and_large_ones_reduced(size, panel):
    values = np.full(size, 0.5, np.float32)
    picture = compare({"visibility": values}, {"visibility": values}, flip=False).picture()
    for part in panels(picture, *panel)[:2]:
        assert part[3:-3, 3:-3].std() == 0
    assert 3 * panel[0] < picture.width < 3 * panel[0] + 200


@pytest.mark.parametrize(
    ("name", "channels"), [("bent_normal", 3), ("ambient", 3), ("viewZ", 1), ("image", 3), ("mine", 2), ("sh1", 4)]
)
def test_every_kind_of_buffer_has_a_picture(name, channels, noise):
    values = np.repeat(-noise[..., None], channels, axis=2)
    found = compare({name: values}, {name: values * 0.9}, name, flip=False)
    assert np.asarray(found.picture(name)).std() > 0


def test_directions_that_are_zero_everywhere_have_one_too():
    none = {"bent_normal": np.zeros((8, 8, 3))}
    assert compare(none, none).picture().width > 0
