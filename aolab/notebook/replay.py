"""The samples of a pixel, computed again in NumPy: the twin of glsl/lib/march.glsl and of glsl/occluders/.

All numbers are float32, as in the shaders: in float64 a sample at the edge of a texel would read its neighbour.
Vectors and positions are in view space, lengths in scene units, unless their names say otherwise.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..gl.texture import Size, read
from ..gl.thread import handed
from ..modules import MODULES
from ..modules.marched import Marched
from ..modules.occluders import Depth, Layers, Views
from ..modules.parameters import Choice
from ..pipeline.frame import Frame
from ..pipeline.state import SurfaceState
from ..scene.view import View

F = np.float32
UNKNOWN = F(3.0e38)  # as in glsl/occluders/views.glsl


@dataclass(frozen=True, eq=False)
class Samples:
    """The points that one pixel tested, for one sample set: N directions of S points each.

    `receiver` (3,): the shaded point, lifted off its surface; `surface` (3,): the point on it; `normal` (3,), unit.
    `directions` (N, 3): unit vectors; `reach` (N,): the length of each march. A direction that leads under the triangle
    is marched on its mirror image at the triangle's plane: see `points`.
    `along` (N, S): the distance of each point, as a share of the reach; `points` (N, S, 3): the points.
    `blocked` (N, S) bool; `occluders` (N, S, 3): the surface point that each point was tested against.
    """

    receiver: np.ndarray
    surface: np.ndarray
    normal: np.ndarray
    directions: np.ndarray
    kernel: np.ndarray
    reach: np.ndarray
    along: np.ndarray
    points: np.ndarray
    blocked: np.ndarray
    occluders: np.ndarray

    @property
    def open(self) -> np.ndarray:
        """(N,) bool: the directions on which nothing blocks."""
        return np.logical_not(self.blocked.any(axis=1))

    @property
    def first(self) -> np.ndarray:
        """(N,) int: the index of the first blocked point on each direction; 0 on an open one."""
        return self.blocked.argmax(axis=1)


@dataclass(frozen=True, eq=False)
class Surfaces:
    """The arrays that the shader of a frame sampled, top row first, and the module's parameters."""

    module: Marched
    kind: Choice
    view: View
    textures: Mapping[str, np.ndarray]
    uniforms: Mapping[str, Any]
    seeds: range

    @property
    def size(self) -> Size:
        return self.view.size


def surfaces(frame: Frame) -> Surfaces:
    """The inputs of a frame's estimate. Raises `ParameterError` if no marched module of a lab rendered the frame."""
    state = frame.kept
    if not isinstance(state, SurfaceState):
        raise ParameterError(
            f"microscope: this frame, of {frame.info.get('module')}, was not rendered by a lab; there are no samples"
        )
    module = state.frame.module
    if not isinstance(module, Marched):
        marched = ", ".join(name for name, known in MODULES.items() if issubclass(known, Marched))
        raise ParameterError(
            f"microscope: the module {frame.info.get('module')} marches no directions; modules that do: {marched}, and "
            "your own that derive from aolab.modules.marched.Marched"
        )
    kind = module.chosen("occluders")
    if type(kind) not in (Depth, Layers, Views):
        raise ParameterError(f"microscope: the occluders '{kind.name}' are unknown; known: depth, layers, views")
    given = state.occluders.bindings
    wanted = {name: state.small[name] for name in ("viewZ", "viewNormal", "facetNormal")}
    wanted |= {name: texture for name, texture in given.textures.items() if name in ("layersZ", "viewsZ")}
    textures = {name: handed(read)(texture) for name, texture in wanted.items()}
    uniforms = {**state.small_view.uniforms, **state.small_view.constants, **given.uniforms}
    return Surfaces(module, kind, state.small_view, textures, uniforms, state.frame.seeds)


