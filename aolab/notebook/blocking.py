"""Is a point blocked, and by what? The twins of glsl/occluders/ in NumPy, for one receiver and many points.

All numbers are float32, as in the shaders. Positions and vectors are in view space, lengths in scene units.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..gl.texture import Size
from ..modules.marched import Marched
from ..modules.occluders import Depth, Height, Layers, Product, Views, Voxels
from ..modules.occluders.base import OccluderKind
from ..scene.view import View

F = np.float32
UNKNOWN = F(3.0e38)  # as in glsl/occluders/views.glsl
VOXELS_ABOVE, VOXELS_AWAY = F(0.65), F(1.5)  # as in glsl/occluders/voxels.glsl
RELIEF_ROUNDING = F(2e-3)  # as in glsl/occluders/height.glsl

Blocked = tuple[np.ndarray, np.ndarray]  # (...) bool, and the occluders (..., 3)


@dataclass(frozen=True, eq=False)
class Receiver:
    """The shaded point: `position`, lifted off its `surface`; unit `normal` and `facet`; its `texel`, from the top."""

    position: np.ndarray
    surface: np.ndarray
    normal: np.ndarray
    facet: np.ndarray
    texel: tuple[int, int]


@dataclass(frozen=True, eq=False)
class Surfaces:
    """The arrays that the shader of a frame sampled, top row first, and the module's parameters."""

    module: Marched
    kind: OccluderKind
    view: View
    textures: Mapping[str, np.ndarray]
    uniforms: Mapping[str, Any]
    seeds: range

    @property
    def size(self) -> Size:
        return self.view.size

    @property
    def kinds(self) -> tuple[OccluderKind, ...]:
        """The occluder kinds, those of a product one by one."""
        return _parts(self.kind)


def _parts(kind: OccluderKind) -> tuple[OccluderKind, ...]:
    return (*_parts(kind.first), *_parts(kind.second)) if isinstance(kind, Product) else (kind,)


def blocked(seen: Surfaces, receiver: Receiver, points: np.ndarray, thickness: np.floating) -> Blocked:
    """For points (..., 3): whether each is blocked, and by which point."""
    with np.errstate(invalid="ignore", over="ignore"):
        return _blocked(seen, seen.kind, receiver, points, thickness)


def _blocked(
    seen: Surfaces, kind: OccluderKind, receiver: Receiver, points: np.ndarray, thickness: np.floating
) -> Blocked:
    if isinstance(kind, Product):
        (first, at_first), (second, at_second) = (
            _blocked(seen, part, receiver, points, thickness) for part in (kind.first, kind.second)
        )
        return first | second, np.where(first[..., None], at_first, at_second)
    return TWINS[type(kind)](seen, kind, receiver, points, thickness)


def _by_depth(seen: Surfaces, _kind: Any, _receiver: Receiver, points: np.ndarray, thickness: np.floating) -> Blocked:
    z = _fetch(seen.textures["viewZ"], _screen_uv(seen, points), -np.inf)
    return _within(z - points[..., 2], thickness), _on_ray(seen, points, z)


def _by_layers(seen: Surfaces, _kind: Any, _receiver: Receiver, points: np.ndarray, thickness: np.floating) -> Blocked:
    layers = _fetch(seen.textures["layersZ"], _screen_uv(seen, points), -np.inf)
    layer = _solid_at(layers, points[..., 2], thickness)
    z = np.take_along_axis(layers, np.maximum(layer, 0)[..., None], -1)[..., 0]
    return layer >= 0, _on_ray(seen, points, z)


def _by_voxels(seen: Surfaces, kind: Voxels, receiver: Receiver, points: np.ndarray, _: np.floating) -> Blocked:
    to, back = (_matrix(seen.uniforms[name]) for name in ("voxel_from_view", "view_from_voxel"))
    voxel = np.floor(_moved(to, points))
    centre = voxel + F(0.5)
    position = _moved(back, centre)
    height = np.abs(np.matmul(receiver.facet, back[:3, :3])).sum()
    above = (position - receiver.position) @ receiver.facet
    away = centre - _moved(to, receiver.position)
    own = np.logical_or(above < VOXELS_ABOVE * height, (away**2).sum(axis=-1) < VOXELS_AWAY**2)
    count = kind.voxels
    inside = np.asarray(np.logical_and(voxel >= 0, voxel < count).all(axis=-1))
    x, y, z = np.moveaxis(np.where(inside[..., None], voxel, 0).astype(int), -1, 0)
    tile = z >> 5
    words = seen.textures["voxelWords"][::-1][(tile >> 3) * count + y, (tile & 7) * count + x]
    is_set = np.bitwise_and(np.right_shift(words, (z & 31).astype(np.uint32)), 1) == 1
    return inside & is_set & ~own, position


