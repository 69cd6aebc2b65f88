"""The table of buffers: rows that fit their formats, and the same shapes in renders, references and comparisons."""

import numpy as np
import pytest

import aolab
from aolab import Module
from aolab.gl.texture import FORMATS
from aolab.measures.quantities import KINDS, kind_of
from aolab.modules import known_buffers
from aolab.modules.buffers import Buffer
from aolab.truth.buffers import BUFFERS


@pytest.mark.parametrize("row", known_buffers().values(), ids=lambda row: row.name)
def test_a_row_is_whole(row):
    assert row.about.endswith(".")
    assert row.kind in KINDS
    assert row.channels >= 1
    assert not row.format or FORMATS[row.format][0] >= row.channels


def test_the_reference_has_the_channels_and_the_background_of_the_table(boxes):
    """All of its buffers, of a scene with sky around it."""
    table = known_buffers()
    truth = aolab.reference(boxes, size=(16, 12), rays=4, radius=1.0, buffers=[*BUFFERS, "image"], cache=False)
    assert not truth.mask.all()
    for name in [*BUFFERS, "image"]:
        row, values = table[name], truth[name]
        assert (values.shape[2] if values.ndim == 3 else 1) == row.channels, name
        if row.background is not None:
            np.testing.assert_array_equal(values[~truth.mask], row.background, name)


def test_a_module_adds_rows_that_its_frames_follow(lab, boxes):
    class Slope(Module):
        outputs = {"visibility": "R16F", "slope": "RGBA16F"}  # noqa: RUF012
        buffers = (Buffer("slope", 2, "RGBA16F", "", np.nan, "numbers", "Two numbers, and two of padding."),)
        shader = """
        out float visibility;
        out vec4 slope;
        void main() { visibility = 1.0; slope = vec4(0.25, 0.5, 0.75, 1.0); }
        """

    frame = lab.render(boxes, Slope, filter="none")
    assert frame["slope"].shape == (48, 64, 2)
    assert frame["slope_raw"].shape == (48, 64, 2)
    assert frame.channels("slope").shape == (48, 64, 4)


def test_comparisons_measure_a_buffer_by_its_kind():
    assert kind_of("bent_normal").error == "angle"
    assert kind_of("sh2_raw").error == kind_of("sh").error == kind_of("sh_band1").error == "norm"
    assert kind_of("ambient").picture == "tone mapped"
    assert kind_of("slope_of_my_own").picture is None
