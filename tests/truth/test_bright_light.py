"""Rays towards what is bright and small: lamps that nearly touch a wall, suns in the environment. The mean stays."""

import numpy as np
import pytest

import aolab
from aolab.scene.environment import Environment, direction_from_uv, uv_from_direction
from aolab.truth import lamps, reference, sky
from aolab.truth.hemisphere import strata

from .rooms import quad, scene, wall_scene

SIZE = (40, 30)
SUNNY = Environment.sky(sun_direction=(1, 1, 0.2))


def test_even_and_bright_part_are_the_whole():
    parts = sky.Sky(SUNNY)
    directions = np.random.default_rng(1).normal(size=(5000, 3)).astype(np.float32)
    directions[0] = (1, 1, 0.2)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    whole = sky.environment_radiance(SUNNY, directions)
    bright = sky._look_up(parts._bright, directions)
    np.testing.assert_allclose(parts.even(directions) + bright, whole, rtol=1e-4, atol=1e-5)
    assert parts.has_bright_part
    assert bright[0].min() > 50
    assert (bright == 0).mean() > 0.9
    mean = (whole @ sky.REC_709).mean()
    assert (parts.even(directions) @ sky.REC_709).max() < 2 * sky.BRIGHT * mean


@pytest.mark.parametrize("environment", [Environment.constant(3.0), Environment.sky(), Environment.constant(0.0)])
def test_an_even_sky_has_no_bright_part(environment):
    assert not sky.Sky(environment).has_bright_part


def test_directions_towards_the_bright_part_integrate_it():
    """∫ L dω and ∫ L ω dω, by samples and by the map's own cells; the seam and the pole are bright, too."""
    radiance = np.full((32, 64, 3), 0.01, np.float32)
    radiance[0, 20], radiance[15, 0], radiance[20, 40:42] = (9, 1, 1), (1, 9, 1), (2, 2, 9)
    parts = sky.Sky(Environment(radiance))
    u, v = np.random.default_rng(2).random((2, 200_000), np.float32)
    directions, weighted = parts.towards_bright(u, v)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-5)
    fine = np.random.default_rng(3).normal(size=(1_000_000, 3)).astype(np.float32)
    fine /= np.linalg.norm(fine, axis=1, keepdims=True)
    values = sky._look_up(parts._bright, fine)
    np.testing.assert_allclose(weighted.mean(axis=0), 4 * np.pi * values.mean(axis=0), rtol=0.05)
    np.testing.assert_allclose(weighted.T @ directions / len(u), 4 * np.pi * (values.T @ fine) / len(fine), atol=0.01)


def test_every_direction_towards_the_bright_part_brings_as_much():
    """Directions follow the interpolated map itself, cell by cell of a quarter texel; the pole's row is repeated."""
    radiance = np.full((16, 32, 3), 0.01, np.float32)
    radiance[6:8, 12:14], radiance[10, 31], radiance[0, 5] = 9, 5, 9
    parts = sky.Sky(Environment(radiance))
    u, v = np.random.default_rng(2).random((2, 400_000), np.float32)
    directions, weighted = parts.towards_bright(u, v)
    assert weighted[directions[:, 1] < 0.9].std() < 0.05 * weighted.mean()
    at = uv_from_direction(directions)
    found = np.histogram2d(at[:, 1], at[:, 0], (64, 128), ((0, 1), (0, 1)))[0] / len(u)
    columns, rows = np.meshgrid((np.arange(1024) + 0.5) / 1024, (np.arange(512) + 0.5) / 512)
    towards = direction_from_uv(np.stack([columns, rows], axis=-1)).reshape(-1, 3).astype(np.float32)
    light = sky._look_up(parts._bright, towards)[:, 0].reshape(rows.shape) * np.sin(np.pi * rows)
    expected = light.reshape(64, 8, 128, 8).sum(axis=(1, 3)) / light.sum()
    away = np.arange(64) >= 4  # beside the pole the sine is not interpolated
    assert np.abs(found - expected)[away].sum() < 0.06


def open_plane(environment):
    camera = aolab.Camera(eye=(0, 3, 1), target=(0, 0, 0))
    return scene(quad((0, 0, 0), (0, 0, 9), (9, 0, 0)), camera=camera, environment=environment)


def test_a_sun_on_an_open_plane_is_its_irradiance_with_little_noise():
    height, width = SUNNY.radiance.shape[:2]
    cosine = -np.diff(np.cos(np.pi * np.arange(height + 1) / height) ** 2) / 2  # ∫ cosθ sinθ dθ of a row, signed
    expected = 0.8 / np.pi * np.maximum(cosine, 0) @ SUNNY.radiance.sum(axis=1) * 2 * np.pi / width
    frame = reference(open_plane(SUNNY), size=SIZE, rays=64, buffers="ambient")
    np.testing.assert_allclose(frame["ambient"].mean(axis=(0, 1)), expected, rtol=0.01)
    assert frame["ambient_standard_error"].mean() < 0.05 * expected.mean()


