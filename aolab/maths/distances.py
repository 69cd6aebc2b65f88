"""Distances from a point to boxes and triangles."""

import numpy as np


def to_boxes(point: np.ndarray, centre: np.ndarray, half: np.ndarray) -> np.ndarray:
    """(n,): to axis-aligned boxes, 0 inside; `centre` and `half` of their size (n, 3)."""
    return np.linalg.norm(np.maximum(np.abs(point - centre) - half, 0), axis=1)


def to_triangles(point: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(n,): to triangles (n, 3, 3): to their plane where the foot is inside, else to the nearest edge."""
    a, edges = corners, np.roll(corners, -1, axis=1) - corners  # (n, 3, 3)
    from_corner = point - a
    length = np.maximum((edges * edges).sum(axis=2), 1e-300)
    along = ((from_corner * edges).sum(axis=2) / length).clip(0, 1)
    to_edges = np.linalg.norm(from_corner - along[..., None] * edges, axis=2).min(axis=1)
    normal = np.cross(edges[:, 0], edges[:, 1])
    # the foot is inside if it lies on the inner side of each edge
    inside = ((np.cross(edges, from_corner) * normal[:, None]).sum(axis=2) >= 0).all(axis=1)
    to_plane = np.abs((from_corner[:, 0] * normal).sum(axis=1)) / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    return np.where(inside, to_plane, to_edges)
