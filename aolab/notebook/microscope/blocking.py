"""Is a point blocked, and by what? The twins of glsl/occluders/ in NumPy, for one receiver and many points.

All numbers are float32, as in the shaders. Positions and vectors are in view space, lengths in scene units.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import ParameterError
from ...modules.occluders import Depth, Height, Layers, Product, Views, Voxels
from ...modules.occluders.base import OccluderKind
from .inputs import F, Inputs
from .receiver import Receiver, moved

UNKNOWN = F(3.0e38)  # as in glsl/occluders/views.glsl
VOXELS_ABOVE, VOXELS_AWAY = F(0.65), F(1.5)  # as in glsl/occluders/voxels.glsl
RELIEF_ROUNDING = F(2e-3)  # as in glsl/occluders/height.glsl

Surface = tuple[np.ndarray, np.ndarray]  # unit normals (..., 3), and the radiance (..., 3) that leaves it
Thickness = np.floating | np.ndarray  # of all points, or of each


@dataclass(frozen=True, eq=False)
class Found:
    """The answer for points (...): `blocked` (...) bool, and the `position` (..., 3) of each point's occluder.

    `surface()` looks up the occluders' normals and light, `occluderNormal` and `occluderRadiance` in GLSL: only modules
    with a bounce have these textures.
    """

    blocked: np.ndarray
    position: np.ndarray
    surface: Callable[[], Surface]


def blocked(seen: Inputs, receiver: Receiver, points: np.ndarray, thickness: Thickness) -> Found:
    """For points (..., 3): whether each is blocked, and by which point.

    Raises `ParameterError` for a kind of occluders without a twin.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        return _blocked(seen, seen.kind, receiver, points, thickness)


def _blocked(seen: Inputs, kind: OccluderKind, receiver: Receiver, points: np.ndarray, thickness: Thickness) -> Found:
    if isinstance(kind, Product):
        first, second = (_blocked(seen, part, receiver, points, thickness) for part in (kind.first, kind.second))
        return _either(first.blocked, first, second, first.blocked | second.blocked)
    if type(kind) not in OCCLUDER_TWINS:
        known = ", ".join(one.name for one in OCCLUDER_TWINS)
        raise ParameterError(
            f"microscope: the occluders '{kind.name}' are unknown; known: {known}, and products of two"
        )
    return OCCLUDER_TWINS[type(kind)](seen, kind, receiver, points, thickness)


def _either(choice: np.ndarray, first: Found, second: Found, blocked: np.ndarray) -> Found:
    """The first occluder where `choice` is true, else the second."""
    where = choice[..., None]

    def surface() -> Surface:
        (normal, light), (other, others) = first.surface(), second.surface()
        return np.where(where, normal, other), np.where(where, light, others)

    return Found(blocked, np.where(where, first.position, second.position), surface)


def _by_depth(seen: Inputs, _kind: Any, _receiver: Receiver, points: np.ndarray, thickness: Thickness) -> Found:
    uv = screen_uv(seen, points)
    z = fetch(seen["viewZ"], uv, -np.inf)
    return Found(_within(z - points[..., 2], thickness), _on_ray(seen, points, z), lambda: _seen_at(seen, uv))


def _seen_at(seen: Inputs, uv: np.ndarray) -> Surface:
    """The camera's surfaces at uv (..., 2)."""
    return _colors(seen["viewNormal"], uv), _colors(seen["sender"], uv)


def _by_layers(seen: Inputs, _kind: Any, _receiver: Receiver, points: np.ndarray, thickness: Thickness) -> Found:
    uv = screen_uv(seen, points)
    layers = fetch(seen["layersZ"], uv, -np.inf)
    layer = _solid_at(layers, points[..., 2], thickness)
    z = np.take_along_axis(layers, np.maximum(layer, 0)[..., None], -1)[..., 0]

    def surface() -> Surface:
        normal, light = _seen_at(seen, uv)
        for number in (1, 2, 3):
            of_layer = (layer == number)[..., None]
            normal = np.where(of_layer, _colors(seen[f"viewNormal{number}"], uv), normal)
            light = np.where(of_layer, _colors(seen[f"sender{number}"], uv), light)
        return normal, light

    return Found(layer >= 0, _on_ray(seen, points, z), surface)


