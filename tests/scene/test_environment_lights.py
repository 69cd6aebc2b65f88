"""An environment as lights: all of its light, at the right places."""

import numpy as np
import pytest

from aolab import Environment
from aolab.scene.environment_lights import environment_lights

SKY = Environment.sky(sun_direction=(1, 1, 0))


@pytest.mark.parametrize("environment", [SKY, Environment.constant((0.5, 1.0, 2.0))], ids=["sky", "constant"])
@pytest.mark.parametrize("count", [1, 16, 256])
def test_their_light_is_that_of_the_environment(environment, count):
    towards, sent = environment_lights(environment, count)
    assert len(towards) == count
    np.testing.assert_allclose(np.linalg.norm(towards, axis=1), 1)
    total = environment.radiance_sh[0] * np.sqrt(4 * np.pi)  # ∫ L dω
    np.testing.assert_allclose(sent.sum(axis=0), total, rtol=2e-3)


def test_the_irradiance_comes_near_to_the_environments_as_lights_are_added():
    normals = np.random.default_rng(0).normal(size=(50, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    sky = Environment.sky()
    exact, errors = sky.irradiance(normals), []
    for count in (4, 32, 256):
        towards, sent = environment_lights(sky, count)
        arriving = np.maximum(normals @ towards.T, 0) @ sent
        errors.append(np.sqrt(np.mean((arriving - exact) ** 2)) / exact.mean())
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.02


def test_the_sun_is_a_light_where_it_stands():
    towards, sent = environment_lights(SKY, 64)
    brightest = sent.sum(axis=1) / np.maximum(sent.sum(), 1e-9)
    sun = towards @ np.array((1, 1, 0)) / np.sqrt(2)
    assert brightest[sun > np.cos(np.radians(5))].sum() > 0.1


def test_a_burning_pixel_is_one_light_and_the_rest_keeps_its_own():
    radiance = np.full((32, 64, 3), 0.5, np.float32)
    radiance[8, 20] = 1e7
    towards, sent = environment_lights(Environment(radiance), 64)
    assert len(towards) >= 60
    assert np.isfinite(sent).all()
    assert (sent.sum(axis=1) > 1e3).sum() <= 4  # a texel of the table that is repeated to 64 rows is four
    dim = sent[sent.sum(axis=1) < 1e3]
    assert dim.sum() == pytest.approx(0.5 * 4 * np.pi * 3, rel=0.02)


def test_a_dark_environment_has_no_light():
    towards, sent = environment_lights(Environment.constant(0.0), 64)
    assert towards.shape == sent.shape == (0, 3)
