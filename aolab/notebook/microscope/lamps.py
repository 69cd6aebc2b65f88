"""The twins of the passes that test lamps on the screen: glsl/ssdo.lights.frag and glsl/pipeline/fill.frag."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...scene.lights import Light, PointLight
from ...truth.lighting import color, towards_light
from .inputs import F, Inputs
from .receiver import Receiver, Texel, marching_receiver, moved, receiver_at
from .samples import Samples
from .shadows import Length, Tested, filled, lit_place, segment, shadow, together

Test = Callable[[np.ndarray, Length], Tested]  # of the unit way to a lamp, view space, and its distance


def ssdo_lights(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The share of the lamps' light that samples on the segments towards them leave."""
    radius, steps = seen.number("radius"), int(seen.uniforms["light_steps"])
    receiver = marching_receiver(seen, texel, radius)
    length, offset = seen.samples("light_samples", seed).reshape(16, 2)[receiver.number]
    along = (np.arange(steps, dtype=F) + offset) / F(steps)

    def tested(way: np.ndarray, away: Length) -> Tested:
        return segment(seen, receiver, way, min(radius * length, away), along, seen.number("thickness") * radius)

    return _lamps(seen, receiver, lit_place(seen, receiver), tested)


def fill(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The share of the lamps' light that samples in the gaps of the shadow maps leave."""
    receiver = receiver_at(seen, texel)
    receiver = replace(receiver, facet=receiver.normal)  # as the shader has it
    none = np.zeros((0, 3), F)
    place = moved(seen.matrix("world_from_view")[:3], receiver.surface)
    return _lamps(seen, receiver, place, lambda way, away: (none, none[:, 0] > 0, none))


def _lamps(seen: Inputs, receiver: Receiver, place: np.ndarray, test: Test) -> Samples:
    """Lamp i contributes E_i V_i / Σ E, where E is its irradiance past its shadow map, or 1 in all where E is 0."""
    to_world, from_world = seen.matrix("world_from_view")[:3, :3], seen.matrix("view_from_world")[:3, :3]
    normal = to_world @ receiver.normal
    tested, light, ends = [], np.zeros((len(seen.scene.lights), 3)), []
    first = np.frombuffer(seen.uniforms["light_tile"], np.int32)
    for i, lamp in enumerate(seen.scene.lights):
        (towards,), (away,), (share,) = towards_light(lamp, place[None], seen.scene.shader_origin)
        tile = _tile(lamp, int(first[i]), towards)
        arriving = share * max(float(normal @ towards), 0.0)
        light[i] = color(lamp) * arriving * (shadow(seen, tile, place)[0] if tile >= 0 and arriving > 0 else 1)
        way = (from_world @ towards).astype(F)
        pairs = zip(test(way, away), filled(seen, receiver, tile, place, way, away), strict=True)
        tested.append(tuple(np.concatenate(pair) for pair in pairs))
        ends.append(tested[-1][0][-1] if len(tested[-1][0]) else receiver.surface)
    points, hits, occluders = together(tested)
    total = light.sum(axis=0)
    parts = np.where(hits.any(axis=1, keepdims=True), 0, light) / np.maximum(total, 1e-20)
    value = np.where(total > 0, parts.sum(axis=0), 1)
    return Samples(
        "lamp", receiver.position, receiver.normal, np.reshape(ends, (-1, 3)), points, hits, occluders,
        {"light_share": parts}, {"light_share": value},
    )  # fmt: skip


def _tile(lamp: Light, first: int, towards: np.ndarray) -> int:
    """`tileOf`: the shadow tile of a lamp, of the six of a point light the one that sees the receiver; -1 for none."""
    if first < 0 or not isinstance(lamp, PointLight):
        return first
    axis = int(np.abs(towards).argmax())
    return first + 2 * axis + (0 if towards[axis] < 0 else 1)
