"""The figures of RSM and SSAO at low resolution: their claims."""

import pytest

from aolab.papers import rsm

pytestmark = pytest.mark.figures


@pytest.mark.parametrize("name", rsm.FIGURES)
def test_the_claims(draw, name):
    figure = draw("rsm", name)
    assert figure.holds, figure.verdict


def test_fig9_the_filter_cures_both_effects(draw):
    error = draw("rsm", "fig9").numbers["rmse_over_mean"]
    for kinds in error.values():
        assert kinds["filtered"] < 0.5 * kinds["raw"]
