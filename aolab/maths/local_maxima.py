"""The average distance between a scene's local maxima: a first value for the radius of occlusion.

SSDO (Ritschel, Grosch and Seidel 2009, section 7.2): "an initial value for r_max can be found by computing the average
distance between two local maxima in the geometry". The paper does not define a local maximum. Here it is a point, or a
plateau, that is higher than all its neighbours in the mesh along one of the mesh's six local axis directions. Distances
are measured in world space, to the nearest other maximum of the same axis direction.
"""

import numpy as np

from .connected import connected

AXES = np.concatenate([np.eye(3), -np.eye(3)])
FLAT = 1e-6  # of the mesh's extent: points whose heights differ by less form one plateau
BRUTE_FORCE = 512  # points: fewer points are compared pair by pair, because importing SciPy's trees takes 0.2 s


def local_maxima(points: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centres (n, 3) of the local maxima of a mesh, and the index (n,) of each maximum's direction in `AXES`.

    `points` (P, 3) are the mesh's vertices, `edges` (E, 2) pairs of indices of neighbouring vertices.
    """
    flat = FLAT * float(np.ptp(points, axis=0).max())
    maxima, axes = [], []
    for number, axis in enumerate(AXES):
        height = points @ axis
        highest = height.copy()
        np.maximum.at(highest, edges[:, 0], height[edges[:, 1]])
        np.maximum.at(highest, edges[:, 1], height[edges[:, 0]])
        top = height >= highest - flat
        level = edges[np.abs(height[edges[:, 0]] - height[edges[:, 1]]) <= flat]
        plateau = connected(len(points), level[top[level].any(axis=1)])
        # a plateau with a higher neighbour at any of its points is a terrace, not a maximum
        whole = np.ones(len(points), bool)
        np.logical_and.at(whole, plateau, top)
        member = top & whole[plateau]
        _, index, count = np.unique(plateau[member], return_inverse=True, return_counts=True)
        centres = np.zeros((len(count), 3))
        np.add.at(centres, index, points[member])
        maxima.append(centres / count[:, None])
        axes.append(np.full(len(count), number))
    return np.concatenate(maxima), np.concatenate(axes)


def mean_nearest_distance(points: np.ndarray) -> float | None:
    """The mean distance from each of `points` (n, 3) to its nearest neighbour; None for fewer than two points."""
    if len(points) < 2:
        return None
    if len(points) > BRUTE_FORCE:
        from scipy.spatial import KDTree

        return float(KDTree(points).query(points, k=2)[0][:, 1].mean())
    near_origin = points - points.mean(axis=0)  # smaller numbers: less cancellation in the squares below
    length = (near_origin**2).sum(axis=1)
    squared = length[:, None] + length[None] - 2 * near_origin @ near_origin.T
    np.fill_diagonal(squared, np.inf)
    return float(np.sqrt(np.maximum(squared.min(axis=1), 0)).mean())
