"""The light of open directions, and the light that blocked directions reflect."""

import numpy as np
import pytest

import aolab
from aolab.scene.environment import direction_from_uv
from aolab.truth import reference
from aolab.truth.sky import environment_radiance

from .rooms import ceiling_scene, quad, scene, wall_scene, world_positions

SIZE = (64, 48)


@pytest.mark.parametrize("falloff", [0.0, 0.7])
def test_ambient_under_a_constant_sky_is_albedo_times_sky_times_visibility(falloff):
    sky = np.array([0.5, 1.0, 2.0])
    lit = wall_scene(environment=aolab.Environment.constant(tuple(sky)))
    frame = reference(lit, size=SIZE, rays=32, radius=1.5, falloff=falloff, buffers=("ambient", "visibility"))
    expected = frame["albedo"] * sky * np.nan_to_num(frame["visibility"])[..., None]
    np.testing.assert_allclose(frame["ambient"], expected, rtol=1e-5, atol=1e-6)


def test_ambient_of_an_open_plane_is_the_environments_irradiance():
    sky = aolab.Environment.sky()
    camera = aolab.Camera(eye=(0, 3, 1), target=(0, 0, 0))
    plane = scene(quad((0, 0, 0), (0, 0, 9), (9, 0, 0)), camera=camera, environment=sky)
    frame = reference(plane, size=SIZE, rays=256, buffers="ambient")
    height, width = sky.radiance.shape[:2]
    cosine = np.cos(np.pi * (np.arange(height) + 0.5) / height)
    weights = np.maximum(cosine, 0) * np.sqrt(1 - cosine**2) * 2 * np.pi**2 / (height * width)
    irradiance = np.einsum("h,hwc->c", weights, sky.radiance)
    expected = frame["albedo"][24, 32] / np.pi * irradiance
    np.testing.assert_allclose(frame["ambient"].mean(axis=(0, 1)), expected, rtol=3e-3)


def test_the_environment_is_read_bilinearly_and_around_the_seam():
    radiance = np.random.default_rng(0).random((4, 8, 3)).astype(np.float32)
    environment = aolab.Environment(radiance)
    u, v = np.meshgrid((np.arange(8) + 0.5) / 8, (np.arange(4) + 0.5) / 4)
    centres = direction_from_uv(np.stack([u, v], axis=-1)).reshape(-1, 3)
    np.testing.assert_allclose(environment_radiance(environment, centres), radiance.reshape(-1, 3), atol=1e-5)
    seam = direction_from_uv(np.array([[0.0, 1.5 / 4], [1.0, 1.5 / 4]]))
    between = (radiance[1, 0] + radiance[1, -1]) / 2
    np.testing.assert_allclose(environment_radiance(environment, seam), [between, between], atol=1e-5)


@pytest.mark.parametrize("reach", [{}, {"radius": 2.0, "falloff": 0.8}])
def test_one_bounce_from_an_evenly_lit_wall(reach):
    """All of the wall has one radiance; the floor receives it in every blocked direction, as far as it blocks."""
    sun = aolab.DirectionalLight(direction=(-1, 0, 0), irradiance=(1.0, 2.0, 3.0))  # along the floor, onto the wall
    frame = reference(
        wall_scene(floor_albedo=0.5, wall_albedo=0.25, lights=(sun,)),
        size=SIZE,
        rays=64,
        buffers=("indirect", "visibility", "direct"),
        **reach,
    )
    closed = (1 - frame["visibility"])[frame.mask, None]
    expected = 0.5 * closed * 0.25 / np.pi * np.array([1, 2, 3])
    np.testing.assert_allclose(frame["indirect"][frame.mask], expected, rtol=2e-3, atol=1e-5)
    np.testing.assert_allclose(frame["direct"][frame.mask], 0, atol=1e-5)


