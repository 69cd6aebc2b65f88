"""The sample sets: their density, their strata, and the distribution of their reach."""

import numpy as np
import pytest

from aolab.maths.sampling import cosine_hemisphere, influence, radical_inverse


def unit(kernel: np.ndarray) -> np.ndarray:
    return kernel[:, :3] / np.linalg.norm(kernel[:, :3], axis=1, keepdims=True)


def test_radical_inverse_mirrors_the_digits():
    np.testing.assert_allclose(radical_inverse(np.arange(5), 2), [0, 1 / 2, 1 / 4, 3 / 4, 1 / 8])
    np.testing.assert_allclose(radical_inverse(np.array([1, 2, 3, 5]), 3), [1 / 3, 2 / 3, 1 / 9, 2 / 3 + 1 / 9])


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("count", [1, 2, 16, 63, 256])
def test_every_stratum_of_elevation_has_one_direction(count, seed):
    """With the density cosθ/π, u = sin²θ is uniform. Each of its `count` equal strata has one direction."""
    way = unit(cosine_hemisphere(count, seed).astype(float))
    strata = np.floor((1 - way[:, 2] ** 2) * count * (1 - 1e-6))
    np.testing.assert_array_equal(np.sort(strata), np.arange(count))
    assert (way[:, 2] >= 0).all()


def test_the_mean_height_matches_a_cosine_density():
    """∫ z cosθ/π dω = 2/3. The error of the midpoint rule over u = z² is 1/24 n² times the slope."""
    assert unit(cosine_hemisphere(64, 0))[:, 2].mean() == pytest.approx(2 / 3, abs=1e-3)
    many = np.concatenate([unit(cosine_hemisphere(64, seed)) for seed in range(64)])
    assert many[:, 2].mean() == pytest.approx(2 / 3, abs=1e-3)
    np.testing.assert_allclose(many[:, :2].mean(axis=0), 0, atol=5e-3)


@pytest.mark.parametrize("falloff", [0.0, 0.3, 1.0])
def test_the_share_of_directions_that_reach_an_occluder_is_its_influence(falloff):
    kernels = np.concatenate([cosine_hemisphere(64, seed, falloff) for seed in range(64)])
    reach = np.linalg.norm(kernels[:, :3], axis=1)
    assert reach.max() <= 1 + 1e-6
    for distance in (0.1, 0.5, 0.8, 0.9, 0.97):
        share = (reach > distance).mean()
        assert share == pytest.approx(float(influence(np.array(distance**2), falloff)), abs=0.015), distance


def test_influence_has_a_hard_edge_or_a_smoothstep():
    squared = np.array([0.0, 0.5, 0.999, 1.0, 2.0])
    np.testing.assert_array_equal(influence(squared, 0), [1, 1, 1, 0, 0])
    halfway = np.array([0.0, 0.25, 0.5625, 1.0, 2.0])  # distances 0, 1/2, 3/4, 1
    np.testing.assert_allclose(influence(halfway, 1), [1, 0.5, 0.15625, 0, 0], atol=1e-12)  # 1 - t² (3 - 2t)
    np.testing.assert_allclose(influence(halfway, 0.5), [1, 1, 0.5, 0, 0], atol=1e-12)


def test_offsets_are_stratified_over_a_step():
    offsets = cosine_hemisphere(81, 0)[:, 3]
    assert offsets.min() >= 0
    assert offsets.max() < 1
    np.testing.assert_allclose(np.histogram(offsets, 9, (0, 1))[0], 9, atol=1)


def test_a_seed_determines_its_set_and_the_set_is_read_only():
    np.testing.assert_array_equal(cosine_hemisphere(16, 4), cosine_hemisphere(16, 4))
    assert not np.allclose(cosine_hemisphere(16, 4), cosine_hemisphere(16, 5))
    with pytest.raises(ValueError, match="read-only"):
        cosine_hemisphere(16, 4)[0] = 0
