"""The camera: a rigid view, a projection that contains the scene, and its errors."""

from dataclasses import replace

import numpy as np
import pytest

from aolab import Camera, SceneError

UNIT = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])


def project(camera: Camera, point, size=(200, 100), bounds=UNIT) -> np.ndarray:
    clip = camera.clip_from_view(size, bounds) @ camera.view_from_world @ (*point, 1)
    return clip[:3] / clip[3]


@pytest.mark.parametrize("eye", [(0, 0, 5), (3, 4, -5), (1e-3, 0, 0), (1e4, 2e4, 3e4)])
def test_the_view_is_rigid_and_looks_down_minus_z(eye):
    camera = Camera(eye, (0, 0, 0), up=(0.1, 1, 0))
    matrix = camera.view_from_world
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-12)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1)
    distance = float(np.linalg.norm(eye))
    np.testing.assert_allclose(matrix @ (0, 0, 0, 1), np.array([0, 0, -distance, 1]), atol=1e-9 * distance)
    assert (matrix[:3, :3] @ (0.1, 1, 0))[1] > 0  # the up vector stays up
    assert (matrix[:3, :3] @ (0.1, 1, 0))[0] == pytest.approx(0, abs=1e-12)


def test_the_field_of_view_is_vertical():
    camera = Camera((0, 0, 2), (0, 0, 0), fov=90)
    np.testing.assert_allclose(project(camera, (0, 2, 0))[:2], (0, 1), atol=1e-12)
    np.testing.assert_allclose(project(camera, (4, 0, 0))[:2], (1, 0), atol=1e-12)  # 2:1
    np.testing.assert_allclose(project(camera, (0, 2, 0), size=(10, 100))[:2], (0, 1), atol=1e-12)


@pytest.mark.parametrize("eye", [(0, 0, 5), (0.5, 0.5, 0.5), (0, 0, 100), (0, 0, 1.0001)])
def test_the_scene_in_front_of_the_eye_is_between_the_clip_planes(eye):
    camera = Camera(eye, (0, 0, 0))
    near, far = camera.clip_planes(UNIT)
    assert 0 < near < far
    forward = -np.asarray(eye) / np.linalg.norm(eye)
    corners = np.array(np.meshgrid(*UNIT.T)).reshape(3, -1).T
    along = (corners - eye) @ forward
    assert along.max() < far
    assert near < along[along > 0].min() or near == pytest.approx(far * 1e-3)


def test_a_scene_behind_the_eye_has_valid_clip_planes():
    near, far = Camera((0, 0, 5), (0, 0, 10)).clip_planes(UNIT)
    assert 0 < near < far


def test_given_clip_planes_are_kept():
    assert Camera((0, 0, 5), (0, 0, 0), near=0.5, far=5).clip_planes(UNIT) == (0.5, 5)
    assert Camera((0, 0, 5), (0, 0, 0), near=0.5, far=1e12).clip_planes(UNIT)[1] == pytest.approx(6, rel=0.02)


@pytest.mark.parametrize("size", [(100, 100), (300, 100), (100, 300)])
@pytest.mark.parametrize("fov", [5, 40, 120])
def test_framing_shows_everything_in_a_picture_of_any_shape(fov, size):
    bounds = np.array([[-3.0, 0.0, 1.0], [5.0, 0.5, 2.0]])
    camera = Camera.framing(bounds, fov=fov)
    corners = np.array(np.meshgrid(*bounds.T)).reshape(3, -1).T
    found = np.array([project(camera, corner, size, bounds) for corner in corners])
    assert np.abs(found).max() <= 1
    if size[0] <= size[1]:
        assert np.abs(found[:, :2]).max() > 0.6  # and fills it


def test_a_framed_landscape_is_as_it_was_without_fit():
    camera = Camera.framing(UNIT)
    np.testing.assert_array_equal(camera.half_extent((300, 100)), replace(camera, fit=False).half_extent((300, 100)))


def test_an_orthographic_camera_shows_its_height_at_every_distance():
    camera = Camera((0, 0, 5), (0, 0, 0), ortho=4)
    for z in (-1, 0, 1):
        np.testing.assert_allclose(project(camera, (0, 2, z))[:2], (0, 1), atol=1e-12)
        np.testing.assert_allclose(project(camera, (4, -2, z))[:2], (1, -1), atol=1e-12)  # 2:1
    near, far = camera.clip_planes(UNIT)
    np.testing.assert_allclose([project(camera, (0, 0, 5 - z))[2] for z in (near, far)], (-1, 1), atol=1e-12)


@pytest.mark.parametrize("projection", [{"fov": 50}, {"ortho": 3}])
@pytest.mark.parametrize("fit", [False, True])
@pytest.mark.parametrize("size", [(60, 40), (40, 60)])
def test_a_margin_leaves_the_picture_in_the_middle(size, fit, projection):
    camera = Camera((0, 0, 5), (0, 0, 0), fit=fit, **projection)
    larger = size[0] + 16, size[1] + 16
    wide = camera.with_margin(size, larger)
    np.testing.assert_allclose(np.divide(wide.half_extent(larger), larger), np.divide(camera.half_extent(size), size))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"eye": (0, 0)}, r"eye = \(0, 0\) is not three finite numbers"),
        ({"eye": (0, np.nan, 0)}, r"eye = \(0, nan, 0\) is not three finite numbers"),
        ({"target": (0, 0, np.inf)}, r"target = .* is not three finite numbers"),
        ({"eye": (1, 2, 3), "target": (1, 2, 3)}, r"eye and target are both \(1\.0, 2\.0, 3\.0\); it looks nowhere"),
        ({"eye": (0, 5, 0)}, r"up = \(0\.0, 1\.0, 0\.0\) is parallel to the view direction; choose another up"),
        ({"up": (0, 0, 0)}, r"up = "),
        ({"fov": 0}, r"fov = 0 is outside \(0, 180\) degrees"),
        ({"fov": 180}, r"fov = 180 is outside"),
        ({"fov": float("nan")}, r"fov = nan is outside"),
        ({"ortho": 0}, r"ortho = 0 is no finite height above 0"),
        ({"ortho": float("inf")}, r"ortho = inf"),
        ({"near": 0}, r"near = 0 must be finite and above 0"),
        ({"near": 2, "far": 1}, r"far = 1 must be finite and above near = 2"),
        ({"near": float("nan")}, r"near = nan"),
        ({"far": -1}, r"far = -1 must be finite and above near = 0"),
        ({"near": 1, "far": float("inf")}, r"far = inf"),
    ],
)
def test_cameras_that_see_nothing_are_refused(arguments, message):
    with pytest.raises(SceneError, match=f"camera: {message}"):
        Camera(**{"eye": (0, 0, 5), "target": (0, 0, 0), **arguments})
