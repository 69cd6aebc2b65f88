"""Clip planes: the camera's own choice cuts nothing away, planes that are given are told where they do."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import small_scenes
import trimesh
from small_scenes import WHITE, box, floor, quad

import aolab
from aolab import Camera, Material, Notice
from aolab.scene.clipping import clipped, reason_of_cut, unclipped
from aolab.scene.view import View

SIZE = (32, 24)
AHEAD = Camera((0, 1, 3.5), (0, 0.5, 0), fov=45)


def cube(*others: aolab.Mesh, camera: Camera = AHEAD) -> aolab.Scene:
    """A cube, 3 units before the camera, and others."""
    return small_scenes.of(box((-0.5, 0, -0.5), (0.5, 1, 0.5), name="cube"), *others, camera=camera)


def notes_of(lab, scene, **options) -> list[str]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Notice)
        return lab.render(scene, "none", size=SIZE, **options).notes


@pytest.mark.parametrize("half", [10.0, 10_000.0])
def test_a_cube_is_drawn_however_wide_the_floor_is(lab, half):
    """With a near plane at 1/1000 of the scene, a floor of 20 km would cut away all within 20 m of the camera."""
    frame = lab.render(cube(floor(half)), "none", size=SIZE)
    assert frame.notes == []
    assert -frame["viewZ"].max() < 3.3
    assert frame["viewZ"][12, 16] == pytest.approx(-3.2, abs=0.2)


def test_the_near_plane_lies_before_the_nearest_surface():
    scene = cube(floor(10_000))
    near = unclipped(scene.camera, scene, SIZE).near
    assert 0.5 < near < 1  # the floor is one unit below the eye
    assert unclipped(Camera((0, 50, 0), (0, 0, -1)), cube(floor(100)), SIZE).near is None  # its own choice suffices
    given = Camera((0, 1, 3.5), (0, 0.5, 0), near=2.0)
    assert unclipped(given, scene, SIZE) == given


@pytest.mark.parametrize("ortho", [None, 2.0])
@pytest.mark.parametrize(
    "planes", [{"near": 1e-7}, {"far": 1e9}, {"near": 1e-5, "far": 1e12}, {"near": 1e-7, "far": 20}]
)
def test_planes_far_beyond_what_is_in_view_change_nothing(lab, planes, ortho):
    """As planes of a depth buffer of 24 bits they would mix surfaces, or cut all away."""
    camera = replace(AHEAD, ortho=ortho)
    right = lab.render(cube(floor(10)), "ssao", size=SIZE, camera=camera)
    frame = lab.render(cube(floor(10)), "ssao", size=SIZE, camera=replace(camera, **planes))
    assert frame.notes == []
    np.testing.assert_allclose(frame["viewZ"], right["viewZ"], rtol=1e-5)
    np.testing.assert_allclose(frame["visibility"], right["visibility"], atol=0.02)


def test_a_surface_behind_a_near_plane_that_is_given_stays():
    """At a hundredth of the distance that the camera would choose."""
    scene = cube(floor(1000), quad((-1, 0.5, 3.48), (2, 0, 0), (0, 1, 0)))
    assert unclipped(replace(AHEAD, near=1e-4), scene, SIZE).near == pytest.approx(0.016, abs=0.004)
    assert unclipped(replace(AHEAD, near=0.01), scene, SIZE).near == pytest.approx(0.016, abs=0.004)


def test_a_notice_names_the_parts_that_the_near_plane_cuts(lab):
    (note,) = notes_of(lab, cube(), camera=Camera((0, 0.5, 3.5), (0, 0.5, 0), near=3.2))
    assert note == "the camera's near plane, near = 3.2, cuts away parts of 'cube'"


def test_a_notice_names_the_parts_that_the_far_plane_cuts(lab):
    camera = Camera((0, 1, 3.5), (0, 0.5, 0), far=6)
    (note,) = notes_of(lab, cube(floor(100)), camera=camera)
    assert note == "the camera's far plane, far = 6, cuts away parts of 'floor'"


@pytest.mark.parametrize("ortho", [None, 1.5])
def test_planes_that_cut_nothing_of_the_picture_are_not_told(lab, ortho):
    """The floor, one triangle pair around the eye, lies below what is in view between the eye and the near plane."""
    behind = quad((-5, 0, 9), (10, 0, 0), (0, 5, 0), name="behind")
    beside = box((40, 0, -30), (41, 1, -29), name="beside")
    camera = Camera((0, 1, 3.5), (0, 0.9, 0), near=1.0, far=12, ortho=ortho)
    assert notes_of(lab, cube(floor(6), behind, beside, camera=camera)) == []


def test_a_triangle_is_found_though_all_of_its_corners_are_outside(lab):
    camera = Camera((0, 1, 3.5), (0, 0.5, 0), near=0.5)
    veil = quad((-50, -50, 3.2), (100, 0, 0), (0, 100, 0), name="veil")
    (note,) = notes_of(lab, cube(veil), camera=camera)
    assert "near = 0.5" in note
    assert "'veil'" in note
    assert "'cube'" not in note


def test_many_parts_are_shortened(lab):
    parts = [box((x, 0, -0.5), (x + 0.1, 1, 0.5), name=f"part {x:.1f}") for x in np.arange(-0.5, 0.5, 0.2)]
    scene = small_scenes.of(*parts)
    note = reason_of_cut(scene, View(Camera((0, 0.5, 3.5), (0, 0.5, 0), far=3.4), SIZE, scene.bounds))
    assert note.endswith("parts of 'part -0.5', 'part -0.3', 'part -0.1', others")


def test_a_clipped_polygon():
    square = np.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], float)
    left = clipped(square, np.array([(-1.0, 0, 0, 0.5)]))  # x < 0.5
    assert {tuple(point) for point in left} == {(0, 0, 0), (0.5, 0, 0), (0.5, 2, 0), (0, 2, 0)}
    assert clipped(square, np.array([(1.0, 0, 0, -3)])) == []


@pytest.mark.parametrize(
    ("camera", "material", "reason"),
    [
        (Camera((0, 1, 3.5), (0, 1, 9)), WHITE, "all of the scene lies behind the camera"),
        (Camera((0, 1, 3.5), (0, 1, 0), far=2), WHITE, r"beyond the camera's far plane, far = 2; it begins at 3$"),
        (Camera((0, 1, 3.5), (0, 1, 0), near=9), WHITE, r"before the camera's near plane, near = 9; it ends at 4"),
        (Camera((0, 1, 3.5), (3.5, 1, 3.0)), WHITE, r"looks past the scene; Camera.framing"),
        (AHEAD, Material((1, 1, 1), alpha=0.2, alpha_cutoff=0.5, name="leaf"), "material 'leaf' is cut at alpha 0.5"),
        (Camera((0, 1, 90), (0, 1, 0), fov=175), WHITE, "smaller than a pixel"),
    ],
)
def test_an_empty_picture_states_why(lab, camera, material, reason):
    scene = small_scenes.of(box((-0.5, 0, -0.5), (0.5, 1, 0.5), material), camera=camera)
    with pytest.warns(Notice, match=f"nothing is drawn: .*{reason}"):
        frame = lab.render(scene, "ssao", size=SIZE)
    assert not frame.mask.any()
    assert len(frame.notes) == 1


def test_single_sided_surfaces_from_behind(lab):
    one_sided = Material((1, 1, 1), double_sided=False, name="film")
    scene = small_scenes.of(quad((-1, -1, 0), (2, 0, 0), (0, 2, 0), one_sided), camera=Camera((0, 0, -3), (0, 0, 0)))
    with pytest.warns(Notice, match="material 'film' is not seen from behind"):
        lab.render(scene, "none", size=SIZE)


def test_the_truth_sees_what_is_near(lab):
    """Its rays start at the near plane of the picture."""
    scene = cube(floor(10_000))
    frame = lab.render(scene, "ssao", size=SIZE, radius=0.5)
    truth = aolab.reference(scene, like=frame, rays=16, cache=False)
    np.testing.assert_array_equal(truth["viewZ"], frame["viewZ"])
    assert np.nanmean(np.abs(truth["visibility"] - frame["visibility"])) < 0.03


def test_large_models_are_searched_by_chunks():
    """A sphere of 80,000 triangles around the eye: the distance is that to its nearest triangle."""
    ball = trimesh.creation.icosphere(6, 2.0)
    camera = Camera((0, 0, 1.9), (0, 0, 5))
    wide = quad((-5e4, -1.9, 5e4), (1e5, 0, 0), (0, 0, -1e5))
    scene = small_scenes.of(aolab.Mesh(ball.vertices, ball.faces), wide, camera=camera)
    near = unclipped(camera, scene, SIZE).near
    assert near == pytest.approx(0.9 * 0.1 / np.sqrt(1 + (1 + 16 / 9) * np.tan(np.radians(22.5)) ** 2), rel=0.02)


def test_an_empty_picture_names_a_plane_that_cut(lab):
    """The near plane lies within the cube, whose other side is seen from behind."""
    single = small_scenes.of(box((-0.5, 0, -0.5), (0.5, 1, 0.5), aolab.Material(double_sided=False), name="cube"))
    (note,) = notes_of(lab, single, camera=Camera((0, 0.5, 3.5), (0, 0.5, 0), fov=10, near=3.2))
    assert "the camera's near plane, near = 3.2, cuts away parts of 'cube'" in note
    assert "is not seen from behind" in note
