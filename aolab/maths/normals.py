"""Vertex normals for meshes that have none: smooth, except across creases."""

import numpy as np


def smooth_normals(
    vertices: np.ndarray, faces: np.ndarray, crease: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Vertex normals: face normals weighted by corner angle (Thürmer and Wüthrich 1998).

    `vertices` (V, 3), `faces` (F, 3) vertex indices. Each corner averages the faces at its point whose normals are at
    most `crease` degrees from its own face's normal. Vertices at the same position count as one point, so that UV seams
    stay smooth. A vertex is split if its corners get different normals.

    Returns vertices (V', 3), faces (F, 3), the index of each new vertex's source (V',), and unit normals (V', 3).
    """
    _, point = np.unique(vertices, axis=0, return_inverse=True)
    point = point.reshape(-1)
    corner = vertices.astype(np.float64)[faces]
    to_next = np.roll(corner, -1, axis=1) - corner
    to_next /= np.maximum(np.linalg.norm(to_next, axis=2, keepdims=True), 1e-300)
    angle = np.arccos(np.clip(-(to_next * np.roll(to_next, 1, axis=1)).sum(axis=2), -1, 1))  # (F, 3)
    face_normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    face_normal /= np.maximum(np.linalg.norm(face_normal, axis=1, keepdims=True), 1e-300)

    # pairs of corners at the same point, of faces within the crease angle
    corner_point = point[faces].reshape(-1)
    corner_face = np.repeat(np.arange(len(faces)), 3)
    weighted = face_normal[corner_face] * angle.reshape(-1, 1)
    normals = _sum_over_neighbours(corner_point, face_normal[corner_face], weighted, np.cos(np.radians(crease)))
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)

    key = np.concatenate([faces.reshape(-1, 1).astype(np.float64), np.round(normals, 5) + 0.0], axis=1)
    _, first, inverse = np.unique(key, axis=0, return_index=True, return_inverse=True)
    source = faces.reshape(-1)[first]
    return vertices[source], inverse.reshape(-1, 3).astype(np.uint32), source, normals[first].astype(np.float32)


def _sum_over_neighbours(
    corner_point: np.ndarray, normal: np.ndarray, weighted: np.ndarray, cos_crease: float
) -> np.ndarray:
    """For each corner, the sum of `weighted` (C, 3) over the corners at the same point within the crease angle.

    Corners are sorted by point. Round k pairs each corner with the k-th corner after it, if both are at the same point.
    The rounds end when no such pair is left.
    """
    order = np.argsort(corner_point, kind="stable")
    point, normal, weighted = corner_point[order], normal[order], weighted[order]
    total = weighted.copy()
    index = np.arange(len(order))
    for shift in range(1, len(order)):
        index = index[index + shift < len(order)]
        index = index[point[index] == point[index + shift]]
        if not len(index):
            break
        other = index + shift
        close = (normal[index] * normal[other]).sum(axis=1) >= cos_crease
        total[index] += np.where(close[:, None], weighted[other], 0)
        total[other] += np.where(close[:, None], weighted[index], 0)
    result = np.empty_like(total)
    result[order] = total
    return result
