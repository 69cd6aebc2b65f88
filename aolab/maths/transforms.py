"""Matrices between spaces, (4, 4) float64; view space looks down -z, clip space is OpenGL's."""

import numpy as np


def look_along(position: np.ndarray, direction: np.ndarray, up: np.ndarray | None = None) -> np.ndarray:
    """view_from_world, a rigid transform, of an eye at `position` that looks along `direction`.

    Without `up`, the world axis that is farthest from the direction is up.
    """
    backward = -np.asarray(direction, float) / np.linalg.norm(direction)
    right = np.cross(np.eye(3)[np.argmin(np.abs(backward))] if up is None else up, backward)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, :3] = right, np.cross(backward, right), backward
    matrix[:3, 3] = -matrix[:3, :3] @ np.asarray(position, float)
    return matrix


def perspective(tan_x: float, tan_y: float, near: float, far: float) -> np.ndarray:
    """clip_from_view of a pyramid, by the tangents of half its horizontal and vertical angle."""
    depth = -(far + near) / (far - near), -2 * far * near / (far - near)
    return np.array([[1 / tan_x, 0, 0, 0], [0, 1 / tan_y, 0, 0], [0, 0, *depth], [0, 0, -1, 0]], float)


def orthographic(half_x: float, half_y: float, near: float, far: float) -> np.ndarray:
    """clip_from_view of a box of half the width and height, from `near` to `far` along -z."""
    depth = -2 / (far - near), -(far + near) / (far - near)
    return np.array([[1 / half_x, 0, 0, 0], [0, 1 / half_y, 0, 0], [0, 0, *depth], [0, 0, 0, 1]], float)