def _by_voxels(seen: Inputs, kind: Voxels, receiver: Receiver, points: np.ndarray, _: Thickness) -> Found:
    to, back = (seen.matrix(name)[:3] for name in ("voxel_from_view", "view_from_voxel"))
    voxel = np.floor(moved(to, points))
    centre = voxel + F(0.5)
    position = moved(back, centre)
    height = np.abs(np.matmul(receiver.facet, back[:, :3])).sum()
    above = (position - receiver.position) @ receiver.facet
    away = centre - moved(to, receiver.position)
    own = np.logical_or(above < VOXELS_ABOVE * height, (away**2).sum(axis=-1) < VOXELS_AWAY**2)
    count = kind.voxels
    inside = np.asarray(np.logical_and(voxel >= 0, voxel < count).all(axis=-1))
    x, y, z = np.moveaxis(np.where(inside[..., None], voxel, 0).astype(int), -1, 0)
    tile = z >> 5
    words = seen["voxelWords"][::-1][(tile >> 3) * count + y, (tile & 7) * count + x]
    is_set = np.bitwise_and(np.right_shift(words, (z & 31).astype(np.uint32)), 1) == 1

    def surface() -> Surface:
        uv = screen_uv(seen, position)
        size = np.linalg.norm(back[:, :3], axis=0).sum()
        is_seen = np.abs(fetch(seen["viewZ"], uv, -np.inf) - position[..., 2]) < size
        normal, light = _seen_at(seen, uv)
        return np.where(is_seen[..., None], normal, 0), np.where(is_seen[..., None], light, 0)

    return Found(inside & is_set & ~own, position, surface)


def _by_height(seen: Inputs, kind: Height, receiver: Receiver, points: np.ndarray, thickness: Thickness) -> Found:
    column, row = receiver.texel
    by_u, by_v = (seen[name][row, column].astype(F) for name in ("reliefU", "reliefV"))
    number = int(by_u[3]) - 1
    if number < 0:
        if kind.depth_too:
            return _by_depth(seen, kind, receiver, points, thickness)
        return Found(np.zeros(points.shape[:-1], bool), points, lambda: (points, points))  # which nobody reads
    here = seen["uv"][row, column, :2].astype(F)
    off = np.cross(by_u[:3], by_v[:3])
    sight = np.array([0, 0, -1], F) if seen.orthographic else receiver.surface
    off = (off if sight @ off < 0 else -off) / np.linalg.norm(off)
    offset = points - receiver.position
    there = here + np.stack([offset @ by_u[:3], offset @ by_v[:3]], axis=-1)
    above = offset @ off
    rise = by_v[3] * _height_at(seen, number, here)
    obstacle = by_v[3] * _height_at(seen, number, there) - rise
    in_relief = above + RELIEF_ROUNDING * np.linalg.norm(offset, axis=-1) < obstacle
    position = (receiver.surface + offset + off * (obstacle - above)[..., None]).astype(F)

    def surface() -> Surface:
        slope = _slope_at(seen, number, there)
        normal = off - by_v[3] * (slope[..., :1] * by_u[:3] + slope[..., 1:] * by_v[:3])
        uv = screen_uv(seen, points - off * above[..., None])
        return normal / np.linalg.norm(normal, axis=-1, keepdims=True), _colors(seen["sender"], uv)

    relief = Found(in_relief, position, surface)
    if not kind.depth_too:
        return relief
    raised = (points + off * max(rise, F(0))).astype(F)
    behind = _by_depth(seen, kind, receiver, raised, thickness)
    return _either(in_relief, relief, behind, in_relief | behind.blocked)


