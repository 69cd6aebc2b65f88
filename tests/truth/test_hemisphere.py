"""The directions: their density, their strata, and the error they state."""

import numpy as np
import pytest

from aolab.errors import ParameterError
from aolab.truth.hemisphere import frames, strata

RANDOM = np.random.default_rng(3)


def unit_vectors(count):
    vectors = RANDOM.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def test_frames_are_orthonormal_and_right_handed():
    normals = np.concatenate([unit_vectors(200), np.eye(3), -np.eye(3)])
    tangent, bitangent, normal = frames(normals)
    np.testing.assert_allclose(np.cross(tangent, bitangent), normals, atol=1e-6)
    np.testing.assert_allclose((tangent * bitangent).sum(axis=1), 0, atol=1e-6)
    np.testing.assert_allclose(normal, normals, atol=1e-6)


def test_directions_are_unit_and_cosine_distributed():
    axes = frames(np.tile([0.0, 0, 1], (2000, 1)))
    directions = np.concatenate([stratum.directions(axes, RANDOM) for stratum in strata(32)])
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-6)
    # under cosθ/π: E[cosθ] = 2/3, E[cos²θ] = 1/2, E[x²] = 1/4, and nothing leans
    np.testing.assert_allclose(directions.mean(axis=0), (0, 0, 2 / 3), atol=2e-3)
    np.testing.assert_allclose((directions**2).mean(axis=0), (1 / 4, 1 / 4, 1 / 2), atol=2e-3)


@pytest.mark.parametrize("rays", [2, 6, 64, 100, 256])
def test_strata_tile_the_square(rays):
    cells = list(strata(rays))
    assert len(cells) == rays // 2
    assert sum(cell.size[0] * cell.size[1] for cell in cells) == pytest.approx(1)
    corners = np.array([cell.low for cell in cells])
    assert len(np.unique(corners.round(9), axis=0)) == len(cells)
    assert corners.min() == 0
    assert (corners + [cell.size for cell in cells]).max() == pytest.approx(1)


@pytest.mark.parametrize("rays", [0, 1, 7, -2, 2.5, "4"])
def test_rays_are_even(rays):
    with pytest.raises(ParameterError, match=r"rays = .* is not an even whole number"):
        next(strata(rays))
