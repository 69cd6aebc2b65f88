"""Masks on depth images made by hand: viewZ is negative, the background -inf."""

import numpy as np
import pytest

from aolab.measures.regions import border, nearness, projected_px, silhouettes, thin_occluders

SKY = -np.inf


def flat(height=40, width=60, distance=10.0):
    return np.full((height, width), -distance, np.float32)


def slanted(height=40, width=60):
    """A floor seen at a grazing angle: nearness is linear in the row, distance grows from 2 to 200."""
    return -1 / np.repeat(np.linspace(1 / 200, 1 / 2, height)[:, None], width, axis=1)


def test_nearness_of_the_background_is_zero():
    assert nearness(np.array([[-4.0, SKY]])).tolist() == [[0.25, 0]]


def test_border_counts_pixels_from_the_edge():
    mask = border((6, 5), 2)
    assert mask.shape == (5, 6)
    assert np.argwhere(~mask).tolist() == [[2, 2], [2, 3]]
    assert not border((6, 5), 0).any()
    assert border((6, 5), 3).all()


def test_border_by_a_sphere_is_wider_where_surfaces_are_near():
    view_z = flat(100, 100)
    view_z[:, :50] = -5
    reach = projected_px(view_z, radius=1.0, fov=90)
    assert reach[0, [0, 99]] == pytest.approx(
        [10, 5]
    )  # 100 rows are 2 units at distance 1, so 20 at 10: five pixels a unit
    mask = border((100, 100), reach)
    middle = mask[50]
    assert (middle[:50].sum(), middle[50:].sum()) == (10, 5)


def test_planes_and_creases_have_no_silhouette():
    valley = slanted()
    valley = np.maximum(valley, valley[::-1])
    for view_z in (flat(), slanted(), slanted().T, valley):
        assert not silhouettes(view_z).any()


def test_silhouettes_are_both_sides_of_a_gap():
    view_z = flat()
    view_z[:, 30:] = -5
    assert np.unique(np.argwhere(silhouettes(view_z, 1))[:, 1]).tolist() == [29, 30]
    assert np.unique(np.argwhere(silhouettes(view_z, 2))[:, 1]).tolist() == [28, 29, 30, 31]
    assert silhouettes(view_z.T, 2).T.tolist() == silhouettes(view_z, 2).tolist()


def test_a_surface_against_the_background_has_a_silhouette():
    view_z = slanted()
    view_z[:20] = SKY
    assert np.unique(np.argwhere(silhouettes(view_z, 1))[:, 0]).tolist() == [19, 20]


def test_a_small_step_is_no_gap():
    view_z = flat()
    view_z[:, 30:] *= 0.97
    assert not silhouettes(view_z).any()


def test_silhouettes_at_the_edge_of_the_image():
    view_z = flat()
    view_z[:, 0] = -5
    assert np.unique(np.argwhere(silhouettes(view_z, 1))[:, 1]).tolist() == [0, 1]
    assert silhouettes(np.array([[-5.0, -10.0]]), 1).all()


def test_thin_occluders_are_narrower_than_the_width():
    view_z = flat()
    view_z[:, 20:24] = -5
    columns = np.unique(np.argwhere(thin_occluders(view_z, 6))[:, 1])
    assert columns.tolist() == list(range(20 - 6, 24 + 6))
    wide = flat()
    wide[:, 20:30] = -5
    assert not thin_occluders(wide, 6).any()


def test_thin_occluders_before_the_sky_leave_the_sky_out():
    view_z = np.full((40, 60), SKY)
    view_z[:, 20:24] = -5
    assert np.unique(np.argwhere(thin_occluders(view_z, 6))[:, 1]).tolist() == [20, 21, 22, 23]


def test_no_thin_occluder_is_a_plane_a_corner_or_a_relief():
    box = flat()
    box[10:30, 20:45] = -5
    diamond = flat()
    y, x = np.mgrid[:40, :60]
    diamond[abs(y - 20) + abs(x - 30) < 15] = -5
    relief = flat()
    relief[:, 20:24] *= 0.97
    for view_z in (flat(), slanted(), slanted().T, box, diamond, relief):
        assert not thin_occluders(view_z).any()
