"""The table of open surfaces' irradiance against exact integrals."""

import numpy as np
import pytest

from aolab import Environment
from aolab.scene.environment import averaged, direction_from_uv
from aolab.scene.irradiance import OpenIrradiance, mean_radiance


def test_a_constant_environment_stays_that_constant():
    table = mean_radiance(Environment.constant((0.1, 1 / 3, 7.0)))
    assert table.shape == (33, 64, 3)
    assert (table == np.array((0.1, 1 / 3, 7.0), np.float32)).all()


def test_light_from_above_reaches_a_normal_by_its_tilt():
    """A sky of 1 over a black ground: (1 + cosθ) / 2 for a normal at the angle θ to the zenith."""
    radiance = np.zeros((64, 128, 3), np.float32)
    radiance[:32] = 1
    tilt = np.linspace(0, np.pi, 33)
    expected = np.broadcast_to((1 + np.cos(tilt))[:, None, None] / 2, (33, 64, 3))
    np.testing.assert_allclose(mean_radiance(Environment(radiance)), expected, atol=2e-3)


def test_a_sun_is_its_irradiance_times_the_cosine():
    """Without the ringing of nine coefficients, which give an open surface at 90° to a lamp 3/32 of its light."""
    sun = Environment.sky((0, 0, 0), (0, 0, 0), (0, 0, 0), sun_direction=(1, 0, 0), sun_radiance=(900, 900, 900))
    table = mean_radiance(sun)
    values, _, solid_angles = averaged(sun.radiance)
    whole = (values[..., 0] * solid_angles).sum() / np.pi
    azimuth = 2 * np.pi * ((np.arange(64) + 0.5) / 64 - 0.5)  # of the columns, from -z towards +x
    np.testing.assert_allclose(table[16, :, 0], whole * np.maximum(np.sin(azimuth), 0), atol=0.02 * whole)
    np.testing.assert_allclose(table[[0, -1]], 0, atol=0.02 * whole)


@pytest.mark.parametrize("shape", [(64, 128), (100, 300), (70, 129), (4, 5)])
def test_the_table_is_the_sum_over_all_texels(shape):
    """∫ L max(0, n · ω) dω / π by brute force, for maps of any width."""
    radiance = np.random.default_rng(1).random((*shape, 3)).astype(np.float32)
    times = [-(-800 // size) for size in shape]  # fine texels: the cosine is nearly constant in each
    large = radiance.repeat(times[0], axis=0).repeat(times[1], axis=1)
    values, directions, solid_angles = averaged(large, large.shape[:2])
    for row, column in ((0, 0), (5, 7), (16, 0), (16, 40), (31, 63), (32, 2)):
        normal = direction_from_uv(((column + 0.5) / 64, row / 32))
        weights = np.maximum(directions @ normal, 0) * solid_angles
        expected = (weights[..., None] * values).sum(axis=(0, 1)) / weights.sum()
        np.testing.assert_allclose(mean_radiance(Environment(radiance))[row, column], expected, atol=2e-3)


def test_maps_of_few_texels_have_no_holes():
    """Two texels: every normal has its mean between them."""
    table = mean_radiance(Environment(np.array([[[0.0] * 3, [1.0] * 3]])))
    assert np.isfinite(table).all()
    assert table.min() == pytest.approx(0, abs=0.01)
    assert table.max() == pytest.approx(1, abs=0.01)


def test_the_circle_goes_on_beyond_the_first_and_last_column():
    sky = Environment.sky(sun_direction=(1, 1, 0))
    table = OpenIrradiance()(sky)
    assert table.shape == (33, 66, 3)
    np.testing.assert_array_equal(table[:, 0], table[:, -2])
    np.testing.assert_array_equal(table[:, -1], table[:, 1])
