"""The receiver and its place: the twins of glsl/lib/space.glsl, receiver.glsl and sampling.glsl.

All numbers are float32, as in the shaders: in float64 a sample at the edge of a texel would read its neighbour.
Vectors and positions are in view space, lengths in scene units, unless their names say otherwise.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...gl.texture import Size
from ...modules.occluders import Height
from .inputs import F, Inputs

Texel = tuple[int, int]  # column and row of a texel, from the top left


@dataclass(frozen=True, eq=False)
class Receiver:
    """The shaded point: `position`, lifted off its `surface`; unit `normal` and `facet`, the triangle's normal.

    `number` is that of the pixel's sample set, 0 to 15, and the columns of `frame` (3, 3) turn a kernel around +z to
    the normal, by the angle of the set. `pixel` (2,) is the pixel's centre in window coordinates.
    """

    texel: Texel
    pixel: np.ndarray
    position: np.ndarray
    surface: np.ndarray
    normal: np.ndarray
    facet: np.ndarray
    number: int
    frame: np.ndarray


def receiver_at(seen: Inputs, texel: Texel) -> Receiver:
    """The receiver on its surface, not lifted."""
    column, row = texel
    x, y = column, seen.size[1] - 1 - row  # window coordinates
    pixel = np.array([F(x) + F(0.5), F(y) + F(0.5)], F)
    surface = position_at(seen, pixel, F(seen["viewZ"][row, column]))
    normal = seen["viewNormal"][row, column, :3].astype(F)
    facet = _facet(seen["facets"][row, column]) if "facets" in seen.textures else normal
    number = _interleaved_set(x, y)
    return Receiver(texel, pixel, surface, surface, normal, facet, number, _interleaved_frame(normal, number))


def _facet(stored: np.ndarray) -> np.ndarray:
    """`azimuthalDirection` of glsl/lib/azimuthal.glsl, from the whole numbers of the texture."""
    across = F(2) * (stored.astype(F) / F(65535)) - F(1)
    depth = min(across @ across, F(1))
    return np.array([*across * (F(2) * np.sqrt(F(1) - depth)), F(1) - F(2) * depth], F)


def lifted(receiver: Receiver, height: np.floating) -> Receiver:
    """The receiver, lifted off its triangle."""
    return replace(receiver, position=(receiver.surface + receiver.facet * height).astype(F))


def marching_receiver(seen: Inputs, texel: Texel, reach: np.floating) -> Receiver:
    """`receiverHere` of glsl/lib/march.glsl: lifted for points within `reach`."""
    receiver = receiver_at(seen, texel)
    receiver = lifted(receiver, lift_off(seen, seen.number("bias") * seen.number("radius"), reach, receiver.surface))
    column, row = texel
    if any(isinstance(one, Height) for one in seen.kinds) and seen["reliefU"][row, column, 3] > 0:
        return replace(receiver, facet=receiver.normal)  # a relief is no solid below its polygon, but below itself
    return receiver


def position_at(seen: Inputs, pixel: np.ndarray, z: np.ndarray | np.floating) -> np.ndarray:
    """(..., 3): `viewPosAt`, the point at depth z (...) that is seen at `pixel` (..., 2), window coordinates."""
    ray = seen.vector("ray_from_pixel")
    z = np.broadcast_to(np.asarray(z, F), pixel.shape[:-1])[..., None]
    return np.concatenate([(pixel * ray[:2] + ray[2:]) * (F(1) if seen.orthographic else -z), z], axis=-1).astype(F)


def lift_off(seen: Inputs, bias: np.floating, reach: np.floating, surface: np.ndarray) -> np.floating:
    """`liftOff`: the height above its triangle from which a receiver tests points within `reach`."""
    return max(bias, (F(1) if seen.orthographic else reach - surface[2]) * seen.vector("ray_from_pixel")[0])


def way_along(receiver: Receiver, ways: np.ndarray) -> np.ndarray:
    """(..., 3): `wayAlong`; ways (..., 3) under the triangle are mirrored at its plane."""
    return ways - receiver.facet * np.minimum(2 * (ways @ receiver.facet), 0)[..., None]


def moved(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The points (..., 3) under a matrix (3 or 4, 4), added in the order of the shaders."""
    x, y, z = (points[..., axis, None] for axis in range(3))
    return (matrix[:, 0] * x + matrix[:, 1] * y + matrix[:, 2] * z + matrix[:, 3]).astype(F)


def texel_of(pixel: tuple[int, int], size: Size, small: Size) -> Texel:
    """The texel of a picture of the size `small` that covers the centre of `pixel` in a picture of `size`."""
    column, row = (int((place + 0.5) * few / many) for place, few, many in zip(pixel, small, size, strict=True))
    return column, row


def _interleaved_set(x: int, y: int) -> int:
    low, high = (x & 1, y & 1), (x >> 1 & 1, y >> 1 & 1)
    return 4 * (2 * (low[0] ^ low[1]) + low[1]) + 2 * (high[0] ^ high[1]) + high[1]


def frame_around(n: np.ndarray) -> np.ndarray:
    """(3, 3): `frameAround`, columns tangent, bitangent, normal."""
    s = F(1) if n[2] >= 0 else F(-1)
    a = F(-1) / (s + n[2])
    b = n[0] * n[1] * a
    tangent = [1 + s * n[0] * n[0] * a, s * b, -s * n[0]]
    return np.array([tangent, [b, s + n[1] * n[1] * a, -n[1]], n], F).T


def turned(frame: np.ndarray, angle: np.floating) -> np.ndarray:
    """(3, 3): the frame, turned around its third column."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * frame[:, 0] + s * frame[:, 1], c * frame[:, 1] - s * frame[:, 0], frame[:, 2]], axis=1).astype(
        F
    )


def _interleaved_frame(n: np.ndarray, number: int) -> np.ndarray:
    return turned(frame_around(n), F(2 * np.pi) * F(number) / F(16))


def world(seen: Inputs, directions: np.ndarray) -> np.ndarray:
    """Directions (..., 3) of view space in world space."""
    return directions.astype(np.float64) @ seen.matrix("world_from_view")[:3, :3].T.astype(np.float64)