@pytest.mark.parametrize("reach", [{}, {"radius": 1.5, "falloff": 0.4}])
def test_one_bounce_of_the_sky_from_a_wall(reach):
    """The sky ends at the horizon: every point of the wall faces one half of it, and floors below give nothing.

    So the wall's irradiance is π/2, wherever the floor ends, and it sends albedo · 1/2 along each closed direction.
    """
    half = np.zeros((256, 4, 3), np.float32)
    half[:128] = (1.0, 2.0, 4.0)
    room = wall_scene(floor_albedo=0.5, wall_albedo=0.6, environment=aolab.Environment(half))
    frame = reference(room, size=SIZE, rays=256, buffers=("indirect", "visibility"), **reach)
    closed = 1 - frame["visibility"][frame.mask]
    found, error = (frame[name][frame.mask] for name in ("indirect", "indirect_standard_error"))
    expected = 0.5 * 0.6 * 0.5 * closed[:, None] * np.array([1.0, 2.0, 4.0])
    assert expected.mean() > 10 * np.sqrt((error**2).mean() / len(error))
    assert (np.abs((found - expected).mean(axis=0)) < 4 * np.sqrt((error**2).sum(axis=0)) / len(error)).all()


def test_a_sender_beyond_the_radius_does_not_reflect():
    sun = aolab.DirectionalLight(direction=(-1, 0, 0))
    lit = wall_scene(lights=(sun,))
    frame = reference(lit, size=SIZE, rays=64, radius=1.0, buffers=("indirect", "visibility"))
    x = world_positions(frame)[:, 0]
    assert (frame["indirect"][frame.mask][x > 1.01] == 0).all()
    assert (frame["indirect"][frame.mask][x < 0.8] > 0).all()


def test_shadows_are_hard_and_where_they_belong():
    """The sun stands behind the wall at 45°: the floor is dark up to x = the wall's height, and so is its front."""
    sun = aolab.DirectionalLight(direction=(1, -1, 0), irradiance=(3.0,) * 3)
    frame = reference(wall_scene(lights=(sun,)), size=SIZE, rays=2, buffers=("direct", "indirect"))
    x = world_positions(frame)[:, 0]
    direct = frame["direct"][frame.mask]
    assert (direct[x < 0.999] == 0).all()
    np.testing.assert_allclose(direct[x > 1.001], 0.8 / np.pi * 3 * np.sqrt(0.5), rtol=1e-3)
    assert (frame["indirect"][frame.mask] == 0).all()


@pytest.mark.parametrize(
    "light",
    [
        aolab.DirectionalLight((0.4, -1, 0.2), (2.0, 1.0, 0.5)),
        aolab.PointLight((1.0, 1.5, 0.3), (2.0, 1.0, 0.5)),
        aolab.SpotLight((1.5, 2.0, 0.3), (-0.2, -1, 0), (4.0, 4.0, 4.0), inner=5, outer=25),
    ],
)
def test_direct_light_is_that_of_a_render(light):
    lit = wall_scene(lights=(light,), half_width=3)
    render = aolab.render(lit, "none", size=SIZE)
    truth = reference(lit, size=SIZE, rays=2, buffers="direct")
    assert truth["direct"].max() > 0.05
    difference = np.abs(truth["direct"] - render["direct"])
    assert np.median(difference[truth.mask]) < 2e-3 * truth["direct"].max()
    assert (difference.max(axis=-1) > 0.02 * truth["direct"].max()).mean() < 0.1  # the shadow map's soft edges


def test_a_light_without_shadow_shines_through():
    sun = aolab.DirectionalLight(direction=(1, -1, 0), shadow=False)
    frame = reference(wall_scene(lights=(sun,)), size=SIZE, rays=2, buffers="direct")
    assert (frame["direct"][frame.mask] > 0).all()


def test_radiance_is_the_sum_over_the_environment_and_the_image_shows_it():
    lit = ceiling_scene(
        environment=aolab.Environment.sky(), lights=(aolab.PointLight((0.5, 0.5, 0), (0.2, 0.2, 0.2)),)
    ).replace(camera=aolab.Camera(eye=(0, 3, 18), target=(0, 0.5, 0), fov=40))
    names = ("direct", "ambient", "indirect", "radiance", "image")
    frame = reference(lit, size=SIZE, rays=16, buffers=names)
    assert 0.005 < frame.mask.mean() < 0.9
    total = frame["direct"] + frame["ambient"] + frame["indirect"]
    np.testing.assert_allclose(frame["radiance"][frame.mask], total[frame.mask], rtol=1e-5, atol=1e-6)
    render = aolab.render(lit, "none", size=SIZE)
    background = ~frame.mask
    np.testing.assert_allclose(frame["radiance"][background], render["radiance"][background], rtol=5e-3)
    assert np.abs(frame.image[background].astype(int) - render.image[background]).max() <= 1
