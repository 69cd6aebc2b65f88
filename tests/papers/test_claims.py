"""Needs and verdicts; claims about costs, from given costs; and two figures that are quickly drawn, also broken."""

import json

import pytest

from aolab.papers.figure import Need, title, verdict
from aolab.papers.hao.fig6 import claimed as claimed_by_haos_figure_6
from aolab.papers.hao.fig7 import claimed as claimed_by_haos_figure_7
from aolab.papers.s3ho.table1 import PAPER as S3HO_TIMES
from aolab.papers.s3ho.table1 import claimed as claimed_by_s3hos_table
from aolab.papers.ssdo.fig1 import claimed as claimed_by_ssdos_figure_1
from aolab.papers.ssdo.table1 import PAPER as SSDO_RATES
from aolab.papers.ssdo.table1 import claimed as claimed_by_ssdos_table


def test_a_need_is_met_between_its_bounds():
    assert Need("noise", 0.49, below=0.5).met
    assert not Need("noise", 0.5, below=0.5).met
    assert not Need("noise", 0.1, above=0.1).met
    assert not Need("noise", float("nan"), above=-1).met


def test_a_verdict_gives_each_number_that_is_out_of_bounds():
    needs = [Need("noise", 0.9876, 0.1, 0.5), Need("light", 1.0, above=0.9), Need("error", 3.0, below=1)]
    assert verdict(needs[1:2]) == "holds"
    assert verdict(needs) == (
        "DOES NOT HOLD: noise is 0.988, needed above 0.1 and below 0.5; error is 3, needed below 1"
    )
    assert (
        title("Fig. 1", "It is calm", needs[1:2], "so it is")
        == "Fig. 1. Claim: It is calm. Verdict: holds. Finding: so it is."
    )


def test_a_need_is_plain_values():
    plain = Need("noise", 0.4, below=0.5).to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain == {"what": "noise", "value": 0.4, "above": None, "below": 0.5, "met": True}


# --- costs: a claim holds of the paper's own, and not if a method is slower


def unmet(needs):
    return {need.what for need in needs if not need.met}


def test_ssdos_figure_1_fails_if_the_passes_cost_more_among_many_triangles():
    assert not unmet(claimed_by_ssdos_figure_1(20.0, 19.0))
    assert unmet(claimed_by_ssdos_figure_1(30.0, 19.0))
    assert unmet(claimed_by_ssdos_figure_1(20.0, 10.0))


def lost(ssdo=1.0, bounce=1.0):
    """The shares of SSAO's frame rate that the printed ones lose, in percent, if frames took so many times as long."""
    rows = SSDO_RATES.values()
    return {
        "directional_occlusion": [100 * (1 - row[1] / ssdo / row[0]) for row in rows],
        "one_bounce": [100 * (1 - row[2] / bounce / row[0]) for row in rows],
    }


def test_ssdos_table_holds_of_its_own_frame_rates_and_not_of_slower_ones():
    assert not unmet(claimed_by_ssdos_table(lost()))
    assert len(unmet(claimed_by_ssdos_table(lost(ssdo=1.05)))) == 1
    assert len(unmet(claimed_by_ssdos_table(lost(bounce=1.05)))) == 1


def ratios(**slower):
    methods = ("SSAO", "S3HO", "SSDO", "SSBN")
    return {
        n: {name: cost * slower.get(name, 1) / row[0] for name, cost in zip(methods, row, strict=True)}
        for n, row in S3HO_TIMES.items()
    }


@pytest.mark.parametrize("slower", [{"SSBN": 1.1}, {"S3HO": 1.1}, {"SSDO": 0.6}])
def test_s3hos_table_holds_of_its_own_times_and_not_of_others(slower):
    assert not unmet(claimed_by_s3hos_table(ratios()))
    assert len(unmet(claimed_by_s3hos_table(ratios(**slower)))) >= 3  # at each number of directions


def haos_costs(grid=1.0, rays=1.0):
    """Frames of 100 ms whose rays take 80 ms at 32 rays; more voxels and more rays add their times the factors."""
    frames = {
        "voxels": {64: 100.0, 128: 101.0, 256: 100.0 + 5.0 * grid},
        "directions": {16: 60.0, 32: 100.0, 64: 180.0, 128: 60.0 + 280.0 * rays},
    }
    return frames, {16: 40.0, 128: 40.0 + 280.0 * rays}


def test_haos_figure_6_fails_if_the_grid_costs_as_much_as_rays_or_rays_cost_nothing():
    assert not unmet(claimed_by_haos_figure_6(*haos_costs()))
    assert len(unmet(claimed_by_haos_figure_6(*haos_costs(grid=40)))) == 2
    assert unmet(claimed_by_haos_figure_6(*haos_costs(rays=0.3)))
    assert unmet(claimed_by_haos_figure_6(*haos_costs(rays=2)))


def test_haos_figure_7_fails_if_triangles_cost_a_tenth_of_the_frame():
    assert not unmet(claimed_by_haos_figure_7("animated", 50.0, 55.0, 100.0))
    assert unmet(claimed_by_haos_figure_7("animated", 50.0, 61.0, 100.0))


# --- two of the figures here, too: the others, and more of their mutations, are run by `make figures`


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "edits"),
    [("fig6", ("solids without a back", "thin surfaces")), ("fig14", ("no cosines", "half the reach"))],
)
def test_a_claim_holds_and_fails_if_its_method_is_broken(draw, broken, name, edits):
    assert draw("ssdo", name).holds
    for edit in edits:
        assert not broken("ssdo", name, edit).holds
