"""The fading of an occluder's influence: the papers' curves, their ends, and their order."""

import numpy as np
import pytest

from aolab.maths.fading import CURVES, is_hard, openness, reach

DISTANCES = np.float32([0, 0.25, 0.5, 1, 2, np.inf])
EVERY = [0.0, 0.3, 1.0, *CURVES]


@pytest.mark.parametrize("fading", EVERY)
def test_openness_grows_from_nothing_to_all(fading):
    found = openness(np.append(np.linspace(0, 30, 500), np.inf), fading)
    assert found[0] == 0
    assert found[-1] == 1
    assert (np.diff(found) >= 0).all()
    assert openness(DISTANCES, fading).dtype.kind == "f"


@pytest.mark.parametrize(
    ("fading", "expected"),
    [
        ("classical", [0, 0, 0, 1, 1, 1]),
        (0.0, [0, 0, 0, 1, 1, 1]),
        ("linear", [0, 0.25, 0.5, 1, 1, 1]),
        ("sqrt", [0, 0.5, np.sqrt(0.5), 1, 1, 1]),
        ("exponential", [*(1 - np.exp(-2 * DISTANCES[:5])), 1]),
        ("wendland", [0, 1 - 0.75**4 * 2, 1 - 0.5**4 * 3, 1, 1, 1]),
        (1.0, [0, 0.25**2 * (3 - 0.5), 0.5, 1, 1, 1]),
        (0.5, [0, 0, 0, 1, 1, 1]),
    ],
)
def test_curves_by_hand(fading, expected):
    np.testing.assert_allclose(openness(DISTANCES, fading, sigma=2.0), expected, atol=1e-6)


def test_only_the_exponential_curve_reaches_beyond_the_radius():
    assert {fading for fading in EVERY if reach(fading, 3.0) != 3.0} == {"exponential"}
    assert reach("exponential", 3.0) == np.inf


def test_only_a_hard_edge_needs_no_distance():
    assert [fading for fading in EVERY if is_hard(fading)] == [0.0, "classical"]
