"""A rasteriser of a few lines, in NumPy: the right picture of triangles. It shares no code with aolab."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np


@dataclass
class Triangles:
    """`corners` (T, 3, 3) in world space, and their looks."""

    corners: np.ndarray
    colors: np.ndarray = field(default_factory=lambda: np.full((1, 1, 3), 0.8))  # linear, (T or 1, 3 or 1, 3)
    uv: np.ndarray | None = None  # (T, 3, 2), v downwards as in glTF
    texel: Callable[[float, float], np.ndarray | None] | None = None  # its colour at u, v; None is a hole
    one_sided: bool = False


@dataclass
class Picture:
    """`covered` (H, W) bool; `depth` (H, W): the distance along the view; `color` (H, W, 3); `sure`: not at an edge."""

    covered: np.ndarray
    depth: np.ndarray
    color: np.ndarray
    sure: np.ndarray


def draw(
    triangles: Triangles,
    size: tuple[int, int],
    world_from_camera: np.ndarray,
    fov: float | None = None,
    ortho: float | None = None,
) -> Picture:
    """The picture of a camera that looks down its -z: a ray through each pixel's centre meets every triangle."""
    width, height = size
    half = np.tan(np.radians(fov) / 2) if ortho is None else ortho / 2
    x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2)
    across = np.stack([x * half * width / height, y * half], axis=-1).reshape(-1, 2)
    if ortho is None:
        origin, ray = np.zeros((len(across), 3)), np.column_stack([across, -np.ones(len(across))])
    else:
        origin = np.column_stack([across, np.zeros(len(across))])
        ray = np.tile([0.0, 0.0, -1.0], (len(across), 1))
    camera_from_world = np.linalg.inv(world_from_camera)
    corners = triangles.corners @ camera_from_world[:3, :3].T + camera_from_world[:3, 3]
    depth, color = np.full(len(ray), np.inf), np.zeros((len(ray), 3))
    for number, (a, b, c) in enumerate(corners):
        determinant = np.linalg.det(np.stack(np.broadcast_arrays(a - b, a - c, ray), axis=-1))
        with np.errstate(divide="ignore", invalid="ignore"):
            beta = np.linalg.det(np.stack(np.broadcast_arrays(a - origin, a - c, ray), axis=-1)) / determinant
            gamma = np.linalg.det(np.stack(np.broadcast_arrays(a - b, a - origin, ray), axis=-1)) / determinant
            distance = np.linalg.det(np.stack(np.broadcast_arrays(a - b, a - c, a - origin), axis=-1)) / determinant
        front = (np.cross(b - a, c - a) * ray).sum(axis=1) < 0
        hit = (beta > 0) & (gamma > 0) & (beta + gamma < 1) & (distance > 0) & (distance < depth)
        for pixel in np.flatnonzero(hit & (front | (not triangles.one_sided))):
            weights = np.array([1 - beta[pixel] - gamma[pixel], beta[pixel], gamma[pixel]])
            shade = np.broadcast_to(triangles.colors[number % len(triangles.colors)], (3, 3)).T @ weights
            if triangles.texel is not None and triangles.uv is not None:
                texel = triangles.texel(*(triangles.uv[number].T @ weights))
                if texel is None:
                    continue
                shade = shade * texel
            depth[pixel], color[pixel] = distance[pixel], shade
    covered = np.isfinite(depth).reshape(height, width)
    return Picture(
        covered, depth.reshape(height, width), color.reshape(height, width, 3), _away_from_edges(covered, color)
    )


def _away_from_edges(covered: np.ndarray, color: np.ndarray) -> np.ndarray:
    """Pixels whose neighbours are covered as they are, and nearly of their colour: rasterisers differ at edges."""
    height, width = covered.shape
    values = np.concatenate([covered[..., None].astype(float), color.reshape(height, width, 3)], axis=2)
    around = np.pad(values, ((1, 1), (1, 1), (0, 0)), "edge")
    near = np.stack([around[i : i + height, j : j + width] for i in range(3) for j in range(3)])
    return (np.abs(near - values) < 0.1).all(axis=(0, 3))
