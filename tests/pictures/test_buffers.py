"""The scale of a buffer's picture, in words."""

import numpy as np
import pytest

from aolab.pictures.buffers import scale_in_words

RISING = np.linspace(2, 4, 101, dtype=np.float32).reshape(1, 101)
COLOUR = np.stack([RISING] * 3, axis=-1)
WORDS = {
    "visibility": (RISING, "black 0 to white 1"),
    "visibility_raw": (RISING, "black 0 to white 1"),
    "viewZ": (RISING, "violet 2.02 to yellow 3.98"),  # percentiles 1 and 99
    "difference": (RISING - 3.5, "blue -1.48 to red 1.48"),
    "radiance": (COLOUR, "filmic tone map, exposure 1, sRGB"),
    "viewNormal": (COLOUR, "black -1 to white 1 in each channel"),
    "anything": (COLOUR, "linear 0 to 1, in sRGB"),
    "anything signed": (COLOUR - 3, "black -1 to white 1 in each channel"),
    "image": (COLOUR.astype(np.uint8), "sRGB"),
    "sh0": (np.concatenate([COLOUR, COLOUR[..., :1] * 9], axis=-1), "channel 1 of 4, violet 2.02 to yellow 3.98"),
}


@pytest.mark.parametrize("name", WORDS)
def test_words_name_the_numbers_at_the_ends(name):
    values, words = WORDS[name]
    assert scale_in_words(name, values) == words
