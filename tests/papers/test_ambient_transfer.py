"""The figures of ambient transfer at low resolution: their claims. Times are not asserted."""

import pytest

from aolab.papers import ambient_transfer

pytestmark = pytest.mark.figures


def test_the_table_names_every_figure_that_is_a_picture():
    assert list(ambient_transfer.FIGURES) == ["fig1", "fig5", "fig7", "fig8", "fig9"]


@pytest.mark.parametrize("name", ambient_transfer.FIGURES)
def test_the_claims(draw, name):
    figure = draw("ambient_transfer", name)
    assert figure.holds, figure.verdict