def without_bright_rays(monkeypatch):
    monkeypatch.setattr(sky, "BRIGHT", 1e9)
    monkeypatch.setattr(lamps, "is_lamp", lambda light: False)


def with_a_screen(room):
    """Between the spot that the lamp makes on the wall and a part of the floor."""
    screen = quad((0.6, 0.25, 0), (0, 0.25, 0), (0, 0, 0.4))
    return room.replace(instances=(*room.instances, aolab.Instance(screen)))


def lit_rooms():
    lamp = aolab.PointLight((0.2, 0.5, 0.1), (0.5, 0.4, 0.3))
    spot = aolab.SpotLight((0.6, 0.9, 0), (-1, -0.8, 0.1), (1.0, 0.9, 0.8), inner=5, outer=40)
    return {
        "sun": wall_scene(environment=SUNNY),
        "lamp": with_a_screen(wall_scene(lights=(lamp,))),
        "spot": wall_scene(lights=(spot,)),
        "near lamp": wall_scene(lights=(aolab.PointLight((0.05, 0.5, 0.1)),)),
        "all": wall_scene(lights=(lamp, spot), environment=SUNNY),
    }


@pytest.mark.parametrize(
    ("light", "question"),
    [
        ("sun", {}),
        ("lamp", {}),
        ("spot", {"radius": 0.8, "falloff": 0.5}),
        ("all", {"radius": 1.5, "falloff": 0.3, "spread": 0.7}),
    ],
)
def test_the_mean_is_that_of_rays_over_the_hemisphere_alone(monkeypatch, light, question):
    room = lit_rooms()[light]
    settings = {"size": SIZE, "buffers": ("ambient", "indirect"), "cache": False, **question}
    aimed = reference(room, rays=128, **settings)
    without_bright_rays(monkeypatch)
    plain = reference(room, rays=512, seed=1, **settings)
    for name in ("ambient", "indirect"):
        error = f"{name}_standard_error"
        variances = [(frame[error][frame.mask].astype(float) ** 2).sum(axis=0) for frame in (aimed, plain)]
        difference = (aimed[name] - plain[name])[aimed.mask].astype(float).sum(axis=0)
        assert (np.abs(difference) <= 4 * np.sqrt(sum(variances)) + 1e-6).all()


@pytest.mark.parametrize(
    ("light", "name", "gain"), [("sun", "ambient", 4), ("sun", "indirect", 2.5), ("near lamp", "indirect", 2)]
)
def test_the_noise_falls(monkeypatch, light, name, gain):
    def noise():
        frame = reference(lit_rooms()[light], size=SIZE, rays=64, buffers=name, cache=False)
        return np.sqrt((frame[f"{name}_standard_error"][frame.mask] ** 2).mean())

    aimed = noise()
    without_bright_rays(monkeypatch)
    assert noise() > gain * aimed


@pytest.mark.parametrize(
    "light", [aolab.PointLight((1, 2, 3)), aolab.SpotLight((1, 2, 3), (0.3, -1, 0.2), inner=10, outer=35)]
)
def test_rays_from_a_lamp_follow_its_falloff(light):
    """Each brings the same share of the light: a histogram over the cosine to the axis is the falloff."""
    random = np.random.default_rng(4)
    cells = [stratum.square(4000, random) for stratum in strata(64)]
    u, v = (np.concatenate([cell[i] for cell in cells]) for i in (0, 1))
    directions = lamps._directions(light, u, v)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-5)
    if isinstance(light, aolab.PointLight):
        np.testing.assert_allclose(directions.mean(axis=0), 0, atol=5e-3)
        np.testing.assert_allclose((directions**2).mean(axis=0), 1 / 3, atol=5e-3)
        return
    cosine = directions @ (np.asarray(light.direction) / np.linalg.norm(light.direction))
    inner, outer = np.cos(np.radians([light.inner, light.outer]))
    edges = np.linspace(outer, 1, 21)
    middle = (edges[1:] + edges[:-1]) / 2
    falloff = np.clip((middle - outer) / (inner - outer), 0, 1) ** 2
    found = np.histogram(cosine, edges)[0] / len(cosine)
    np.testing.assert_allclose(found, falloff / falloff.sum(), atol=2e-3)
    assert lamps._solid_angle(light) == pytest.approx(2 * np.pi * falloff.sum() * (edges[1] - edges[0]), rel=5e-3)


def test_a_light_through_walls_and_a_light_from_afar_are_no_lamps():
    assert lamps.is_lamp(aolab.PointLight((0, 0, 0)))
    assert not lamps.is_lamp(aolab.PointLight((0, 0, 0), shadow=False))
    assert not lamps.is_lamp(aolab.DirectionalLight((0, -1, 0)))
