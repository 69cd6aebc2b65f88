"""Polygons as triangles: the area is the polygon's, and so is the way round."""

import numpy as np
import pytest

from aolab.loading.polygons import triangulate

C = np.array([(0, 0), (4, 0), (4, 1), (1, 1), (1, 3), (4, 3), (4, 4), (0, 4)], float)  # the letter, area 10
L = np.array([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], float)  # area 3
DART = np.array([(0, 0), (2, 1), (0, 2), (0.5, 1)], float)  # area 1.5


def tilted(outline):
    """In a plane of its own in space, where one unit of area stays one."""
    across, up = np.array([0.6, 0.0, 0.8]), np.array([0.48, 0.8, -0.36])
    return outline[:, :1] * across + outline[:, 1:] * up + (3, -2, 1)


def areas(points, faces):
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    return np.cross(b - a, c - a) / 2


@pytest.mark.parametrize(("outline", "area"), [(C, 10), (L, 3), (DART, 1.5)])
@pytest.mark.parametrize("start", range(4))
@pytest.mark.parametrize("way", [1, -1])
def test_a_concave_polygon_is_filled_without_its_notches(outline, area, start, way):
    points = tilted(np.roll(outline, start, axis=0)[::way])
    faces, polygon = triangulate(points, [len(points)])
    found = areas(points, faces)
    assert len(faces) == len(points) - 2
    assert np.linalg.norm(found, axis=1).sum() == pytest.approx(area)
    assert np.linalg.norm(found.sum(axis=0)) == pytest.approx(area), "each triangle runs round as the polygon does"
    assert (found.sum(axis=0) @ np.cross((0.6, 0, 0.8), (0.48, 0.8, -0.36))) * way > 0
    assert set(polygon) == {0}


def test_polygons_of_all_sizes_keep_their_order():
    outlines = [C, C[:3], C[:2], L, C[:0], DART]
    points = tilted(np.concatenate(outlines))
    faces, polygon = triangulate(points, [len(outline) for outline in outlines])
    assert polygon.tolist() == [0] * 6 + [1] + [3] * 4 + [5] * 2
    assert np.linalg.norm(areas(points, faces), axis=1).sum() == pytest.approx(10 + 2 + 3 + 1.5)


def test_corners_on_a_line_and_points_in_one_place_do_not_stop_it():
    line = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)], float)
    faces, _ = triangulate(np.concatenate([line, np.zeros((5, 3)), np.full((4, 3), np.nan)]), [4, 5, 4])
    assert faces.max() <= 12


def test_a_polygon_of_20_000_corners():
    angle = np.linspace(0, 2 * np.pi, 20_000, endpoint=False)
    radius = 1 + 0.3 * np.sin(50 * angle)  # a flower; its area is π (1 + 0.3² / 2)
    points = tilted(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))
    faces, _ = triangulate(points, [len(points)])
    assert np.linalg.norm(areas(points, faces), axis=1).sum() == pytest.approx(np.pi * 1.045, rel=1e-4)
