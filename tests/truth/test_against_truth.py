"""SSAO beside the rays that mean the same: where the image sees everything they agree; on a scan, within a bound."""

import numpy as np
import pytest
from small_scenes import floor, of, quad, sphere

import aolab

CONVERGED = {"steps": 32, "directions": 16, "accumulate": 8, "filter": "none", "thickness": 10.0, "bias": 0.0}


def seen_whole(scene: aolab.Scene, radius: float, size: tuple[int, int], lab: aolab.Lab):
    """Converged SSAO, the truth, where both speak of what the image can know, and the radius in pixels there."""
    frame = lab.render(scene, "ssao", size=size, radius=radius, falloff=0.5, **CONVERGED)
    truth = aolab.reference(scene, size=size, radius=radius, falloff=0.5, rays=256, cache=False)
    assert scene.camera is not None
    reach = radius / (-frame["viewZ"] * scene.camera.half_extent(size)[1]) * size[1] / 2  # in pixels
    y, x = np.mgrid[: size[1], : size[0]]
    inside = np.minimum(np.minimum(x, size[0] - 1 - x), np.minimum(y, size[1] - 1 - y)) > reach
    known = inside & frame.mask
    return frame, truth, known, reach[known]


@pytest.mark.slow
@pytest.mark.parametrize("angle", [90.0, 120.0, 150.0])
def test_a_corner_open_to_the_camera_agrees_with_rays(lab, angle):
    """Two planes that meet at an angle hide nothing from a camera above them: only sampling errors remain."""
    tilt = np.radians(180 - angle)
    wall = quad((0, 0, 50), (0, 0, -100), (-50 * np.cos(tilt), 50 * np.sin(tilt), 0), name="wall")
    camera = aolab.Camera(eye=(3, 5, 0.01), target=(0, 0, 0), fov=40)
    scene = of(quad((0, 0, 50), (50, 0, 0), (0, 0, -100), name="floor"), wall, camera=camera)
    frame, truth, known, pixels = seen_whole(scene, 1.0, (128, 96), lab)
    error = (frame["visibility"] - truth["visibility"])[known]
    occluded = (truth["visibility"] < 0.99)[known]
    assert occluded.mean() > 0.05
    # beside the noise of the rays, the point is lifted by a pixel, which moves the corner by as much of a radius
    deviation = np.hypot(truth["standard_error"][known], 0.5 / pixels)
    score = error / deviation
    assert abs(score[occluded].mean()) < 0.7
    assert np.mean(np.abs(score) < 3) > 0.97


@pytest.mark.slow
def test_a_ball_on_a_floor_agrees_with_rays_where_it_is_seen(lab):
    """From above, the upper half of a ball that is sunk in the floor hides nothing."""
    camera = aolab.Camera(eye=(0, 8, 0.01), target=(0, 0, 0), fov=35)
    scene = of(floor(), sphere(1.0, (0, 0, 0), subdivisions=5), camera=camera)
    frame, truth, known, _ = seen_whole(scene, 0.8, (96, 96), lab)
    error = (frame["visibility"] - truth["visibility"])[known]
    assert np.sqrt(np.mean(error**2)) < 0.02
    assert abs(error.mean()) < 0.005


@pytest.mark.slow
def test_a_scan_on_a_floor_is_within_two_hundredths(lab, models):
    """16 directions × 4 steps at 960×540, the radius a fifth of the bunny's height: RMSE below 0.02."""
    loaded = aolab.load(models / "bunny.ply").instances[0].mesh
    low, high = loaded.vertices.min(axis=0), loaded.vertices.max(axis=0)
    scale = 1 / (high[1] - low[1])
    place = np.diag([scale, scale, scale, 1.0])
    # a little into the floor: its feet are not flat
    place[:3, 3] = -scale * np.array([(low[0] + high[0]) / 2, low[1] + 0.02 / scale, (low[2] + high[2]) / 2])
    camera = aolab.Camera(eye=(0.9, 1.1, 2.2), target=(0, 0.42, 0), fov=40)
    ground = quad((-4, 0, 4), (8, 0, 0), (0, 0, -8), name="floor")
    scene = aolab.Scene((aolab.Instance(loaded, place), aolab.Instance(ground)), camera=camera)
    module = aolab.SSAO(radius=0.2, directions=16, steps=4)
    frame = lab.render(scene, module, size=(960, 540))
    truth = aolab.reference(scene, size=(960, 540), like=module, rays=128, buffers=("visibility",), cache=False)
    error = (frame["visibility"] - truth["visibility"])[frame.mask]
    assert np.sqrt(np.mean(error**2)) < 0.02