def _height_at(seen: Inputs, number: int, uv: np.ndarray) -> np.ndarray:
    """(...): the height of a map at uv (..., 2), interpolated; as in glsl/lib/relief.glsl."""
    region = np.frombuffer(seen.uniforms["relief_region"], F).reshape(-1, 4)[number]
    wrap = np.frombuffer(seen.uniforms["relief_wrap"], F).reshape(-1, 2)[number]
    kinds = {0: lambda at: at - np.floor(at), 1: lambda at: np.abs(np.mod(at + 1, 2) - 1), 2: lambda at: at.clip(0, 1)}
    inside = np.stack([kinds[int(wrap[axis])](uv[..., axis]) for axis in (0, 1)], axis=-1)
    at = region[:2] + inside * region[2:] - F(0.5)
    low = np.floor(at)
    u, v = np.moveaxis((at - low).astype(F), -1, 0)
    atlas = seen["relief_atlas"][::-1]
    limit = np.array(atlas.shape[::-1]) - 1
    x0, y0 = np.moveaxis(np.clip(low, 0, limit).astype(int), -1, 0)
    x1, y1 = np.moveaxis(np.clip(low + 1, 0, limit).astype(int), -1, 0)
    bottom = atlas[y0, x0] * (1 - u) + atlas[y0, x1] * u
    return bottom * (1 - v) + (atlas[y1, x0] * (1 - u) + atlas[y1, x1] * u) * v


def _slope_at(seen: Inputs, number: int, uv: np.ndarray) -> np.ndarray:
    """(..., 2): the derivatives of a map's height by u and by v."""
    texel = F(1) / np.frombuffer(seen.uniforms["relief_region"], F).reshape(-1, 4)[number, 2:]
    steps = np.diag(F(0.5) * texel)
    rises = [_height_at(seen, number, uv + step) - _height_at(seen, number, uv - step) for step in steps]
    return np.stack(rises, axis=-1) / texel


def screen_uv(seen: Inputs, points: np.ndarray) -> np.ndarray:
    """(..., 2): where points (..., 3) lie on the screen, in [0, 1], v up."""
    return _uv(seen, points, seen.vector("pixel_from_ray"), seen.vector("texel_size"))


def _uv(seen: Inputs, points: np.ndarray, pixel_from_ray: np.ndarray, texel_size: np.ndarray) -> np.ndarray:
    distance = F(1) if seen.orthographic else np.maximum(-points[..., 2:], F(1e-20))
    pixel = points[..., :2] / distance * pixel_from_ray[:2] + pixel_from_ray[2:]
    return (pixel * texel_size).astype(F)


def fetch(texture: np.ndarray, uv: np.ndarray, outside: float) -> np.ndarray:
    """The nearest texels of `texture` (h, w) or (h, w, channels) at uv (..., 2); `outside` off the picture."""
    height, width = texture.shape[:2]
    u, v = np.floor(uv[..., 0] * F(width)), np.floor(uv[..., 1] * F(height))
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    column, row = np.where(inside, u, 0).astype(int), np.where(inside, height - 1 - v, 0).astype(int)
    found = texture[row, column]
    return np.where(inside if found.ndim == inside.ndim else inside[..., None], found, outside).astype(F)


