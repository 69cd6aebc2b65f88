"""HAO's figures at low resolution: their claims, and the numbers beyond the claims. Times are not asserted."""

import pytest

from aolab.papers import hao

pytestmark = pytest.mark.figures

COST = "the cost that many triangles add to HAO's passes, as a share of the frame, {} scene"


def test_the_table_names_every_figure_that_the_module_can_show():
    assert list(hao.FIGURES) == ["fig2", "fig4", "fig5", "fig6", "fig7", "fig8", "fig9"]


@pytest.mark.parametrize("name", ["fig2", "fig4", "fig5", "fig7", "fig8", "fig9"])
def test_the_claims(draw, name):
    figure = draw("hao", name)
    assert figure.unmet <= {COST.format("animated"), COST.format("still")}, figure.verdict


def test_fig6_measures_every_parameter(draw):
    figure = draw("hao", "fig6")
    found = figure.numbers["milliseconds"]
    assert {name: list(values) for name, values in found.items()} == {
        "voxels": [64, 128, 256, 512],
        "directions": [16, 32, 64, 128],
        "filter_size": [4, 8, 16, 32],
    }
    assert all(milliseconds > 0 for values in found.values() for milliseconds in values.values())
    assert len(figure.needs) == 3


def test_fig9_more_steps_find_the_hidden_column_that_eight_partly_miss(draw):
    found = draw("hao", "fig9").numbers["added_over_rays"]["behind the front object"]
    assert found["HAO"] < 0.8 < found["HAO, 32 steps"]
