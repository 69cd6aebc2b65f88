"""The samples of a pixel, computed again in NumPy: the twin of glsl/lib/march.glsl.

All numbers are float32, as in the shaders: in float64 a sample at the edge of a texel would read its neighbour.
Vectors and positions are in view space, lengths in scene units, unless their names say otherwise.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..errors import ParameterError
from ..gl.texture import read
from ..gl.thread import handed
from ..modules import MODULES
from ..modules.marched import Marched
from ..modules.occluders import Height
from ..pipeline.frame import Frame
from ..pipeline.state import SurfaceState
from ..pipeline.surfaces import facing
from .blocking import TWINS, UNKNOWN, F, Receiver, Surfaces, blocked

SURFACES = ("viewZ", "viewNormal", "facetNormal", "uv", "reliefU", "reliefV")
OF_KINDS = ("layersZ", "viewsZ", "voxelWords", "relief_atlas")  # textures of occluder kinds


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
    kind = state.frame.occluders
    given = state.occluders.bindings
    small = facing(state.small, module.normals)
    wanted = {name: small[name] for name in SURFACES if name in small}
    wanted |= {name: texture for name, texture in given.textures.items() if name in OF_KINDS}
    textures = {name: handed(read)(texture) for name, texture in wanted.items()}
    uniforms = {**state.small_view.uniforms, **state.small_view.constants, **given.uniforms}
    seen = Surfaces(module, kind, state.small_view, textures, uniforms, state.frame.seeds)
    if unknown := [one.name for one in seen.kinds if type(one) not in TWINS]:
        known = ", ".join(one.name for one in TWINS)
        raise ParameterError(
            f"microscope: the occluders '{unknown[0]}' are unknown; known: {known}, and products of two"
        )
    return seen


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
    radius, values = F(module.values()["radius"]), module
    lift = max(F(values.bias) * radius, (F(1) if parallel else radius - surface[2]) * ray[0])
    facet = seen.textures["facetNormal"][row, column, :3].astype(F)
    receiver = Receiver(surface + facet * lift, surface, normal, facet, pixel)
    if any(isinstance(one, Height) for one in seen.kinds) and seen.textures["reliefU"][row, column, 3] > 0:
        receiver = replace(receiver, facet=normal)  # a relief is no solid below its polygon, but below itself

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
    facet = receiver.facet
    ways -= facet * np.minimum(2 * (ways @ facet), 0)[:, None]  # under the triangle: mirrored at its plane
    points = (receiver.position + ways[:, None] * along[..., None]).astype(F)
    hits, occluders = blocked(seen, receiver, points, F(values.thickness) * radius)
    return Samples(receiver.position, surface, normal, directions, kernel, reach, along, points, hits, occluders)


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
