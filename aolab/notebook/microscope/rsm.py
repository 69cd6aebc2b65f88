"""The twin of glsl/rsm.gather.frag: pixel lights of reflective shadow maps, drawn around the pixel's projection."""

import numpy as np

from .inputs import F, Inputs
from .receiver import Texel, moved, receiver_at
from .rotated_ssao import line_of
from .samples import Samples


def rsm(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """Each sample of each map contributes the irradiance of its pixel light. Nothing is tested for blocking."""
    receiver = receiver_at(seen, texel)
    to_world = seen.matrix("world_from_view")[:3]
    place, normal = moved(to_world, receiver.surface), (to_world[:, :3] @ receiver.normal).astype(F)
    on_disc, shares = _kernel(seen, receiver.number, seed)
    stretch = np.linalg.norm(on_disc, axis=1) / np.abs(on_disc).max(axis=1)
    half, rows = seen.number("rsm_radius"), seen["rsm_table"][::-1]
    side = F(2) * half
    positions, parts = [np.zeros((0, 3), F)], [np.zeros((0, 3))]
    for tile in range(int(seen.uniforms["rsm_tiles"])):
        size = int(rows[tile, 4, 2])
        centre = _centre_in_map(moved(rows[tile, :4].T, place))
        corner = np.clip(centre - half, F(0), F(1) - side)
        at = corner + side * np.mod((centre - corner) / side + F(0.5) * stretch[:, None] * on_disc, F(1))
        column, row = np.minimum((at * F(size)).astype(int), size - 1).T
        count = F(np.pi / 4) * stretch**2 * shares * side * side * F(size) ** 2
        position, area, normals, flux = _pixel_lights(seen, seen["rsm_packed"][::-1][row, column + tile * size])
        there = place - position
        squared = (there**2).sum(axis=1)
        cosines = np.maximum((normals * there).sum(axis=1), 0) * np.maximum(-(there @ normal), 0)
        area = count * area / (16 if seen.uniforms["rotated"] else 1)
        factor = count / np.pi * cosines / np.maximum(squared * (squared + area / np.pi), 1e-20)
        positions.append(position)
        parts.append(flux * factor[:, None])
    lights, light = np.concatenate(positions), np.concatenate(parts)
    from_world = seen.matrix("view_from_world")[:3]
    none = np.zeros((len(lights), 0, 3), F)
    buffer = next(iter(seen.step.outputs))
    return Samples(
        "pixel light", receiver.position, receiver.normal, moved(from_world, lights), none, none[..., 0] > 0, none,
        {buffer: light}, {buffer: light.sum(axis=0)}, until="light",
    )  # fmt: skip


def rsm_complete(seen: Inputs, texel: Texel, seed: int) -> Samples | None:
    """The twin of glsl/rsm.complete.frag: the same, where the low resolution could not be interpolated."""
    column, row = texel
    return None if seen["rsm_interpolated"][row, column, 3] > 0.5 else rsm(seen, texel, seed)


def _kernel(seen: Inputs, number: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """(n, 2): the samples' places in the unit disc; (n,): the shares of the disc that they stand for."""
    if seen.uniforms["rotated"]:
        return line_of(number, seen.samples("line_start", seed)).points(int(seen.uniforms["rsm_samples"]))
    kernel = seen.samples("rsm_kernel", seed).reshape(-1, 4)
    return kernel[:, :2], kernel[:, 2]


def _centre_in_map(clip: np.ndarray) -> np.ndarray:
    """(2,): `centreInMap`, of a place in clip space (4,)."""
    from_middle = clip[:2] / clip[3] if clip[3] > 0 else np.zeros(2, F)
    sides = max(float(np.abs(from_middle).max()), 1.0)
    return (F(0.5) + F(0.5) * from_middle / F(sides * sides)).astype(F)


def _pixel_lights(seen: Inputs, words: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Positions (n, 3), areas (n,), normals (n, 3) and fluxes (n, 3), world space, of their `words` (n, 4)."""
    box = seen.vector("rsm_box")
    low, high = (words & 0xFFFF).astype(F), (words >> 16).astype(F)
    in_box = np.stack([low[:, 0], high[:, 0], low[:, 1]], axis=1) * F(2 / 65535) - F(1)
    width = high[:, 1] * (box[3] / F(65535))
    normal = (words[:, 2:3] >> np.array([0, 10, 20], np.uint32) & 1023).astype(F) * F(2 / 1023) - F(1)
    scale = np.exp2((words[:, 3:] >> 24).astype(float) - 127)
    flux = (words[:, 3:] >> np.array([0, 8, 16], np.uint32) & 255) * scale
    return (in_box * box[3] + box[:3]).astype(F), width * width, normal, flux
