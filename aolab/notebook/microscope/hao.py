"""The twin of glsl/hao.frag and hao.outside.frag: rays through a grid of voxels, in a cone of directions."""

import numpy as np

from ...modules.occluders.region import WHOLE
from .blocking import blocked
from .inputs import F, Inputs
from .receiver import Receiver, Texel, frame_around, lift_off, lifted, moved, receiver_at, turned, way_along
from .samples import Samples

NOISE_CELL, MOST = F(0.05), F(0.02)  # as in glsl/hao.frag
COT_22_5 = F(1 + np.sqrt(2))  # as in glsl/lib/filter.glsl


def hao(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """Direction i contributes (1 - w_i) cosθ_i / Σ cosθ. Outside the voxels' region, the directions do not count."""
    radius, steps = seen.number("radius"), int(seen.uniforms["steps"])
    receiver = receiver_at(seen, texel)
    if seen.uniforms["lifted"] or _is_edge_on(seen, receiver):
        receiver = lifted(receiver, lift_off(seen, F(0), radius, receiver.surface))
    kernel = seen.samples("kernel", seed).reshape(-1, 4)
    noise = _noise(seen, receiver)
    frame = turned(frame_around(receiver.normal), F(2 * np.pi) * noise[0])
    directions = _jittered(seen, kernel[:, :3], noise[2])
    ways = way_along(receiver, (directions @ frame.T * radius).astype(F))
    along = (np.arange(steps, dtype=F) + np.mod(kernel[:, 3:] + noise[1], F(1))) / F(steps)
    points = (receiver.position + ways[:, None] * along[..., None]).astype(F)
    found = blocked(seen, receiver, points, radius)
    rest = 1 - np.where(found.blocked, along, 1).min(axis=1)
    cosine = directions[:, 2].astype(np.float64)
    weight = rest**4 * (4 * (1 - rest) + 1)  # Eq. 3
    visibility = (1 - weight) * cosine / cosine.sum()
    value = visibility.sum()
    if not _in_region(seen, receiver.surface):
        visibility, value = 0 * visibility, _outside(seen, texel)
    return Samples(
        "direction", receiver.position, receiver.normal, receiver.position + ways, points,
        found.blocked, found.position, {"visibility": visibility[:, None]}, {"visibility": np.array([value])},
    )  # fmt: skip


def _is_edge_on(seen: Inputs, receiver: Receiver) -> bool:
    normal, surface, ray = receiver.facet, receiver.surface, seen.vector("ray_from_pixel")
    across = F(0.5) * np.abs(normal[:2]) @ ray[:2]
    if seen.orthographic:
        return bool(across > MOST * COT_22_5 * -ray[3] * abs(normal[2]))
    return bool(across > MOST * abs(normal @ (surface / surface[2])))


def _noise(seen: Inputs, receiver: Receiver) -> np.ndarray:
    """(3,): the noise of the receiver's cell in the world."""
    to_world = seen.matrix("world_from_view")[:3]
    cell = np.floor(moved(to_world, receiver.surface) / (NOISE_CELL * seen.number("radius")))
    normal = np.rint(F(3) * (to_world[:, :3] @ receiver.normal))
    return hashed(cell.astype(np.int64) + 7919 * normal.astype(np.int64))


def hashed(cell: np.ndarray) -> np.ndarray:
    """(3,) float32 in [0, 1): `hashed` of glsl/lib/hash.glsl, for whole numbers (3,)."""
    whole = 1 << 32
    x, y, z = ((int(one) * 1664525 + 1013904223) % whole for one in cell)

    def mixed(x: int, y: int, z: int) -> tuple[int, int, int]:
        x = (x + y * z) % whole
        y = (y + z * x) % whole
        return x, y, (z + x * y) % whole

    numbers = mixed(*(one ^ one >> 16 for one in mixed(x, y, z)))
    return np.array([(one >> 8) / (1 << 24) for one in numbers], F)


def _jittered(seen: Inputs, directions: np.ndarray, share: np.floating) -> np.ndarray:
    depth = F(1) - np.cos(F(0.5) * F(np.pi) * seen.number("spread"))
    before = directions[:, 2]
    z = F(1) - depth * np.mod((F(1) - before) / depth + share / F(len(directions)), F(1))
    across = np.sqrt((F(1) - z * z) / np.maximum(F(1) - before * before, F(1e-6)))
    return np.column_stack([directions[:, :2] * across[:, None], z]).astype(F)


def _in_region(seen: Inputs, surface: np.ndarray) -> bool:
    if seen.kind.name != "voxels" or seen.module.values()["voxel_region"] == WHOLE:
        return True
    return bool(np.abs(moved(seen.matrix("region_from_view")[:3], surface)).max() <= 1)


def _outside(seen: Inputs, texel: Texel) -> float:
    column, row = texel
    return float(seen["baked"][row, column]) if seen.module.values()["outside"] == "baked" else 1.0
