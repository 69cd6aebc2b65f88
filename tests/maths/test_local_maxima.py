"""The distance between local maxima of known bodies, and the automatic radius."""

import numpy as np
import pytest
import small_scenes
from small_scenes import box, of, sphere

import aolab
from aolab.maths.local_maxima import AXES, local_maxima, mean_nearest_distance
from aolab.modules.base import auto_radius


def maxima_along(mesh: aolab.Mesh, axis: tuple[int, int, int]) -> np.ndarray:
    points, axes = local_maxima(*mesh.welded)
    return points[axes == AXES.tolist().index(list(map(float, axis)))]


def test_a_box_has_one_plateau_per_side():
    for axis in AXES:
        points = maxima_along(box((-1, -2, -3), (1, 2, 3)), tuple(axis))
        np.testing.assert_allclose(points, [axis * (1, 2, 3)], atol=1e-12)


def test_a_sphere_has_one_maximum_per_direction():
    assert len(maxima_along(sphere(1.0, (0, 0, 0)), (0, 1, 0))) == 1


def test_a_terrace_is_not_a_maximum():
    """Of steps up to a ridge, only the ridge is a maximum."""
    x = np.repeat(np.arange(6.0), 2)
    y = np.repeat([0.0, 1, 1, 2, 1, 0], 2)
    vertices = np.stack([x, y, np.tile([0.0, 1.0], 6)], axis=1)
    faces = [face for i in range(0, 10, 2) for face in ((i, i + 1, i + 3), (i, i + 3, i + 2))]
    np.testing.assert_allclose(maxima_along(aolab.Mesh(vertices, faces), (0, 1, 0)), [(3, 2, 0.5)])


def test_the_distance_of_bodies_in_a_row_is_their_spacing():
    scene = of(*(box((3 * i, 0, 0), (3 * i + 1, 1, 1)) for i in range(5)))
    assert scene.feature_distance == pytest.approx(3)
    placed = [aolab.Instance(box((0, 0, 0), (1, 1, 1)), small_move(3 * i)) for i in range(5)]
    assert aolab.Scene(tuple(placed)).feature_distance == pytest.approx(3)


def small_move(x: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[0, 3] = x
    return matrix


def test_brute_force_and_tree_agree():
    points = np.random.default_rng(0).random((2000, 3))
    few = mean_nearest_distance(points[:500])
    squared = ((points[:500, None] - points[None, :500]) ** 2).sum(-1) + np.eye(500) * 9
    assert few == pytest.approx(np.sqrt(squared.min(axis=1)).mean())
    many = mean_nearest_distance(points)
    assert many is not None
    assert 0.5 < many / (few * (500 / 2000) ** (1 / 3)) < 1.5
    assert mean_nearest_distance(points[:1]) is None


def test_the_automatic_radius_is_the_distance_within_limits():
    row = of(*(box((3 * i, 0, 0), (3 * i + 1, 1, 1)) for i in range(40)))
    assert auto_radius(row) == pytest.approx(3, rel=0.01)
    alone = of(sphere(1.0, (0, 0, 0)))
    assert auto_radius(alone) == pytest.approx(
        0.1 * alone.radius, rel=0.05
    )  # without a second maximum, the upper limit applies
    assert aolab.SSAO().resolved(row).radius == auto_radius(row)
    assert auto_radius(small_scenes.plane()) > 0
