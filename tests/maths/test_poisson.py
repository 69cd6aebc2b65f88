"""The Poisson-disc samples: their distance and discrepancy beside stratified samples and white noise."""

import numpy as np
import pytest
from scipy.stats import qmc

from aolab.maths.poisson import least_distance, poisson_cube, relax

SEEDS = range(24)


def white(count: int, seed: int) -> np.ndarray:
    return np.random.default_rng([seed, count]).random((count, 3))


def stratified(count: int, seed: int) -> np.ndarray:
    """One random point in each of `count` cubes."""
    side = round(count ** (1 / 3))
    cells = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)
    return (cells + white(count, seed)) / side


@pytest.mark.parametrize("count", [8, 27, 64])
def test_poisson_samples_are_farther_apart_and_more_even_than_others(count):
    """The wrap-around discrepancy does not depend on shifts of the torus (Hickernell 1998)."""
    sets = {kind.__name__: [kind(count, seed) for seed in SEEDS] for kind in (poisson_cube, stratified, white)}
    distance = {name: np.mean([least_distance(points) for points in some]) for name, some in sets.items()}
    uneven = {name: np.mean([qmc.discrepancy(p, method="WD") for p in some]) for name, some in sets.items()}
    assert distance["poisson_cube"] > 1.4 * distance["stratified"] > 1.4 * distance["white"]
    assert uneven["poisson_cube"] < 0.9 * uneven["stratified"]
    assert uneven["poisson_cube"] < 0.5 * uneven["white"]


def test_a_step_of_relaxation_moves_points_apart():
    points, random = white(32, 0), np.random.default_rng(1)
    distances = [least_distance(points)]
    for _ in range(4):
        points = relax(points, random)
        distances.append(least_distance(points))
    assert distances[1] > 1.3 * distances[0]
    assert distances[4] > distances[1]


def test_seeds_shift_one_set_on_the_torus():
    one, other = poisson_cube(16, 0), poisson_cube(16, 1)
    shift = (other - one) % 1
    np.testing.assert_allclose(shift, np.broadcast_to(shift[0], shift.shape), atol=1e-12)
    assert np.abs(shift[0]).min() > 1e-3
    assert least_distance(one) == pytest.approx(least_distance(other))


@pytest.mark.parametrize("count", [1, 2, 256])
def test_any_number_of_samples_lies_in_the_cube(count):
    points = poisson_cube(count, 3)
    assert points.shape == (count, 3)
    assert points.min() >= 0
    assert points.max() < 1
    assert poisson_cube(count, 3) is points, "kept"
    assert not points.flags.writeable
