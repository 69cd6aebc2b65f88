"""The stated standard error of every buffer is the scatter over seeds, and a target sends rays where it is large."""

import numpy as np
import pytest

import aolab
from aolab.errors import ParameterError
from aolab.truth import reference
from aolab.truth.adaptive import _mean_of_others
from aolab.truth.buffers import BUFFERS, base_of, standard_error

from .rooms import ceiling_scene, wall_scene

SIZE = (48, 36)
SEEDS = 6


def lit_room():
    """A wall that a lamp nearly touches, under a sky with a sun: every estimator has work to do."""
    lamp = aolab.PointLight((0.15, 0.6, 0.1), (0.5, 0.4, 0.3))
    return wall_scene(lights=(lamp,), environment=aolab.Environment.sky(sun_direction=(1, 1, 0.3)), half_width=3)


@pytest.fixture(scope="module")
def frames():
    settings = {"size": SIZE, "rays": 64, "radius": 1.5, "falloff": 0.5, "buffers": tuple(BUFFERS), "cache": False}
    return [reference(lit_room(), seed=seed, **settings) for seed in range(SEEDS)]


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in BUFFERS if name != "direct"])
def test_it_is_the_scatter_over_seeds(frames, name):
    """Of the root mean square over the image: SEEDS × 1728 pixels hold it within a few per cent."""
    mask = frames[0].mask
    values = np.stack([frame[name][mask] for frame in frames]).astype(np.float64)
    stated = np.stack([frame[standard_error(name)][mask] for frame in frames]).astype(np.float64)
    scatter = np.sqrt(values.var(axis=0, ddof=1).mean())
    assert scatter > 0
    assert np.sqrt((stated**2).mean()) == pytest.approx(scatter, rel=0.1)


@pytest.mark.parametrize("name", ["radiance", "bent_normal"])
def test_integrals_of_the_same_rays_vary_together(name):
    """A ray beside the wall brings either the sky or the wall's light, and no direction but an open one."""
    sun = aolab.DirectionalLight(direction=(-1, 0, 0), irradiance=(2.0, 2.0, 2.0))
    room = wall_scene(lights=(sun,), environment=aolab.Environment.constant(1.0))
    settings = {"size": (24, 18), "rays": 16, "buffers": name, "cache": False}
    frames = [reference(room, seed=seed, **settings) for seed in range(24)]
    mask = frames[0].mask
    values = np.stack([frame[name][mask] for frame in frames]).astype(np.float64)
    stated = np.stack([frame[standard_error(name)][mask] for frame in frames]).astype(np.float64)
    assert np.sqrt((stated**2).mean()) == pytest.approx(np.sqrt(values.var(axis=0, ddof=1).mean()), rel=0.06)


def test_an_exact_buffer_has_none(frames):
    assert (frames[0]["direct_standard_error"][frames[0].mask] == 0).all()
    assert frames[0]["direct"].max() > 0
    np.testing.assert_array_equal(frames[0]["direct"], frames[1]["direct"])


def test_names():
    for name in BUFFERS:
        assert base_of(standard_error(name)) == name
    assert standard_error("visibility") == "standard_error"
    assert standard_error("indirect") == "indirect_standard_error"


def test_a_buffer_and_its_error_come_together():
    frame = reference(ceiling_scene(), size=SIZE, rays=2, buffers="sh1_standard_error")
    assert {"sh1", "sh1_standard_error"} <= set(frame.buffers)
    assert "image_standard_error" not in reference(ceiling_scene(), size=SIZE, rays=2, buffers="image").buffers


def relative_error(frame, name="indirect"):
    """(n,): each pixel's standard error over the buffer's root mean square."""
    error = np.sqrt((frame[standard_error(name)][frame.mask] ** 2).mean(axis=-1))
    return error / np.sqrt((frame[name][frame.mask] ** 2).mean())


def test_a_target_sends_rays_where_the_error_is():
    settings = {"size": SIZE, "rays": 64, "radius": 1.5, "buffers": "indirect", "cache": False}
    plain, aimed = (reference(lit_room(), **settings, **error) for error in ({}, {"error": 0.1}))
    assert np.sqrt((relative_error(plain) ** 2).mean()) > 0.15
    assert 0.07 < np.sqrt((relative_error(aimed) ** 2).mean()) < 0.1
    rays = aimed["rays"][aimed.mask]
    assert rays.min() == 64
    assert rays.max() > 4 * 64
    assert rays.mean() < 0.7 * rays.max()
    noisy = relative_error(plain) > np.median(relative_error(plain))
    assert rays[noisy].mean() > 1.5 * rays[~noisy].mean()


@pytest.mark.slow
def test_a_target_does_not_move_the_mean():
    """Points that stopped when their own first samples agree would be too dark: bright samples are rare."""
    settings = {"size": (16, 12), "rays": 8, "radius": 1.5, "buffers": "indirect", "cache": False}
    exact = reference(lit_room(), **{**settings, "rays": 2048})
    expected = exact["indirect"][exact.mask].mean()
    with pytest.warns(aolab.Notice, match="error = 0.1 is not met in 'indirect'"):
        means = [
            reference(lit_room(), **settings, error=0.1, seed=seed)["indirect"][exact.mask].mean() for seed in range(10)
        ]
    assert abs(np.mean(means) - expected) < 3 * np.std(means, ddof=1) / np.sqrt(len(means))


def test_a_pixel_has_no_say_in_its_own_rays():
    image = np.zeros((9, 9))
    image[4, 4] = 24.0
    image[0, :] = np.nan
    around = _mean_of_others(image)
    assert around[4, 4] == 0
    np.testing.assert_allclose(around[3:6, 3:6][image[3:6, 3:6] == 0], 24 / 24)
    assert around[8, 8] == 0


def test_a_target_is_part_of_the_stored_entry(cache_folder):
    settings = {"size": (16, 12), "rays": 16, "radius": 1.5, "buffers": "visibility"}
    first = reference(lit_room(), **settings, error=0.05)
    assert not reference(lit_room(), **settings).info["cached"]
    again = reference(lit_room(), **settings, error=0.05)
    assert again.info["cached"]
    np.testing.assert_array_equal(first["rays"], again["rays"])


@pytest.mark.parametrize("error", [0, 1, -0.1, float("nan")])
def test_a_target_is_a_share(error):
    with pytest.raises(ParameterError, match=r"error = .* is not a share in \(0, 1\)"):
        reference(lit_room(), error=error)
