"""SSAO against exact answers: the table at the end of the digest of papers."""

import numpy as np
import pytest
import small_scenes
from numpy.typing import NDArray

import aolab
from aolab.modules.base import auto_radius

CAMERAS = {
    "above": aolab.Camera((0, 3, 6), (0, 0, 0)),
    "straight down": aolab.Camera((3, 80, 2), (0, 0, 1)),
    "grazing": aolab.Camera((0, 0.05, 6), (0, 0, 0)),
    "horizon, eye near the floor": aolab.Camera((0, 0.3, 50), (0, 0, 0)),
    "far away": aolab.Camera((0, 1000, 2000), (0, 0, 0)),
    "rolled": aolab.Camera((20, 1, 30), (0, 0, 0), up=(0.3, 1, 0.2)),
    "wide": aolab.Camera((0, 3, 6), (0, 0, 0), fov=150),
    "narrow": aolab.Camera((0, 3, 6), (0, 0, 0), fov=2),
}
SIZES = [(1, 1), (1, 7), (17, 9), (33, 64)]


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("camera", CAMERAS)
def test_an_unoccluded_plane_is_exactly_open(lab, camera, size):
    scene = small_scenes.plane(CAMERAS[camera])
    for radius in (1e-4, 0.5, 10.0, 1000.0):
        for scale in (1.0, 0.5, 0.125):
            frame = lab.render(scene, "ssao", size=size, radius=radius, scale=scale, bias=0.0, filter="none", seed=7)
            assert frame["visibility"][frame.mask].min(initial=1) >= small_scenes.OPEN, (radius, scale)


@pytest.mark.parametrize("filter", ["none", "box4", "bilateral"])
@pytest.mark.parametrize("steps", [1, 4])
def test_an_unoccluded_plane_is_exactly_open_through_every_filter(lab, filter, steps):
    for camera in ("above", "grazing", "rolled"):
        for scale in (1.0, 0.5):
            settings = {"filter": filter, "steps": steps, "scale": scale, "radius": 1.0}
            frame = lab.render(small_scenes.plane(CAMERAS[camera]), "ssao", size=(64, 48), **settings)
            assert frame.mask.any()
            assert (frame["visibility"][frame.mask] >= small_scenes.OPEN).all()


def test_an_unoccluded_plane_stays_exactly_open_when_averaged(lab):
    frame = lab.render(small_scenes.plane(), size=(33, 64), accumulate=5, radius=2.0, filter="box4")
    np.testing.assert_allclose(frame["visibility"][frame.mask], 1.0, atol=1e-6)  # five shares of 1/5


# --- a floor in front of a wall