def _colors(texture: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """(..., 3): the nearest texels' first three channels; off the picture, the nearest texel's."""
    edge = F(0.5) / np.array(texture.shape[1::-1], F)
    return fetch(texture, np.clip(np.nan_to_num(uv), edge, 1 - edge), 0.0)[..., :3]


def _within(behind: np.ndarray, thickness: Thickness) -> np.ndarray:
    return np.abs(behind - F(0.5) * thickness) < F(0.5) * thickness


def _on_ray(seen: Inputs, points: np.ndarray, z: np.ndarray) -> np.ndarray:
    if seen.orthographic:
        return np.concatenate([points[..., :2], z[..., None]], axis=-1).astype(F)
    return (points * (z / points[..., 2])[..., None]).astype(F)


def _solid_at(layers: np.ndarray, z: np.ndarray, thickness: Thickness) -> np.ndarray:
    """(...) int: the layer of the nearer side of the solid around `z`; -1 outside every solid. `layers` (..., 4)."""
    second = layers[..., 2] > z
    front = np.where(second, layers[..., 2], layers[..., 0])
    stored = np.where(second, layers[..., 3], layers[..., 1])
    open_ = stored < -UNKNOWN
    back = np.where(open_, front - thickness, stored)
    inside = (front > z) & (z > back)
    nearer = np.where(open_ | (front - z < z - stored), 0, 1)
    return np.where(inside, np.where(second, 2, 0) + nearer, -1)


def _by_views(seen: Inputs, kind: Views, _receiver: Receiver, points: np.ndarray, thickness: Thickness) -> Found:
    uniforms, uv = seen.uniforms, screen_uv(seen, points)
    ways = [np.frombuffer(uniforms[name], F).reshape(-1, 4, 4) for name in ("view_from_camera", "camera_from_view")]
    there_from_here, here_from_there = (matrices.transpose(0, 2, 1) for matrices in ways)
    tile_from_ray, tile_half = seen.vector("tile_from_ray"), seen.vector("tile_half")
    z = fetch(seen["viewZ"], uv, -np.inf)
    on_screen = (np.abs(uv - F(0.5)) < F(0.5)).all(axis=-1)
    behind = np.where(on_screen, z - points[..., 2], UNKNOWN).astype(F)
    margin = np.where(on_screen, F(0), F(2) * F(uniforms["view_pixel_width"])).astype(F)
    inside_solid = np.zeros(behind.shape, bool)
    nearest, view, place = _on_ray(seen, points, z), np.zeros(behind.shape, int), uv
    for k, (there_matrix, here_matrix) in enumerate(zip(there_from_here, here_from_there, strict=True)):
        there = (points @ there_matrix[:3, :3].T + there_matrix[:3, 3]).astype(F)
        in_tile = _uv(seen, there, tile_from_ray, np.ones(2, F))
        in_picture = np.abs(in_tile).max(axis=-1) < 1
        tile = np.array((2 * (k & 1) + 1, 2 * (k >> 1) + 1), F)
        in_atlas = ((in_tile + tile) * tile_half).astype(F)
        depths = fetch(seen["viewsZ"], in_atlas, -np.inf)
        if kind.view_layers > 1:
            inside_solid |= in_picture & (_solid_at(depths, there[..., 2], thickness) >= 0)
            depths = depths[..., 0]
        distance = F(1) if seen.orthographic else -there[..., 2]
        here = np.where(in_picture, depths - there[..., 2] - margin * distance, UNKNOWN).astype(F)
        closer = here < behind
        behind = np.where(closer, here, behind)
        back = _on_ray(seen, there, depths) @ here_matrix[:3, :3].T + here_matrix[:3, 3]
        nearest = np.where(closer[..., None], back, nearest).astype(F)
        view, place = np.where(closer, k + 1, view), np.where(closer[..., None], in_atlas, place)

    def surface() -> Surface:
        normal, light = _seen_at(seen, place)
        normals = _colors(seen["viewsNormal"], place)
        turned = np.stack([normals @ matrix[:3, :3].T for matrix in here_from_there])
        turned = np.take_along_axis(turned, np.maximum(view - 1, 0)[None, ..., None], 0)[0]
        further = (view > 0)[..., None]
        return np.where(further, turned, normal), np.where(further, _colors(seen["viewsSender"], place), light)

    hits = inside_solid & (behind > 0) if kind.view_layers > 1 else _within(behind, thickness)
    return Found(hits, nearest, surface)


OCCLUDER_TWINS: dict[type[OccluderKind], Callable[..., Found]] = {
    Depth: _by_depth,
    Layers: _by_layers,
    Views: _by_views,
    Voxels: _by_voxels,
    Height: _by_height,
}
