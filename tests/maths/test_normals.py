"""Vertex normals of solids with known normals."""

import numpy as np
import pytest
import trimesh

from aolab.maths.normals import MANY, _sum_over_pairs, smooth_normals
from aolab.scene.mesh import CREASE_DEGREES


def made(solid, crease=CREASE_DEGREES):
    return smooth_normals(np.asarray(solid.vertices, np.float32), np.asarray(solid.faces), crease)


def face_normals(vertices, faces):
    corner = vertices[faces].astype(np.float64)
    normals = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def test_a_cube_is_faceted():
    vertices, faces, source, normals = made(trimesh.creation.box())
    assert len(vertices) == 24  # 8 corners, each in 3 faces
    assert sorted(np.bincount(source)) == [3] * 8
    np.testing.assert_allclose(normals[faces], np.repeat(face_normals(vertices, faces)[:, None], 3, axis=1), atol=1e-6)


def test_a_cube_is_round_above_90_degrees():
    vertices, _, _, normals = made(trimesh.creation.box(), crease=91)
    assert len(vertices) == 8
    # with angle weights, a face's diagonal has no effect
    np.testing.assert_allclose(normals, vertices / np.linalg.norm(vertices, axis=1, keepdims=True), atol=1e-6)


@pytest.mark.parametrize(("subdivisions", "degrees"), [(2, 0.6), (3, 0.3), (4, 0.16)])
def test_a_sphere_is_smooth_and_converges(subdivisions, degrees):
    sphere = trimesh.creation.icosphere(subdivisions)
    vertices, _, _, normals = made(sphere)
    assert len(vertices) == len(sphere.vertices)
    cosines = (normals * vertices / np.linalg.norm(vertices, axis=1, keepdims=True)).sum(axis=1)
    assert np.degrees(np.arccos(cosines.min().clip(-1, 1))) < degrees


def test_a_cylinder_is_round_at_its_side_and_flat_on_top():
    vertices, _, _, normals = made(trimesh.creation.cylinder(1, 2, sections=64))
    is_flat = np.abs(normals[:, 2]) > 0.5
    np.testing.assert_allclose(np.abs(normals[is_flat, 2]), 1, atol=1e-6)
    np.testing.assert_allclose(normals[~is_flat], vertices[~is_flat] * [1, 1, 0], atol=1e-5)


def test_seams_do_not_show():
    sphere = trimesh.creation.icosphere(3)
    soup = trimesh.Trimesh(
        sphere.triangles.reshape(-1, 3), np.arange(3 * len(sphere.faces)).reshape(-1, 3), process=False
    )
    vertices, _, _, normals = made(soup)
    _, _, _, welded = made(sphere)
    by_place = {tuple(place): normal for place, normal in zip(np.float32(sphere.vertices), welded, strict=True)}
    assert len(vertices) == len(soup.vertices)  # each vertex keeps its own UV
    np.testing.assert_allclose(normals, [by_place[tuple(place)] for place in vertices], atol=1e-5)


def test_plus_and_minus_zero_are_the_same_position():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0.3], [-0.0, 0, 0], [0, 1, 0.3], [-1, 0, 0]], np.float32)
    _, faces, _, normals = smooth_normals(vertices, np.array([[0, 1, 2], [3, 4, 5]]), 80)
    np.testing.assert_allclose(normals[faces[0, 0]], normals[faces[1, 0]], atol=1e-6)


@pytest.mark.parametrize(
    ("solid", "sizes"), [("box", ()), ("cylinder", (1, 2)), ("cone", (1, 2)), ("icosphere", ()), ("torus", (2, 0.5))]
)
def test_splitting_keeps_the_triangles(solid, sizes):
    shape = getattr(trimesh.creation, solid)(*sizes)
    vertices, faces, source, normals = made(shape)
    before = np.asarray(shape.vertices, np.float32)
    np.testing.assert_array_equal(vertices[faces], before[shape.faces])
    np.testing.assert_array_equal(vertices, before[source])
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
    # every normal is less than 60° from its face's normal
    assert ((normals[faces] * face_normals(vertices, faces)[:, None]).sum(axis=2) > 0.5).all()


@pytest.mark.parametrize("scale", [1e-12, 1e12])
def test_scale_does_not_matter(scale):
    box = trimesh.creation.box()
    _, faces, _, normals = made(box)
    box.apply_scale(scale)
    _, scaled_faces, _, scaled = made(box)
    np.testing.assert_array_equal(faces, scaled_faces)
    np.testing.assert_allclose(normals, scaled, atol=1e-6)


def test_a_point_of_many_faces_averages_only_within_the_crease():
    """At a cone's tip 2,000 faces meet. Each corner averages only the faces within the crease."""
    angle = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
    rim = np.stack([np.cos(angle), np.sin(angle), np.full_like(angle, -1)], axis=1)
    faces = [[0, 1 + i, 1 + (i + 1) % 2000] for i in range(2000)]
    vertices, faces, _, normals = smooth_normals(np.vstack([[0, 0, 0], rim]).astype(np.float32), np.array(faces), 40)
    towards = face_normals(vertices, faces)
    assert ((normals[faces[:, 0]] * towards).sum(axis=1) > 0.99).all()


def test_sums_over_pairs_of_few_and_of_many_corners():
    """Against each pair, at points where 2 to 300 corners of random normals meet."""
    rng = np.random.default_rng(1)
    point = rng.permutation(np.repeat(np.arange(6), [2, MANY - 1, MANY, MANY + 1, 100, 300]))
    normal, weighted = rng.normal(size=(2, len(point), 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    for cosine in (0.7, -2):  # -2: all pairs
        near = (normal @ normal.T >= cosine) & (point[:, None] == point)
        np.testing.assert_allclose(_sum_over_pairs(point, normal, weighted, cosine), near @ weighted, atol=1e-12)