def _by_height(seen: Surfaces, kind: Height, receiver: Receiver, points: np.ndarray, thickness: np.floating) -> Blocked:
    column, row = receiver.texel
    by_u, by_v = (seen.textures[name][row, column].astype(F) for name in ("reliefU", "reliefV"))
    number = int(by_u[3]) - 1
    if number < 0:
        if kind.depth_too:
            return _by_depth(seen, kind, receiver, points, thickness)
        return np.zeros(points.shape[:-1], bool), points
    here = seen.textures["uv"][row, column, :2].astype(F)
    off = np.cross(by_u[:3], by_v[:3])
    sight = np.array([0, 0, -1], F) if seen.uniforms["orthographic"] else receiver.surface
    off = (off if sight @ off < 0 else -off) / np.linalg.norm(off)
    offset = points - receiver.position
    there = here + np.stack([offset @ by_u[:3], offset @ by_v[:3]], axis=-1)
    above = offset @ off
    rise = by_v[3] * _height_at(seen, number, here)
    obstacle = by_v[3] * _height_at(seen, number, there) - rise
    in_relief = above + RELIEF_ROUNDING * np.linalg.norm(offset, axis=-1) < obstacle
    position = (receiver.surface + offset + off * (obstacle - above)[..., None]).astype(F)
    if not kind.depth_too:
        return in_relief, position
    raised = (points + off * max(rise, F(0))).astype(F)
    behind, at_depth = _by_depth(seen, kind, receiver, raised, thickness)
    return in_relief | behind, np.where(in_relief[..., None], position, at_depth)


def _height_at(seen: Surfaces, number: int, uv: np.ndarray) -> np.ndarray:
    """(...): the height of a map at uv (..., 2), interpolated; as in glsl/lib/relief.glsl."""
    region = np.frombuffer(seen.uniforms["relief_region"], F).reshape(-1, 4)[number]
    wrap = np.frombuffer(seen.uniforms["relief_wrap"], F).reshape(-1, 2)[number]
    kinds = {0: lambda at: at - np.floor(at), 1: lambda at: np.abs(np.mod(at + 1, 2) - 1), 2: lambda at: at.clip(0, 1)}
    inside = np.stack([kinds[int(wrap[axis])](uv[..., axis]) for axis in (0, 1)], axis=-1)
    at = region[:2] + inside * region[2:] - F(0.5)
    low = np.floor(at)
    u, v = np.moveaxis((at - low).astype(F), -1, 0)
    atlas = seen.textures["relief_atlas"][::-1]
    limit = np.array(atlas.shape[::-1]) - 1
    x0, y0 = np.moveaxis(np.clip(low, 0, limit).astype(int), -1, 0)
    x1, y1 = np.moveaxis(np.clip(low + 1, 0, limit).astype(int), -1, 0)
    bottom = atlas[y0, x0] * (1 - u) + atlas[y0, x1] * u
    return bottom * (1 - v) + (atlas[y1, x0] * (1 - u) + atlas[y1, x1] * u) * v


def _matrix(values: bytes) -> np.ndarray:
    return np.frombuffer(values, F).reshape(4, 4).T


