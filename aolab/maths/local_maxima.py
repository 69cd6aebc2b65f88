"""The size of a scene's features: how far its local maxima are apart, a first value for the radius of occlusion.

SSDO (Ritschel, Grosch and Seidel 2009, section 7.2): "an initial value for r_max can be found by computing the average
distance between two local maxima in the geometry". Here a local maximum is a point, or a plateau, that is higher than
all its neighbours in the mesh along one of the mesh's own six axis directions; its distance is the one to the nearest
other maximum of the same direction, in the world.
"""

import numpy as np

AXES = np.concatenate([np.eye(3), -np.eye(3)])
FLAT = 1e-6  # of the mesh's extent: what differs by less is one plateau
BRUTE_FORCE = 512  # points: fewer are compared each with each, for SciPy's trees take 0.2 s to import


def local_maxima(points: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centres (n, 3) of the local maxima of a mesh, `points` (P, 3) joined by `edges` (E, 2), and their axis (n,)."""
    flat = FLAT * float(np.ptp(points, axis=0).max())
    maxima, axes = [], []
    for number, axis in enumerate(AXES):
        height = points @ axis
        highest = height.copy()
        np.maximum.at(highest, edges[:, 0], height[edges[:, 1]])
        np.maximum.at(highest, edges[:, 1], height[edges[:, 0]])
        top = height >= highest - flat
        level = edges[np.abs(height[edges[:, 0]] - height[edges[:, 1]]) <= flat]
        plateau = _connected(len(points), level[top[level].any(axis=1)])
        # one member that has a higher neighbour, and the plateau is a terrace on the way up
        whole = np.ones(len(points), bool)
        np.logical_and.at(whole, plateau, top)
        member = top & whole[plateau]
        _, index, count = np.unique(plateau[member], return_inverse=True, return_counts=True)
        centres = np.zeros((len(count), 3))
        np.add.at(centres, index, points[member])
        maxima.append(centres / count[:, None])
        axes.append(np.full(len(count), number))
    return np.concatenate(maxima), np.concatenate(axes)


def _connected(count: int, edges: np.ndarray) -> np.ndarray:
    """(count,): the least index that each point is joined to; labels spread along the edges until none changes."""
    label = np.arange(count)
    while True:
        before = label.copy()
        np.minimum.at(label, edges[:, 0], before[edges[:, 1]])
        np.minimum.at(label, edges[:, 1], before[edges[:, 0]])
        label = label[label]  # and along the way that is known already
        if (label == before).all():
            return label


def mean_nearest_distance(points: np.ndarray) -> float | None:
    """The mean distance of `points` (n, 3) to their nearest neighbours; None for fewer than two."""
    if len(points) < 2:
        return None
    if len(points) > BRUTE_FORCE:
        from scipy.spatial import KDTree

        return float(KDTree(points).query(points, k=2)[0][:, 1].mean())
    near_origin = points - points.mean(axis=0)  # the differences of squares below keep their digits there
    length = (near_origin**2).sum(axis=1)
    squared = length[:, None] + length[None] - 2 * near_origin @ near_origin.T
    np.fill_diagonal(squared, np.inf)
    return float(np.sqrt(np.maximum(squared.min(axis=1), 0)).mean())
