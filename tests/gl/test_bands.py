"""Long draws are made in bands, so that Ctrl-C is seen; the picture is that of one draw."""

import numpy as np
import pytest

import aolab
from aolab.gl import bands
from aolab.gl.program import Programs


def test_a_program_of_unknown_cost_begins_with_one_block(gl):
    program = Programs().get("none.frag")
    found = list(bands.bands(program, (0, 16, 64, 96)))
    assert found[0] == (0, 16, 64, bands.BLOCK)
    assert sum(rows for *_, rows in found) == 96
    assert list(bands.bands(program, (0, 0, 64, 96))) == [(0, 0, 64, 96)]  # it was short


def test_the_bands_of_an_expensive_program_cover_its_region(gl):
    program = Programs().get("none.frag")
    program.seconds_a_pixel = 1.0
    (x, y, width, height), *_ = bands.bands(program, (8, 3, 64, 30))
    assert (x, y, width, height) == (8, 3, 64, bands.BLOCK)


@pytest.mark.parametrize("settings", [{}, {"accumulate": 2}, {"scale": 0.5, "filter": "bilateral"}], ids=str)
def test_the_picture_is_that_of_one_draw(monkeypatch, boxes, settings):
    whole = aolab.Lab((64, 48)).render(boxes, "ssdo", bounces=1, **settings)
    monkeypatch.setattr(bands, "PATIENCE", 0.0)  # every draw is made in blocks
    parts = aolab.Lab((64, 48)).render(boxes, "ssdo", bounces=1, **settings)
    for name in ("visibility", "indirect", "image"):
        np.testing.assert_array_equal(parts[name], whole[name])
