"""The reference against exact answers, within its own standard error."""

import numpy as np
import pytest
import trimesh

import aolab
from aolab.truth import reference

from .rooms import CEILING, WALL_HEIGHT, ceiling_scene, quad, scene, wall_scene, world_positions

SIZE = (64, 48)


def assert_within_standard_error(frame, exact):
    """The mean error over the image is 0 within 3 standard errors, and the stated errors are as large as the true."""
    known = frame.mask & np.isfinite(exact + 0 * frame["viewZ"])
    error = (frame["visibility"].astype(np.float64) - exact)[known]
    stated = frame["standard_error"][known].astype(np.float64)
    assert len(error) > 1000
    assert 0 < np.sqrt((stated**2).mean()) < 0.05
    assert abs(error.mean()) < 3 * np.sqrt((stated**2).sum()) / len(error)
    assert 0.9 < (error**2).mean() / (stated**2).mean() < 1.1


def image_of(values, frame):
    """(H, W) from values at the pixels that show a surface."""
    image = np.full(frame.mask.shape, np.nan)
    image[frame.mask] = values
    return image


def rotation(seed):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.diag(r))


@pytest.mark.parametrize("seed", range(6))
def test_a_plane_anywhere_is_open_exactly(seed):
    axes = rotation(seed).T
    centre = np.random.default_rng(seed).normal(size=3) * 10.0**seed / 10
    camera = aolab.Camera(tuple(centre + 2 * axes[2] + 0.7 * axes[0]), tuple(centre), up=tuple(axes[1]), fov=60)
    plane = scene(quad(centre, axes[0] * 3, axes[1] * 3), camera=camera)
    frame = reference(plane, size=SIZE, rays=64, buffers=("visibility", "standard_error"))
    assert (frame["visibility"][frame.mask] == 1).all()
    assert (frame["standard_error"][frame.mask] == 0).all()


def test_harmonics_and_bent_normal_of_an_open_plane():
    camera = aolab.Camera(eye=(0, 0, 3), target=(0, 0, 0), fov=40)
    plane = scene(quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), camera=camera)
    frame = reference(plane, size=SIZE, rays=256, buffers=("sh0", "sh1", "sh2", "sh3", "bent_normal"))
    coefficients = np.concatenate([frame[f"sh{i}"] for i in range(4)], axis=-1).mean(axis=(0, 1))
    expected = np.zeros(16)
    expected[[0, 2, 6]] = 0.886227, 1.023327, 0.495416  # the clamped cosine around z: bands 0, 1, 2, and 0 in band 3
    np.testing.assert_allclose(coefficients, expected, atol=1e-3)
    np.testing.assert_allclose(frame["bent_normal"].mean(axis=(0, 1)), (0, 0, 2 / 3), atol=1e-3)


@pytest.mark.parametrize("engine", ["embree", "numpy"])
def test_floor_beside_a_wall(engine):
    rays = 256 if engine == "embree" else 64
    frame = reference(
        wall_scene(), size=SIZE, rays=rays, buffers=("visibility", "standard_error"), engine=engine, seed=4
    )
    x = world_positions(frame)[:, 0]
    assert x.min() < 0.8
    assert x.max() > 1.6
    assert_within_standard_error(frame, image_of((1 + x / np.hypot(x, WALL_HEIGHT)) / 2, frame))


def test_plane_under_a_sphere():
    radius, height = 0.5, 0.8
    ball = trimesh.creation.icosphere(subdivisions=5, radius=radius)
    vertices = ball.vertices * (4 / 3 * np.pi * radius**3 / ball.volume) ** (1 / 3) + (0, height, 0)
    sphere = aolab.Mesh(vertices, ball.faces)
    camera = aolab.Camera(eye=(2.6, 0.35, 0), target=(1.4, 0, 0), fov=20)
    frame = reference(
        scene(quad((0, 0, 0), (0, 0, 6), (6, 0, 0)), sphere, camera=camera),
        size=SIZE,
        rays=256,
        buffers=("visibility", "standard_error"),
    )
    position = world_positions(frame)
    occlusion = height * radius**2 / (height**2 + position[:, 0] ** 2 + position[:, 2] ** 2) ** 1.5
    on_plane = np.abs(position[:, 1]) < 1e-3
    assert_within_standard_error(frame, image_of(np.where(on_plane, 1 - occlusion, np.nan), frame))


@pytest.mark.parametrize("falloff", [0.0, 0.5, 1.0])
def test_falloff_under_a_ceiling(falloff):
    """cos²θ is uniform under cosθ/π, the ceiling is at d = c / cosθ: ∫ (1 - smoothstep(√(k/s))) ds, k = (c/R)²."""
    k = 0.3  # no edge of a ring of strata: there the answer would be exact
    frame = reference(
        ceiling_scene(),
        size=SIZE,
        radius=CEILING / np.sqrt(k),
        falloff=falloff,
        buffers=("visibility", "standard_error"),
    )
    s = (np.arange(100_000) + 0.5) / 100_000
    t = np.clip((np.sqrt(k / s) - (1 - falloff)) / falloff, 0, 1) if falloff else (s <= k).astype(float)
    blocked = (1 - t * t * (3 - 2 * t)).mean()
    assert_within_standard_error(frame, 1 - blocked)


def test_nothing_beyond_the_radius_blocks():
    for falloff in (0.0, 1.0):
        frame = reference(ceiling_scene(), size=SIZE, rays=32, radius=0.99 * CEILING, falloff=falloff)
        assert (frame["visibility"][frame.mask] == 1).all()


def test_the_error_falls_faster_than_that_of_independent_rays():
    errors = [
        np.nanmean(reference(wall_scene(), size=SIZE, rays=rays, buffers="standard_error")["standard_error"])
        for rays in (32, 512)
    ]
    assert errors[1] < errors[0] / 4 / 1.3  # 16 times the rays: independent ones would give exactly a quarter