def wall_visibility(distance: NDArray, radius: float, falloff: float) -> NDArray:
    """AO of a floor at `distance` from an endless wall, of which rays of length `radius` see only a part.

    Cosine-distributed directions are uniform over the unit disc (Nusselt's analogue), and a ray of length ρ meets the
    wall where its disc coordinate towards it is over c = distance / ρ: the blocked share is a circular segment,
    (arccos c - c √(1 - c²)) / π. The reach ρ, which smoothstep leaves to chance, is averaged over ξ in [0, 1].
    """
    xi = (np.arange(400) + 0.5) / 400
    reach = radius * (1 - falloff + falloff * (0.5 - np.sin(np.arcsin(1 - 2 * xi) / 3)))
    c = np.clip(distance[..., None] / reach, 0, 1)
    return 1 - ((np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi).mean(axis=-1)


def test_the_walls_formula_is_the_digests_for_an_unlimited_radius():
    """AO = ½ (1 + x / √(x² + h²)) of a wall without end is ½."""
    assert wall_visibility(np.array([1e-6]), 1.0, 0.0)[0] == pytest.approx(0.5, abs=1e-5)


@pytest.mark.parametrize("falloff", [0.0, 0.5, 1.0])
def test_a_floor_in_front_of_a_wall(lab, wall, falloff):
    """One layer is exact here: the camera sees all of the wall within the radius, and the wall is thick without end."""
    settings = {"radius": 1.0, "thickness": 10.0, "bias": 0.0, "falloff": falloff, "filter": "none", "directions": 16}
    frame = lab.render(wall, "ssao", size=(96, 72), steps=32, accumulate=16, **settings)
    x, y, z = np.moveaxis(small_scenes.world_positions(frame, wall.camera), -1, 0)
    near = (np.abs(y) < 1e-3) & (np.abs(z) < 0.5) & (x > 0.05) & (x < 1.2)
    assert near.sum() > 100
    error = frame["visibility"][near] - wall_visibility(x[near], 1.0, falloff)
    assert abs(error.mean()) < 0.005  # the last of 32 steps ends 1/64 short of the radius, on average
    assert np.sqrt((error**2).mean()) < 0.015  # 256 directions a pixel, and depth known at texels' centres only
    beyond = (np.abs(y) < 1e-3) & (np.abs(z) < 0.5) & (x > 1.05)
    assert (frame["visibility"][beyond] == 1).all()


def test_twice_the_steps_come_twice_as_close_to_rays(lab, wall):
    """The last of n steps ends half a step short of the radius, on average."""
    settings = {"radius": 1.0, "thickness": 10.0, "bias": 0.0, "falloff": 0.0, "filter": "none", "directions": 16}
    error = {}
    for steps in (1, 2, 4, 8):
        frame = lab.render(wall, "ssao", size=(96, 72), steps=steps, accumulate=8, **settings)
        x, y, z = np.moveaxis(small_scenes.world_positions(frame, wall.camera), -1, 0)
        near = (np.abs(y) < 1e-3) & (np.abs(z) < 0.5) & (x > 0.1) & (x < 0.9)
        error[steps] = (frame["visibility"][near] - wall_visibility(x[near], 1.0, 0.0)).mean()
    assert error[1] > 1.5 * error[2] > 1.5**2 * error[4] > 1.5**3 * error[8] > 0


# --- a plane under a sphere


def test_a_plane_under_a_sphere(lab):
    """occlusion = c r² / (c² + s²)^{3/2}, unlimited radius, on the floor between the camera and the sphere.

    One layer suffices there: the camera looks from just behind those points, so that their rays that meet the sphere
    enter it by the side that the camera sees; only nearer than s = 2 does what is hidden behind it count as solid.
    """
    camera = aolab.Camera((0, 1.0, 4.2), (0, 0.8, 0), fov=75)
    settings = {"radius": 6.0, "thickness": 1 / 6, "bias": 0.0, "falloff": 0.0, "filter": "none", "directions": 16}
    scene = small_scenes.ball(1.0, 1.5, camera)
    frame = lab.render(scene, "ssao", size=(80, 60), steps=64, accumulate=24, **settings)
    x, y, z = np.moveaxis(small_scenes.world_positions(frame, camera), -1, 0)
    distance = np.hypot(x, z)
    seen = (np.abs(y) < 1e-3) & (np.abs(x) < 0.5) & (z > 1.9)
    assert seen.sum() > 100
    error = 1 - frame["visibility"][seen] - 1.5 / (1.5**2 + distance[seen] ** 2) ** 1.5
    assert abs(error.mean()) < 0.004
    assert np.sqrt((error**2).mean()) < 0.01
    assert (1 - frame["visibility"][seen]).min() > 0.02  # the answer is not simply 1


# --- parameters


def test_power_is_an_exponent(lab, boxes):
    plain, squared = (lab.render(boxes, "ssao", power=power, filter="none")["visibility"] for power in (1.0, 2.0))
    np.testing.assert_allclose(squared, plain**2, atol=2e-3)  # half floats


def test_falloff_lets_distant_occluders_go(lab, wall):
    hard, soft = (lab.render(wall, "ssao", falloff=falloff, radius=1.0, accumulate=4) for falloff in (0.0, 1.0))
    assert np.nanmean(soft["visibility"]) > np.nanmean(hard["visibility"]) + 0.01


def test_thickness_keeps_a_far_foreground_from_casting_a_halo(lab):
    """A post 4 units before a wall that it does not touch: with the range check the wall beside it is nearly open."""
    scene = small_scenes.of(
        small_scenes.quad((-20, -20, 0), (40, 0, 0), (0, 40, 0)),
        small_scenes.box((-0.2, -20, 4), (0.2, 20, 4.2)),
        camera=aolab.Camera((0, 0, 10), (0, 0, 0)),
    )
    thin = lab.render(scene, "ssao", radius=1.0, thickness=0.8, filter="none")
    thick = lab.render(scene, "ssao", radius=1.0, thickness=10.0, filter="none")
    behind = thin["viewZ"] < -9
    assert (thin["visibility"][behind] == 1).all()
    assert thick["visibility"][behind].min() < 0.9


def test_the_automatic_radius_is_a_number_by_the_time_it_renders(lab, boxes):
    frame = lab.render(boxes, "ssao")
    radius = frame.info["parameters"]["radius"]
    assert radius == auto_radius(boxes)
    np.testing.assert_array_equal(frame["visibility"], lab.render(boxes, "ssao", radius=radius)["visibility"])


def test_nothing_off_the_screen_blocks(lab):
    """A wall that the camera does not see leaves the floor open: it is not in image space."""
    scene = small_scenes.wall(camera=aolab.Camera((1.2, 3, 0), (1.2, 0, 0.0001), fov=20))
    frame = lab.render(scene, "ssao", radius=2.0, thickness=10.0)
    assert (frame["visibility"] == 1).all()
