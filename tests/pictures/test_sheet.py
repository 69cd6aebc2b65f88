"""Contact sheets and tables: all pictures and texts are drawn, and none is covered."""

import numpy as np
import pytest
from PIL import Image

from aolab.errors import ParameterError
from aolab.pictures.sheet import LINE, MARGIN, contact_sheet, gray, table

RED = np.full((20, 300, 3), (255, 0, 0), np.uint8)


def count(picture: Image.Image, color: tuple[int, int, int]) -> int:
    return int((np.asarray(picture) == color).all(axis=-1).sum())


def ink(picture: Image.Image, rows: slice) -> int:
    return int((np.asarray(picture)[rows] < 128).all(axis=-1).sum())


def test_pictures_are_in_rows_with_their_captions():
    sheet = contact_sheet([("one", RED), ("two", RED), ("three", RED)], 2)
    assert sheet.size == (2 * (300 + MARGIN) + MARGIN, 2 * (20 + LINE + MARGIN) + MARGIN)
    assert count(sheet, (255, 0, 0)) == 3 * RED[..., 0].size
    assert ink(sheet, slice(0, MARGIN + 20)) == 0
    assert ink(sheet, slice(MARGIN + 20, MARGIN + 20 + LINE)) > 50


def test_a_caption_is_wrapped_to_its_picture_and_not_into_the_next():
    plain, long = contact_sheet([("", RED)], 1), contact_sheet([("seven words " * 12, RED), ("", RED)], 2)
    assert long.height - plain.height >= 2 * LINE
    assert not (np.asarray(long)[:, 300 + 2 * MARGIN :] < 128).all(axis=-1).any()


def test_a_title_is_wrapped_above_the_pictures():
    plain, long = contact_sheet([("", RED)], 1), contact_sheet([("", RED)], 1, title="seven words " * 20)
    assert (long.height - plain.height) % LINE == 0
    assert long.height - plain.height >= 4 * LINE
    assert count(long, (255, 0, 0)) == RED[..., 0].size
    assert not (np.asarray(long)[:, -4:] < 128).any()  # no word leaves the sheet


def test_a_table_has_its_rows_and_columns():
    drawn = table([["size", "N"], ["640", "8"], ["1600", "16"]], title="a title that is longer than the table")
    wider = table([["size", "N"], ["640", "8"], ["1600", "16 and more than that"]])
    assert wider.width > drawn.width
    one_less = table([["size", "N"], ["640", "8"]])
    assert wider.height - one_less.height == LINE


def test_gray_is_white_in_the_background():
    assert gray(np.array([[0.0, 0.5, 1.0, 2.0, np.nan]]))[0, :, 0].tolist() == [0, 128, 255, 255, 255]


@pytest.mark.parametrize("values", [5, [0.5], np.zeros(3), np.zeros((2, 2, 3)), "visibility"])
def test_gray_of_anything_but_shares_is_refused(values):
    with pytest.raises(ParameterError, match=r"no array \(H, W\) of shares"):
        gray(values)


@pytest.mark.parametrize(("one", "other"), [("é", "ö"), ("²", "³"), ("π", "µ"), ("×", "–")])
def test_captions_have_accents_and_mathematical_characters(one, other):
    """A font draws all characters that it lacks as the same box."""
    picture = np.zeros((20, 40, 3), np.uint8)
    sheets = [np.asarray(contact_sheet([(caption, picture)])) for caption in (one, other)]
    assert (sheets[0] != sheets[1]).any()
