"""Environments blurred to a sample's solid angle: the energy is kept, the lobe has its width, GLSL agrees."""

from itertools import pairwise

import numpy as np
import pytest

from aolab import Environment
from aolab.scene.prefiltered import octahedral_directions, octahedral_uv, prefiltered

LOBES = [0.05, 0.4, np.pi / 4, 2 * np.pi]  # steradians; π/4 is the solid angle of a sample with N = 8


def octahedral_solid_angles(texels: int) -> np.ndarray:
    """(texels, texels) steradians: du dv of the square, projected from |x| + |y| + |z| = 1 onto the sphere."""
    directions = octahedral_directions(texels)
    return (2 / texels) ** 2 * np.abs(directions).sum(axis=-1) ** 3


def one_cell(row: int, column: int) -> Environment:
    """A black map of the blur's resolution with one bright cell of flux ∫ L dω = 1."""
    height, width = 64, 128
    radiance = np.zeros((height, width, 3), np.float32)
    cosine = np.cos(np.pi * np.array([row, row + 1]) / height)
    radiance[row, column] = 1 / ((cosine[0] - cosine[1]) * 2 * np.pi / width)
    return Environment(radiance)


@pytest.mark.parametrize("solid_angle", [0.0, *LOBES])
def test_a_constant_environment_stays_exactly_constant(solid_angle):
    color = np.array((0.3, 0.6, 1.2), np.float32)
    pixels = prefiltered(Environment.constant(tuple(color)), solid_angle)
    assert pixels.dtype == np.float32
    np.testing.assert_allclose(pixels, np.broadcast_to(color, pixels.shape), rtol=2e-7)


@pytest.mark.parametrize("solid_angle", LOBES)
@pytest.mark.parametrize("cell", [(2, 5), (31, 0), (40, 90)], ids=["near the pole", "on the seam", "below"])
def test_a_lobe_keeps_the_flux_and_has_its_solid_angle(solid_angle, cell):
    """The blurred map of a source of flux 1 is the lobe f: ∫ f dω = 1, and 1 / ∫ f² dω is its solid angle.

    For f = κ exp(κ (cosθ - 1)) / (2π (1 - exp(-2κ))) the latter is 4π tanh(κ) / κ.
    """
    lobe = prefiltered(one_cell(*cell), solid_angle)[..., 0].astype(float)
    solid_angles = octahedral_solid_angles(len(lobe))
    assert solid_angles.sum() == pytest.approx(4 * np.pi, rel=0.03)
    kappa = 4 * np.pi / solid_angle
    assert (lobe * solid_angles).sum() == pytest.approx(1, rel=0.06)
    assert 1 / (lobe**2 * solid_angles).sum() == pytest.approx(solid_angle * np.tanh(kappa), rel=0.1)


def test_without_a_lobe_every_texel_is_a_texel_of_the_map():
    """A map red to the right (+x), blue to the left, green in the lower half."""
    radiance = np.zeros((64, 128, 3), np.float32)
    radiance[:, 64:, 0] = radiance[:, :64, 2] = 1
    radiance[32:, :, 1] = 1
    pixels = prefiltered(Environment(radiance), 0.0)
    x, y, _ = np.moveaxis(octahedral_directions(len(pixels)), -1, 0)
    np.testing.assert_array_equal(pixels[..., 0], x > 0)
    np.testing.assert_array_equal(pixels[..., 2], x < 0)
    np.testing.assert_array_equal(pixels[..., 1], y < 1e-12)  # the horizon belongs to the row below it


def test_a_wider_lobe_is_a_smoother_map():
    radiance = np.random.default_rng(3).random((64, 128, 3)).astype(np.float32)
    spread = [prefiltered(Environment(radiance), solid_angle).std() for solid_angle in (0.0, *LOBES)]
    assert all(wide < 0.8 * narrow for narrow, wide in pairwise(spread))


# --- the octahedral map


def test_the_uv_of_a_texels_direction_is_its_centre():
    for texels in (1, 2, 8, 33):
        directions = octahedral_directions(texels)
        np.testing.assert_allclose(np.linalg.norm(directions, axis=-1), 1)
        centre = (np.arange(texels) + 0.5) / texels
        u, v = np.meshgrid(centre, centre)
        np.testing.assert_allclose(octahedral_uv(directions), np.stack([u, v], axis=-1), atol=1e-12)


@pytest.mark.parametrize(
    ("direction", "uv"),
    [
        ((0, 1, 0), (0.5, 0.5)),
        ((1, 0, 0), (1, 0.5)),
        ((-1, 0, 0), (0, 0.5)),
        ((0, 0, 1), (0.5, 1)),
        ((0, 0, -1), (0.5, 0)),
        ((0, -3, 0), (1, 1)),
        ((1, 1, 0), (0.75, 0.5)),
        ((1, -1, 1), (5 / 6, 5 / 6)),
        ((-1, -1, 1), (1 / 6, 5 / 6)),
    ],
)
def test_known_directions_have_known_uv(direction, uv):
    np.testing.assert_allclose(octahedral_uv(np.array(direction)), uv)


def test_the_shader_computes_the_same_uv(glsl):
    directions = np.random.default_rng(1).normal(size=(2000, 3)) * 10.0 ** np.linspace(-3, 3, 2000)[:, None]
    axes = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (1, -1, 0), (0, -1, -1)])
    rows = np.pad(np.concatenate([directions, axes]), ((0, 0), (0, 1)))
    found = glsl("lib/octahedral.glsl", "result.xy = octahedralUv(x.xyz);", rows)[:, :2]
    np.testing.assert_allclose(found, octahedral_uv(rows[:, :3]), atol=1e-5)
