"""Tangents for normal maps, by the MikkTSpace convention.

Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited".
"""

import numpy as np

from .rows import distinct_rows


def mikktspace(
    vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray, uv: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Vertices, faces, the source of each vertex (V',), and tangents (V', 4) float32.

    A tangent's xyz is a unit vector, its w the sign of the bitangent w · normal × tangent.
    The tangent of a corner is the derivative of the position by u on its triangle, projected onto the plane of the
    corner's normal. Corners of equal position, normal and uv share the sum of their tangents, weighted by their
    angles, if their triangles show the texture from the same side. Vertices are split where the side changes. A
    triangle whose uv have no area takes the tangents of its neighbours, or else any.
    """
    p, t = vertices.astype(np.float64)[faces], uv.astype(np.float64)[faces]  # (F, 3, ...)
    edges, steps = p[:, 1:] - p[:, :1], t[:, 1:] - t[:, :1]
    area = steps[:, 0, 0] * steps[:, 1, 1] - steps[:, 1, 0] * steps[:, 0, 1]
    by_u = edges[:, 0] * steps[:, 1, 1:] - edges[:, 1] * steps[:, 0, 1:]
    side = np.where(area < 0, -1.0, 1.0)
    by_u = _unit(by_u * side[:, None])
    degenerate = (area == 0) | ~by_u.any(axis=1)
    corner_normals = _unit(normals.astype(np.float64))[faces]
    projected = _unit(by_u[:, None] - corner_normals * (corner_normals * by_u[:, None]).sum(axis=2, keepdims=True))
    towards, back = (np.roll(p, -1, axis=1) - p, np.roll(p, 1, axis=1) - p)
    # angles between the edges as they appear in the plane of the normal
    a, b = (_unit(e - corner_normals * (corner_normals * e).sum(axis=2, keepdims=True)) for e in (towards, back))
    angle = np.arccos((a * b).sum(axis=2).clip(-1, 1)) * ~degenerate[:, None]

    keys = np.concatenate([vertices, normals, uv], axis=1, dtype=np.float32)
    _, alike = distinct_rows(keys)
    group = 2 * alike[faces] + (side < 0)[:, None]  # (F, 3): the corners that share a tangent
    # degenerate triangles join the group of the other side where only that one has a tangent
    count = 2 * (int(alike.max()) + 1)
    known = np.bincount(group.ravel(), angle.ravel(), count) > 0
    group = np.where(degenerate[:, None] & ~known[group] & known[group ^ 1], group ^ 1, group)
    weighted = (projected * angle[..., None]).reshape(-1, 3)
    sums = np.stack([np.bincount(group.ravel(), weighted[:, axis], count) for axis in range(3)], axis=1)

    corners = np.stack([faces.ravel().astype(np.int64), group.ravel()], axis=1)
    _, first, number = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    source, of_group = corners[first].T
    normal = _unit(normals.astype(np.float64))[source]
    tangent = _unit(sums[of_group])
    tangent = np.where(tangent.any(axis=1, keepdims=True), tangent, _any_tangent(normal))
    sign = np.where(of_group % 2, -1.0, 1.0)
    split = np.concatenate([tangent, sign[:, None]], axis=1).astype(np.float32)
    return vertices[source], number.reshape(-1, 3).astype(faces.dtype), source, split


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def _any_tangent(normal: np.ndarray) -> np.ndarray:
    """(n, 3): some unit vectors perpendicular to `normal`."""
    axis = np.eye(3)[np.abs(normal).argmin(axis=1)]
    return _unit(np.cross(axis, normal))