def _moved(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The points (..., 3) under a matrix, added in the order of the shaders."""
    x, y, z = (points[..., axis, None] for axis in range(3))
    return (matrix[:3, 0] * x + matrix[:3, 1] * y + matrix[:3, 2] * z + matrix[:3, 3]).astype(F)


def _screen_uv(seen: Surfaces, points: np.ndarray) -> np.ndarray:
    pixel_from_ray, texel_size = (np.asarray(seen.uniforms[name], F) for name in ("pixel_from_ray", "texel_size"))
    return _uv(seen, points, pixel_from_ray, texel_size)


def _uv(seen: Surfaces, points: np.ndarray, pixel_from_ray: np.ndarray, texel_size: np.ndarray) -> np.ndarray:
    """(..., 2): where points (..., 3) lie in a picture, in [0, 1], v up."""
    distance = F(1) if seen.uniforms["orthographic"] else np.maximum(-points[..., 2:], F(1e-20))
    pixel = points[..., :2] / distance * pixel_from_ray[:2] + pixel_from_ray[2:]
    return (pixel * texel_size).astype(F)


def _fetch(texture: np.ndarray, uv: np.ndarray, outside: float) -> np.ndarray:
    """The nearest texels of `texture` (h, w) or (h, w, 4) at uv (..., 2); `outside` off the picture."""
    height, width = texture.shape[:2]
    u, v = np.floor(uv[..., 0] * F(width)), np.floor(uv[..., 1] * F(height))
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    column, row = np.where(inside, u, 0).astype(int), np.where(inside, height - 1 - v, 0).astype(int)
    found = texture[row, column]
    return np.where(inside if found.ndim == inside.ndim else inside[..., None], found, outside).astype(F)


def _within(behind: np.ndarray, thickness: np.floating) -> np.ndarray:
    return np.abs(behind - F(0.5) * thickness) < F(0.5) * thickness


def _on_ray(seen: Surfaces, points: np.ndarray, z: np.ndarray) -> np.ndarray:
    if seen.uniforms["orthographic"]:
        return np.concatenate([points[..., :2], z[..., None]], axis=-1).astype(F)
    return (points * (z / points[..., 2])[..., None]).astype(F)


def _solid_at(layers: np.ndarray, z: np.ndarray, thickness: np.floating) -> np.ndarray:
    """(...) int: the layer of the nearer side of the solid around `z`; -1 outside every solid. `layers` (..., 4)."""
    second = layers[..., 2] > z
    front = np.where(second, layers[..., 2], layers[..., 0])
    stored = np.where(second, layers[..., 3], layers[..., 1])
    open_ = stored < -UNKNOWN
    back = np.where(open_, front - thickness, stored)
    inside = (front > z) & (z > back)
    nearer = np.where(open_ | (front - z < z - stored), 0, 1)
    return np.where(inside, np.where(second, 2, 0) + nearer, -1)


def _by_views(seen: Surfaces, kind: Views, _receiver: Receiver, points: np.ndarray, thickness: np.floating) -> Blocked:
    uniforms, uv = seen.uniforms, _screen_uv(seen, points)
    ways = [np.frombuffer(uniforms[name], F).reshape(-1, 4, 4) for name in ("view_from_camera", "camera_from_view")]
    there_from_here, here_from_there = (matrices.transpose(0, 2, 1) for matrices in ways)
    tile_from_ray, tile_half = (np.asarray(uniforms[name], F) for name in ("tile_from_ray", "tile_half"))
    z = _fetch(seen.textures["viewZ"], uv, -np.inf)
    on_screen = (np.abs(uv - F(0.5)) < F(0.5)).all(axis=-1)
    behind = np.where(on_screen, z - points[..., 2], UNKNOWN).astype(F)
    margin = np.where(on_screen, F(0), F(2) * F(uniforms["view_pixel_width"])).astype(F)
    inside_solid = np.zeros(behind.shape, bool)
    nearest = _on_ray(seen, points, z)
    for k, (there_matrix, here_matrix) in enumerate(zip(there_from_here, here_from_there, strict=True)):
        there = (points @ there_matrix[:3, :3].T + there_matrix[:3, 3]).astype(F)
        in_tile = _uv(seen, there, tile_from_ray, np.ones(2, F))
        in_picture = np.abs(in_tile).max(axis=-1) < 1
        tile = np.array((2 * (k & 1) + 1, 2 * (k >> 1) + 1), F)
        depths = _fetch(seen.textures["viewsZ"], ((in_tile + tile) * tile_half).astype(F), -np.inf)
        if kind.view_layers > 1:
            inside_solid |= in_picture & (_solid_at(depths, there[..., 2], thickness) >= 0)
            depths = depths[..., 0]
        distance = F(1) if uniforms["orthographic"] else -there[..., 2]
        here = np.where(in_picture, depths - there[..., 2] - margin * distance, UNKNOWN).astype(F)
        closer = here < behind
        behind = np.where(closer, here, behind)
        back = _on_ray(seen, there, depths) @ here_matrix[:3, :3].T + here_matrix[:3, 3]
        nearest = np.where(closer[..., None], back, nearest).astype(F)
    return (inside_solid & (behind > 0) if kind.view_layers > 1 else _within(behind, thickness)), nearest


TWINS: dict[type[OccluderKind], Callable[..., Blocked]] = {
    Depth: _by_depth,
    Layers: _by_layers,
    Views: _by_views,
    Voxels: _by_voxels,
    Height: _by_height,
}
