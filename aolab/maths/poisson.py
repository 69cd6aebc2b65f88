"""Poisson-disc samples of the unit cube, by Lloyd's relaxation (Lloyd 1982) on the torus."""

from functools import lru_cache

import numpy as np

# Of 0 to 30 steps, 5 had the least wrap-around discrepancy at 8 points, and nearly the least at 16 and 32. With more
# steps, few points approach a lattice, and their coordinates coincide.
RELAXATIONS = 5
PROBES = 4096  # at least; and 64 a point. They measure the cells


@lru_cache(maxsize=256)
def poisson_cube(count: int, seed: int) -> np.ndarray:
    """(count, 3) float64 in [0, 1): samples that keep their distance from each other, also across the cube's faces.

    Each seed shifts the same relaxed set by a random vector, modulo 1 (Cranley and Patterson 1976): the distances stay.
    """
    samples = (_relaxed(count) + np.random.default_rng(seed).random(3)) % 1
    samples.flags.writeable = False
    return samples


@lru_cache(maxsize=64)
def _relaxed(count: int) -> np.ndarray:
    """White noise, of which each point moved to the centroid of its Voronoi cell, `RELAXATIONS` times."""
    random = np.random.default_rng(count)
    points = random.random((count, 3))
    for _ in range(RELAXATIONS):
        points = relax(points, random)
    return points


def relax(points: np.ndarray, random: "np.random.Generator") -> np.ndarray:
    """One step of Lloyd's relaxation on the torus: each of `points` (n, 3) moves to the mean of the nearest probes."""
    side = int(np.ceil(max(PROBES, 64 * len(points)) ** (1 / 3)))
    cells = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)
    probes = (cells + random.random(cells.shape)) / side
    offset = probes[:, None] - points  # (probes, n, 3)
    offset -= np.round(offset)
    nearest = (offset**2).sum(axis=2).argmin(axis=1)
    ways = offset[np.arange(len(probes)), nearest]
    counts = np.maximum(np.bincount(nearest, minlength=len(points)), 1)
    sums = [np.bincount(nearest, ways[:, axis], len(points)) for axis in range(3)]
    return (points + np.stack(sums, axis=1) / counts[:, None]) % 1


def least_distance(points: np.ndarray) -> float:
    """The least distance of two of `points` (n, 3) on the torus."""
    offset = points[:, None] - points
    offset -= np.round(offset)
    squared = (offset**2).sum(axis=2)
    return float(np.sqrt(squared[~np.eye(len(points), dtype=bool)].min()))
