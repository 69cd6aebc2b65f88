"""Shapes: exact volumes, closed skins, placements."""

import numpy as np
import pytest
import trimesh

from aolab.errors import ParameterError
from aolab.scene.mesh import Material, Mesh
from aolab.scene.shapes import beam, block, circle, column, in_range, lathe, loft, placed, ring, rounded, square

STONE = Material()


def volume(mesh: Mesh) -> float:
    solid = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    solid.merge_vertices(merge_norm=True, merge_tex=True)
    assert solid.is_watertight
    return float(solid.volume)


def test_block_stands_on_the_ground():
    mesh = block((2, 3, 4), STONE)
    assert volume(mesh) == pytest.approx(24)
    np.testing.assert_allclose(
        [mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)], [(-1, 0, -2), (1, 3, 2)], atol=1e-6
    )


def test_lathe_of_a_cylinder_is_a_prism():
    exact = 2 * 12 * np.sin(2 * np.pi / 24) * 0.25 * 1.0  # height × n/2 sin(2π/n) r²
    assert volume(lathe([(0.5, 0), (0.5, 2)], 24, STONE)) == pytest.approx(exact, rel=1e-5)


@pytest.mark.parametrize("order", [1, -1])
def test_skins_face_outwards_for_any_order_of_the_rings(order):
    rings = np.array([ring(square(8), 0), ring(square(8), 1)])[::order]
    assert volume(loft(rings, STONE)) == pytest.approx(4)


def test_closed_loft_is_a_frame():
    rings = [
        [(x * s, y, z * s) for s, y in ((1, 0), (1, 1), (2, 1), (2, 0))]
        for x, z in ((1, 1), (-1, 1), (-1, -1), (1, -1))
    ]
    assert volume(loft(np.array(rings), STONE, closed=True)) == pytest.approx(16 - 4)


def test_caps_of_a_ribbon_stay_inside_it():
    x = np.linspace(0, 1, 30)
    front = np.stack([x, 0 * x, 0.2 * np.sin(20 * x)], axis=-1)
    ribbon = np.concatenate([front, (front - (0, 0, 0.01))[::-1]])
    mesh = loft(np.array([ribbon, ribbon + np.array((0, 1, 0))]), STONE)
    assert volume(mesh) == pytest.approx(0.01, rel=1e-3)
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).area < 2 * 5.5  # both sides; a fan-shaped cap would add its area


def test_colors_are_given_per_ring():
    mesh = loft(np.array([ring(square(4), 0), ring(square(4), 1)]), STONE, colors=np.array([(1, 0, 0), (0, 0, 1)]))
    assert mesh.colors is not None
    np.testing.assert_array_equal(mesh.colors[:, 0], mesh.vertices[:, 1] == 0)


def test_beam_lies_along_x():
    mesh = beam([(0, -1), (1, -1), (1, 1), (0, 1)], 6, STONE)
    assert volume(mesh) == pytest.approx(12)
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx((6, 1, 2))


def test_rounded_rectangle_lies_within_its_sides():
    outline = rounded(4, 2, 0.5, 32)
    assert np.ptp(outline, axis=0) == pytest.approx((4, 2))
    assert np.hypot(*(np.abs(outline) - (1.5, 0.5)).clip(0).T).max() == pytest.approx(0.5)


def test_square_has_its_corners():
    assert np.isclose(np.abs(square(32)), 1).all(axis=1).sum() == 4
    np.testing.assert_allclose(np.linalg.norm(circle(7), axis=1), 1)


@pytest.mark.parametrize("square_ends", [True, False])
def test_column_has_its_height_and_reach(square_ends):
    mesh = column(3, 0.25, STONE, square_ends=square_ends)
    assert 0.7 * np.pi * 0.25**2 * 3 < volume(mesh) < 1.3 * np.pi * 0.25**2 * 3
    assert mesh.vertices[:, 1].max() == pytest.approx(3)
    assert mesh.vertices[:, 1].min() == 0
    assert np.abs(mesh.vertices[:, (0, 2)]).max() == pytest.approx(1.35 * 0.25)


def test_placed_scales_then_turns_then_moves():
    matrix = placed(1, 2, 3, turn=90, scale=(2, 1, 1))
    np.testing.assert_allclose(matrix @ (1, 0, 0, 1), (1, 2, 1, 1), atol=1e-12)  # +x goes to -z, counter-clockwise


@pytest.mark.parametrize("value", [-0.1, 1.1, float("nan")])
def test_in_range_names_scene_parameter_and_range(value):
    in_range("hall", light=(0.5, 0, 1))
    with pytest.raises(ParameterError, match=rf"scene 'hall': light = {value} is outside \[0, 1\]"):
        in_range("hall", light=(value, 0, 1))
