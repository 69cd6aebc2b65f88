"""A claim does not hold any more if its method is broken: each figure, drawn with edited shaders."""

import pytest

from aolab.papers import PAPERS
from aolab.papers.reproduce import figures

pytestmark = pytest.mark.figures

OPEN = "30 % of blocked directions open"
MUTATIONS = {
    ("ssdo", "fig3"): (OPEN, "no cosines", "one direction for all", "the other side's light", "grey senders"),
    ("ssdo", "fig4"): (OPEN, "no cosines", "back-facing senders"),
    ("ssdo", "fig6"): ("no limit to the segment", "thin surfaces", "solids without a back"),
    ("ssdo", "fig7"): (OPEN, "no further views", "senders of half the area"),
    ("ssdo", "fig9"): ("no gap", "only the near half of the gap", "no slope in the gap"),
    ("ssdo", "fig10"): ("no gap", "lights from one side"),
    ("ssdo", "fig11"): ("no gap", "virtual lights that send to all sides"),
    ("ssdo", "fig12"): ("no near field", "all of the near field", "half of the near field"),
    ("rsm", "fig1"): ("a map without the lamp's cone", "the depth of a ray"),
    ("rsm", "fig5"): ("pixel lights that send to all sides", "pixel lights of half the flux"),
    ("rsm", "fig7"): ("a sixteenth of the occlusion", "a tenth of the reach"),
    ("rsm", "fig9"): ("one angle for all pixels", "the mean of 2×2 pixels"),
    ("ssdo", "fig13"): (OPEN, "no cosines", "senders of twice the area", "one direction for all"),
    ("ssdo", "fig14"): (OPEN, "no cosines", "half the reach"),
    ("s3ho", "fig1"): (OPEN, "occlusion of red alone", "occlusion of strong light"),
    ("s3ho", "fig3"): (OPEN, "two bands", "no lobes"),
    ("s3ho", "fig5"): (OPEN, "two bands", "no lobes"),
    ("s3ho", "fig6"): (OPEN, "two bands", "half the occlusion"),
    ("s3ho", "fig7"): (OPEN, "two bands", "one direction for all", "a quarter of the samples"),
    ("s3ho", "fig8"): ("two bands", "green light for all colours", "cones around the normal"),
    ("ambient_transfer", "fig1"): ("half the distances", "linear in place of the square root", "a short exponential"),
    ("ambient_transfer", "fig5"): ("one set for all pixels", "no neighbours in the filter"),
    ("ambient_transfer", "fig7"): ("no limit to depth", "thin surfaces", "half the distances"),
    ("ambient_transfer", "fig8"): ("black senders", "white senders"),
    ("ambient_transfer", "fig9"): ("no relief", "grey senders", "black senders"),
    ("s3ho", "fig9"): ("two bands", "a quarter of the samples", "coefficients of three senders"),
    ("hao", "fig2"): ("half of the slices", "voxels of twelve slices"),
    ("hao", "fig4"): ("a cone three times as wide", "no falloff", "no voxels"),
    ("hao", "fig5"): ("one ray for all", "a filter without neighbours"),
    ("hao", "fig7"): ("no voxels", "the receiver's own voxels"),
    ("hao", "fig8"): ("no voxels", "noise of the screen"),
    ("hao", "fig9"): ("no voxels", "voxels of the picture alone"),
}
TIMED = {
    ("hao", "fig6"),
    ("ssdo", "fig1"),
    ("ssdo", "table1"),
    ("s3ho", "table1"),
}  # tests/papers/test_claims.py has theirs


@pytest.mark.parametrize(
    ("paper", "name", "edit"), [(*figure, edit) for figure, edits in MUTATIONS.items() for edit in edits]
)
def test_a_claim_fails_if_its_method_is_broken(draw, broken, paper, name, edit):
    whole = draw(paper, name)
    assert broken(paper, name, edit).unmet - whole.unmet


def test_every_figure_has_two_mutations():
    assert {*MUTATIONS} | TIMED == {(paper, name) for paper in PAPERS for name in figures(paper)}
    assert min(map(len, MUTATIONS.values())) >= 2
