"""Vertex normals for meshes that have none: smooth, except across creases."""

import numpy as np

from .rows import distinct_rows

MANY = 32  # corners at a point; a vertex of a regular mesh has 6
CELL = 1 / 16  # side of the cells into which normals are sorted where many corners meet: at most 6 degrees across
NO_LENGTH = 1e-30  # a shorter normal is none; float32's own least normal number is 1.2e-38
IN_PLANE = 1e-3  # cosine to the face's normal, 0.06 degrees: between rounding (1e-7) and any shading that is meant


def smooth_normals(
    vertices: np.ndarray, faces: np.ndarray, crease: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Vertex normals: face normals weighted by corner angle (Thürmer and Wüthrich 1998).

    `vertices` (V, 3), `faces` (F, 3) vertex indices. Each corner averages the faces at its point whose normals are at
    most `crease` degrees from its own face's normal. Vertices at the same position count as one point, so that UV seams
    stay smooth. A vertex is split if its corners get different normals.

    Returns vertices (V', 3), faces (F, 3), the index of each new vertex's source (V',), and unit normals (V', 3).
    """
    _, point = distinct_rows(vertices)
    corner = vertices.astype(np.float64)[faces]
    to_next = np.roll(corner, -1, axis=1) - corner
    to_next /= np.maximum(np.linalg.norm(to_next, axis=2, keepdims=True), 1e-300)
    angle = np.arccos(np.clip(-(to_next * np.roll(to_next, 1, axis=1)).sum(axis=2), -1, 1))  # (F, 3)
    face_normal = _unit(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]))

    corner_normal = np.repeat(face_normal, 3, axis=0)
    weighted = corner_normal * angle.reshape(-1, 1)
    normals, hard = _sum_over_neighbours(point[faces].reshape(-1), corner_normal, weighted, crease)
    normals = _unit(normals)

    # a corner's vertex: its own, or, where the corners of a point differ, a new one for each vertex and normal
    vertex = faces.reshape(-1).astype(np.int64)
    rounded = np.round(normals[hard], 5).astype(np.float32) + np.float32(0)
    first, number = distinct_rows(np.column_stack([vertex[hard].astype(np.uint32), rounded.view(np.uint32)]))
    source = np.concatenate([np.arange(len(vertices)), vertex[hard[first]]])
    vertex[hard] = len(vertices) + number
    normal = np.zeros((len(source), 3))
    normal[vertex] = normals
    used = np.zeros(len(source), bool)
    used[vertex] = True
    order = np.flatnonzero(used)
    order = order[np.argsort(source[order], kind="stable")]
    rank = np.empty(len(source), np.uint32)
    rank[order] = np.arange(len(order))
    source = source[order]
    return vertices[source], rank[vertex].reshape(-1, 3), source, normal[order].astype(np.float32)


def usable_normals(
    vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, int, int]:
    """Given normals at unit length, with those replaced that cannot shade.

    A normal without length becomes the mean of its vertex's faces, by area. A triangle all of whose normals lie in its
    own plane (to `IN_PLANE`) gets vertices of its own with its own normal: the side that such normals are on would be
    decided by rounding, pixel by pixel. Returns vertices (V', 3), faces (F, 3), the source vertex of each (V',),
    normals (V', 3) float32, and the counts of vertices and triangles that were mended.
    """
    length = np.linalg.norm(normals.astype(np.float64), axis=1)
    corner = vertices.astype(np.float64)[faces]
    area = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    source, used = np.arange(len(vertices)), np.zeros(len(vertices), bool)
    used[faces] = True
    missing = used & ~(length > NO_LENGTH)
    unit = normals.astype(np.float32)
    changed = (np.abs(length - 1) > 1e-6) & (length > NO_LENGTH)
    unit[changed] = normals[changed].astype(np.float64) / length[changed, None]
    if missing.any():
        sums = _unit(_sums(faces.reshape(-1).astype(np.int64), np.repeat(area, 3, axis=0)))
        unit[: len(sums)][missing[: len(sums)]] = sums[missing[: len(sums)]]

    across = np.abs(np.einsum("fci,fi->fc", unit[faces], _unit(area))).max(axis=1)
    flat = np.flatnonzero(across < IN_PLANE)
    if len(flat):
        faces = faces.copy()
        source = np.concatenate([source, faces[flat].reshape(-1)])
        unit = np.concatenate([unit, np.repeat(_unit(area[flat]), 3, axis=0).astype(np.float32)])
        faces[flat] = len(vertices) + np.arange(3 * len(flat)).reshape(-1, 3)
        vertices = vertices[source]
    return vertices, faces, source, unit, int(missing.sum()), len(flat)


def _sum_over_neighbours(
    corner_point: np.ndarray, normal: np.ndarray, weighted: np.ndarray, crease: float
) -> tuple[np.ndarray, np.ndarray]:
    """For each corner, the sum of `weighted` (C, 3) over the corners at the same point within `crease` degrees; and the
    numbers of the corners whose sum is not that of their whole point.

    If all normals of a point lie within half the crease of their mean, each is within the crease of each: one sum
    serves them all. At the other points each corner is paired with each other. If more than `MANY` corners meet there,
    corners of nearly the same normal count as one, so that the time does not grow with the square of their number.
    """
    half, whole = np.cos(np.radians((min(crease, 360) / 2, crease)))
    mean = _unit(_sums(corner_point, normal))
    apart = np.bincount(corner_point, (normal * mean[corner_point]).sum(axis=1) < half) > 0
    total = _sums(corner_point, weighted)[corner_point]
    hard = np.flatnonzero(apart[corner_point])
    if len(hard):
        entry = _entries(corner_point[hard], normal[hard])
        point = np.empty(int(entry.max()) + 1, corner_point.dtype)
        point[entry] = corner_point[hard]
        sums, direction = _sums(entry, weighted[hard]), _unit(_sums(entry, normal[hard]))
        total[hard] = _sum_over_pairs(point, direction, sums, whole)[entry]
    return total, hard


def _sums(group: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """(groups, 3): the sum of the `vectors` (n, 3) in each group; `group` (n,) holds their numbers."""
    return np.stack([np.bincount(group, column) for column in vectors.T], axis=1)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)


def _entries(corner_point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """(corners,): the number of the group that each corner is in; a group of its own where few corners meet."""
    entry = np.arange(len(corner_point))
    crowded = np.flatnonzero(np.bincount(corner_point)[corner_point] > MANY)
    if len(crowded):
        cell = np.round(normal[crowded] / CELL).astype(np.int32)
        first, number = distinct_rows(np.column_stack([corner_point[crowded].astype(np.int32), cell]))
        entry[crowded] = crowded[first][number]
        _, entry = np.unique(entry, return_inverse=True)
    return entry


def _sum_over_pairs(point: np.ndarray, normal: np.ndarray, weighted: np.ndarray, cos_crease: float) -> np.ndarray:
    """For each entry, the sum of `weighted` over the entries at the same point within the crease angle.

    Entries are sorted by point; the k-th round pairs each entry with the k-th after it, while points have that many. A
    point with more than `MANY` entries is a product of matrices: a quarter of the time for fans of 1000 triangles.
    """
    order = np.argsort(point, kind="stable")
    point, normal, weighted = point[order], normal[order], weighted[order]
    total = weighted.copy()
    start = np.flatnonzero(np.diff(point, prepend=-1))
    count = np.diff(start, append=len(point))
    for first, size in zip(start[count > MANY].tolist(), count[count > MANY].tolist(), strict=True):
        here = slice(first, first + size)
        close = normal[here] @ normal[here].T >= cos_crease
        np.fill_diagonal(close, True)
        total[here] = close.astype(np.float64) @ weighted[here]
    index = np.flatnonzero(np.repeat(count <= MANY, count))
    for shift in range(1, MANY):
        index = index[index + shift < len(order)]
        index = index[point[index] == point[index + shift]]
        if not len(index):
            break
        other = index + shift
        close = (normal[index] * normal[other]).sum(axis=1) >= cos_crease
        # within a round no entry occurs twice in `index`, nor in `other`
        total[index] += np.where(close[:, None], weighted[other], 0)
        total[other] += np.where(close[:, None], weighted[index], 0)
    result = np.empty_like(total)
    result[order] = total
    return result
