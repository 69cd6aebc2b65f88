"""The environment averaged over cones: exact cases, narrow and wide cones, continuity over the map's edges."""

from itertools import pairwise

import numpy as np
import pytest

from aolab import Environment
from aolab.scene.cones import SLICES, TEXELS, Cones, bordered, cones
from aolab.scene.environment import averaged
from aolab.scene.prefiltered import BLUR_CELLS, octahedral_directions, octahedral_uv

SKY = Environment.sky(sun_direction=(1.0, 0.8, -0.3), sun_angle=25)


@pytest.fixture(scope="module")
def table() -> np.ndarray:
    """(slices, texels, texels, 3): the cones of `SKY`."""
    return cones(SKY)


@pytest.mark.parametrize("color", [(0.0, 0.0, 0.0), (0.3, 0.6, 1.2)])
def test_a_constant_environment_stays_exactly_constant(color):
    found = cones(Environment.constant(color))
    assert found.shape == (SLICES, TEXELS, TEXELS, 3)
    np.testing.assert_allclose(found, np.broadcast_to(np.float32(color), found.shape), rtol=1e-5)


def test_the_widest_cone_is_irradiance_over_pi(table):
    """The expected value is a sum over all cells of the map."""
    values, directions, solid_angles = averaged(SKY.radiance, BLUR_CELLS)
    normal = octahedral_directions(TEXELS)[::7, ::5]
    cosine = np.maximum(np.einsum("abk,ijk->abij", normal, directions), 0)
    expected = np.einsum("abij,ij,ijc->abc", cosine, solid_angles, values) / np.pi
    np.testing.assert_allclose(table[-1, ::7, ::5], expected, rtol=0.03)


def test_a_narrow_cone_is_brighter_towards_the_sun_and_a_wide_one_smoother(table):
    towards = np.array((1.0, 0.8, -0.3)) / np.linalg.norm((1.0, 0.8, -0.3))
    u, v = (octahedral_uv(towards) * TEXELS).astype(int)
    at_the_sun = table[:, v, u, 0]
    assert all(narrow > wide for narrow, wide in pairwise(at_the_sun))
    assert at_the_sun[0] > 5 * at_the_sun[-1]
    spread = table.std(axis=(1, 2, 3))
    assert all(narrow > wide for narrow, wide in pairwise(spread))


def test_the_border_continues_the_map_on_the_sphere():
    """A border texel is close, on the sphere, to the texel at the edge."""
    directions = bordered(octahedral_directions(TEXELS))
    assert directions.shape == (TEXELS + 2, TEXELS + 2, 3)
    np.testing.assert_array_equal(directions[1:-1, 1:-1], octahedral_directions(TEXELS))
    # the map is cut along the half circles x = 0 and z = 0; the cut is half way between the edge and the border
    x, _, z = np.moveaxis(directions, -1, 0)
    for one, other in ((x[0], x[1]), (x[-1], x[-2]), (z[:, 0], z[:, 1]), (z[:, -1], z[:, -2])):
        np.testing.assert_allclose((one + other)[1:-1], 0, atol=1e-12)
        assert np.abs(other).max() > 0.04


def test_slices_are_stacked_from_narrow_to_wide(table):
    stacked = Cones()(SKY)
    assert stacked.shape == (SLICES * (TEXELS + 2), TEXELS + 2, 3)
    np.testing.assert_array_equal(stacked[1 : TEXELS + 1, 1:-1], table[0])
    np.testing.assert_array_equal(stacked[-TEXELS - 1 : -1, 1:-1], table[-1])


def test_equal_tables_are_made_once():
    assert Cones() == Cones()
