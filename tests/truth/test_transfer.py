"""Obscurance and ambient transfer: the identities of the paper, and path tracing where it has a closed form."""

import numpy as np
import pytest

from aolab.errors import ParameterError
from aolab.truth import reference

from .rooms import CEILING, ceiling_scene, wall_scene, world_positions

SIZE = (48, 32)
MEASURES = ("classical", "linear", "sqrt", "exponential")


@pytest.mark.parametrize("measure", MEASURES)
def test_white_stays_white(measure):
    white = wall_scene(floor_albedo=1.0, wall_albedo=1.0)
    frame = reference(white, size=SIZE, rays=32, radius=1.5, measure=measure, buffers=("transfer", "obscurance"))
    assert frame["obscurance"][frame.mask].min() < 0.95
    np.testing.assert_allclose(frame["transfer"][frame.mask], 1, atol=1e-5)


@pytest.mark.parametrize("measure", MEASURES)
def test_black_reflects_nothing(measure):
    black = wall_scene(wall_albedo=0.0)
    frame = reference(black, size=SIZE, rays=32, radius=1.5, measure=measure, buffers=("transfer", "obscurance"))
    expected = np.repeat(frame["obscurance"][..., None], 3, axis=2)
    np.testing.assert_allclose(frame["transfer"], expected, rtol=1e-6)


@pytest.mark.parametrize(("measure", "expected"), [("classical", 0.25), ("linear", 0.75), ("sqrt", 0.8595)])
def test_obscurance_under_a_ceiling(measure, expected):
    """s = cos²θ is uniform, d = c/√s: k + ∫ μ ds over [k, 1], k = (c/R)²: linear 2√k - k,
    square root (4 k^¼ - k) / 3."""
    frame = reference(ceiling_scene(), size=SIZE, radius=2 * CEILING, measure=measure, buffers="obscurance")
    assert frame["obscurance"].mean() == pytest.approx(expected, abs=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("albedo", [0.0, 0.5, 0.8])
def test_path_tracing_between_planes_is_a_geometric_series(albedo):
    """Every point sees the same: W = k + (1 - k) a W. With one common albedo eq. 6 is exact."""
    k, a = 0.25, albedo
    frame = reference(
        ceiling_scene(albedo),
        size=SIZE,
        radius=CEILING / np.sqrt(k),
        measure="classical",
        bounces=40,
        buffers=("transfer", "transfer_multibounce"),
    )
    exact = k / (1 - (1 - k) * a)
    assert frame["transfer"].mean() == pytest.approx(exact, rel=3e-3)
    assert frame["transfer_multibounce"].mean() == pytest.approx(exact, rel=3e-3)


def test_without_bounces_only_the_sky_arrives():
    frame = reference(
        wall_scene(), size=SIZE, rays=32, radius=1.5, bounces=0, buffers=("transfer_multibounce", "visibility")
    )
    visibility = np.nan_to_num(frame["visibility"])
    np.testing.assert_allclose(frame["transfer_multibounce"][..., 0], visibility, atol=1e-6)


def test_path_tracing_ends_at_the_radius_whatever_the_measure():
    frames = [
        reference(wall_scene(), size=SIZE, rays=32, radius=1.0, measure=measure, buffers="transfer_multibounce")
        for measure in ("classical", "exponential")
    ]
    beyond = world_positions(frames[0])[:, 0] > 1.01
    for frame in frames:
        arrived = frame["transfer_multibounce"][frame.mask]
        assert (arrived[beyond] == 1).all()
        assert arrived[~beyond].min() < 0.95


def test_a_fuzzy_measure_needs_a_radius():
    with pytest.raises(ParameterError, match="measure = 'sqrt' needs a radius"):
        reference(wall_scene(), buffers="obscurance")
    frame = reference(wall_scene(), size=SIZE, rays=8, measure="classical", buffers=("obscurance", "visibility"))
    np.testing.assert_array_equal(frame["obscurance"][frame.mask], frame["visibility"][frame.mask])
