"""The twins of shaders that bounce light from the first occluder of each direction: blocked directions contribute."""

import numpy as np

from ...maths.harmonics import clamped_cosine
from ...scene.environment_lights import LUMINANCE
from .inputs import Inputs
from .march import March, march
from .marched import blocked_share
from .receiver import Texel
from .samples import Samples


def ssdo_bounce(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The twin of glsl/ssdo.bounce.frag."""
    found = march(seen, texel, seed)
    to_sender, normals, light = senders(found)
    return found.samples({"bounce": form_factors(seen, found, to_sender, normals)[:, None] * light})


def near_field(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The twin of glsl/near_field.frag."""
    found = march(seen, texel, seed)
    to_sender, normals, light = senders(found)
    facing, rising = -(normals * to_sender).sum(axis=1), to_sender @ found.receiver.normal
    geometry = np.where((facing > 0) & (rising > 0), facing * rising, 0) / np.maximum(
        (to_sender**2).sum(axis=1) ** 2, 1e-20
    )
    constant, by_light = seen.vector("vpl_bound")
    share = np.maximum(1 - (constant + by_light * (light @ LUMINANCE)) / np.maximum(geometry, 1e-20), 0)
    return found.samples({"bounce": np.pi / len(share) * share[:, None] * light})


def s3ho_senders(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The twin of glsl/s3ho.senders.frag; the texels are packed as by s3ho.packing.glsl."""
    found = march(seen, texel, seed)
    to_sender, normals, albedo = senders(found)
    weights = blocked_share(seen, found) * form_factors(seen, found, to_sender, normals)
    lobes = np.where(normals.any(axis=1, keepdims=True), clamped_cosine(normals), 0)[:, :9]
    parts = (albedo / np.pi * weights[:, None])[:, None] * lobes[..., None]  # (N, 9, 3)
    offsets = to_sender / seen.number("radius")
    alphas = np.column_stack([parts[:, 7], parts[:, 8], weights * (offsets**2).sum(axis=1)])
    texels = {f"bounce{i}": np.column_stack([parts[:, i], alphas[:, i]]) for i in range(7)}
    return found.samples(
        {**texels, "sender_offset": weights[:, None] * np.column_stack([offsets, np.ones(len(offsets))])}
    )


def senders(found: March) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N, 3) each: from the receiver to the first occluder of each direction, its normal, and the light that leaves it.

    On an open direction, all are 0.
    """
    first = found.first[..., None]
    arrays = (found.found.position, *found.found.surface())
    place, normals, light = (np.take_along_axis(one, first, 1)[:, 0] for one in arrays)
    blocked = ~found.open[:, None]
    offset, normals, light = (np.where(blocked, one, 0) for one in (place - found.receiver.position, normals, light))
    return offset, normals, light


def form_factors(seen: Inputs, found: March, to_sender: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(N,): `formFactor` of glsl/lib/senders.glsl."""
    facing = -(normals * to_sender).sum(axis=1)
    rising = np.maximum(to_sender @ found.receiver.normal, 0)
    share = ((facing > 0) & (to_sender @ found.receiver.facet > 0)).astype(float)
    if seen.uniforms["patches"]:
        squared = np.maximum((to_sender**2).sum(axis=1), 1e-20)
        clamped = np.maximum(squared, seen.number("distance_clamp") ** 2)
        cosine = found.kernel[:, 2] / np.linalg.norm(found.kernel[:, :3], axis=1)
        share *= seen.number("radius") ** 2 * rising * facing / (squared * clamped) / (2 * cosine)
    return seen.number("bleeding") * np.pi / len(share) * share
