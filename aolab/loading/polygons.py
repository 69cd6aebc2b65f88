"""Polygons of any number of corners as triangles."""

import numpy as np


def triangulate(points: np.ndarray, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The triangles of polygons (F, 3), as numbers of corners, and the polygon that each is of (F,).

    `points` (C, 3) float64: the corners of all polygons, one polygon after the other; `counts` (P,): how many corners
    each has. A polygon of fewer than three has no triangle. The triangles are in the order of their polygons, and run
    round as their polygon does. A polygon that no fan from its first or second corner covers is cut by ear clipping.
    """
    counts = np.asarray(counts, np.int64)
    if (counts == 3).all():
        return np.arange(3 * len(counts)).reshape(-1, 3), np.arange(len(counts))
    starts, sizes = np.cumsum(counts) - counts, np.maximum(counts - 2, 0)
    first = np.cumsum(sizes) - sizes  # of each polygon's triangles
    faces, polygon = np.full((int(sizes.sum()), 3), -1, np.int64), np.repeat(np.arange(len(counts)), sizes)
    for count in np.unique(counts[counts >= 3]):
        chosen = np.flatnonzero(counts == count)
        place = first[chosen, None] + np.arange(count - 2)
        for cut in (_fan(count, 0), _fan(count, 1), None):
            corners = points[starts[chosen, None] + np.arange(count)]
            if cut is None:
                cuts, covers = _ears(corners), np.ones(len(chosen), bool)
            else:
                cuts, covers = np.broadcast_to(cut, (len(chosen), count - 2, 3)), _covers(corners, cut)
            numbers = np.where(cuts < 0, -1, starts[chosen, None, None] + cuts)
            faces[place[covers].reshape(-1)] = numbers[covers].reshape(-1, 3)
            chosen, place = chosen[~covers], place[~covers]
            if not len(chosen):
                break
    made = faces[:, 0] >= 0
    return (faces, polygon) if made.all() else (faces[made], polygon[made])


def _fan(count: int, start: int) -> np.ndarray:
    """(count - 2, 3): the fan from a corner."""
    corner = np.roll(np.arange(count), -start)
    return np.column_stack([np.full(count - 2, corner[0]), corner[1:-1], corner[2:]])


def _areas(polygons: np.ndarray, cuts: np.ndarray) -> np.ndarray:
    """(P, t, 3): the doubled area vectors of triangles; `cuts` (t, 3) or (P, t, 3)."""
    if cuts.ndim == 2:
        a, b, c = (polygons[:, corner] for corner in cuts.T)
    else:
        a, b, c = (np.take_along_axis(polygons, cuts[..., k, None], axis=1) for k in range(3))
    return np.cross(b - a, c - a)


def _covers(polygons: np.ndarray, fan: np.ndarray) -> np.ndarray:
    """(P,) bool: does the fan cover the polygon without an overlap? `polygons` (P, n, 3)."""
    areas = _areas(polygons, fan)
    normal = areas.sum(axis=1, keepdims=True)
    return ((areas * normal).sum(axis=2) >= -1e-9 * (normal * normal).sum(axis=2)).all(axis=1)


def _ears(polygons: np.ndarray) -> np.ndarray:
    """(P, n - 2, 3): the triangles of each polygon (P, n, 3), -1 where they are fewer, for corners on a line."""
    import mapbox_earcut

    count = polygons.shape[1]
    cuts = np.full((len(polygons), count - 2, 3), -1, np.int64)
    normal = _areas(polygons, _fan(count, 0)).sum(axis=1)  # that of Newell
    flat = np.isfinite(polygons).all(axis=(1, 2)) & (np.abs(normal).max(axis=1) > 0)
    cuts[~flat] = _fan(count, 0)  # no plane to cut it in: `Mesh` drops the triangles that have no area
    kept = np.array([(1, 2), (0, 2), (0, 1)])[np.abs(normal).argmax(axis=1)]  # without the axis nearest to the normal
    plane = np.take_along_axis(polygons, kept[:, None, :], axis=2)
    end = np.array([count], np.uint32)
    for number in np.flatnonzero(flat):
        cut = mapbox_earcut.triangulate_float64(plane[number], end).reshape(-1, 3)
        cuts[number, : len(cut)] = cut[: count - 2]
    backwards = (_areas(polygons, cuts) * normal[:, None]).sum(axis=2) < 0  # its triangles run one way round, always
    cuts[backwards] = cuts[backwards][:, ::-1]
    return cuts