def replay(seen: Surfaces, pixel: tuple[int, int], seed: int) -> Samples | None:
    """The samples of `pixel` (column, row) of the estimate, from the top left; None in the background."""
    column, row = pixel
    height = seen.size[1]
    module = seen.module
    x, y = column, height - 1 - row  # window coordinates
    z = F(seen.textures["viewZ"][row, column])
    if z < -UNKNOWN:
        return None
    ray = np.asarray(seen.uniforms["ray_from_pixel"], F)
    normal = seen.textures["viewNormal"][row, column, :3].astype(F)
    centre = np.array([F(x) + F(0.5), F(y) + F(0.5)], F)
    parallel = bool(seen.uniforms["orthographic"])
    surface = np.append((centre * ray[:2] + ray[2:]) * (F(1) if parallel else -z), z).astype(F)
    radius, values = F(module.model_dump()["radius"]), module
    lift = max(F(values.bias) * radius, (F(1) if parallel else radius - surface[2]) * ray[0])
    facet = seen.textures["facetNormal"][row, column, :3].astype(F)
    receiver = surface + facet * lift

    sample_set = _interleaved_set(x, y)
    frame = _interleaved_frame(normal, sample_set)
    kernel = np.frombuffer(module.samples(seed)["kernel"], F).reshape(-1, 4)
    ways = (kernel[:, :3] @ frame.T) * radius
    offset = kernel[:, 3] + F(sample_set) / F(16)
    offset = offset - np.floor(offset)
    steps = F(values.steps)
    along = ((np.arange(values.steps, dtype=F)[None] + offset[:, None]) / steps).astype(F)
    reach = np.linalg.norm(ways, axis=1)
    directions = ways / reach[:, None]
    ways -= facet * np.minimum(2 * (ways @ facet), 0)[:, None]  # under the triangle: mirrored at its plane
    points = (receiver + ways[:, None] * along[..., None]).astype(F)
    blocked, occluders = _blocked(seen, points, F(values.thickness) * radius)
    return Samples(receiver, surface, normal, directions, kernel, reach, along, points, blocked, occluders)


def _interleaved_set(x: int, y: int) -> int:
    low, high = (x & 1, y & 1), (x >> 1 & 1, y >> 1 & 1)
    return 4 * (2 * (low[0] ^ low[1]) + low[1]) + 2 * (high[0] ^ high[1]) + high[1]


def _interleaved_frame(n: np.ndarray, sample_set: int) -> np.ndarray:
    """(3, 3): columns tangent, bitangent, normal, turned by the angle of the set."""
    s = F(1) if n[2] >= 0 else F(-1)
    a = F(-1) / (s + n[2])
    b = n[0] * n[1] * a
    tangent = np.array([1 + s * n[0] * n[0] * a, s * b, -s * n[0]], F)
    bitangent = np.array([b, s + n[1] * n[1] * a, -n[1]], F)
    angle = F(2 * np.pi) * F(sample_set) / F(16)
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * tangent + s * bitangent, c * bitangent - s * tangent, n], axis=1).astype(F)


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


def _blocked(seen: Surfaces, points: np.ndarray, thickness: np.floating) -> tuple[np.ndarray, np.ndarray]:
    """For points (..., 3): whether each is blocked, (...) bool, and the occluders (..., 3)."""
    uv = _uv(seen, points, np.asarray(seen.uniforms["pixel_from_ray"], F), np.asarray(seen.uniforms["texel_size"], F))
    with np.errstate(invalid="ignore", over="ignore"):
        if isinstance(seen.kind, Depth):
            z = _fetch(seen.textures["viewZ"], uv, -np.inf)
            return _within(z - points[..., 2], thickness), _on_ray(seen, points, z)
        if isinstance(seen.kind, Layers):
            layers = _fetch(seen.textures["layersZ"], uv, -np.inf)
            layer = _solid_at(layers, points[..., 2], thickness)
            z = np.take_along_axis(layers, np.maximum(layer, 0)[..., None], -1)[..., 0]
            return layer >= 0, _on_ray(seen, points, z)
        return _blocked_in_views(seen, points, uv, thickness)


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


def _blocked_in_views(
    seen: Surfaces, points: np.ndarray, uv: np.ndarray, thickness: np.floating
) -> tuple[np.ndarray, np.ndarray]:
    kind, uniforms = seen.kind, seen.uniforms
    assert isinstance(kind, Views)
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
