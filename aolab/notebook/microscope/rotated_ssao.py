"""The twin of glsl/rotated_ssao.frag, and of the line of lib/line.glsl that its samples lie on."""

from dataclasses import dataclass

import numpy as np

from .blocking import blocked
from .inputs import F, Inputs
from .receiver import Receiver, Texel, lift_off, lifted, position_at, receiver_at
from .samples import Samples


@dataclass(frozen=True, eq=False)
class Line:
    """`direction` (2,), unit, and the `shift` of the samples, in steps."""

    direction: np.ndarray
    shift: np.floating

    def points(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """(count, 2): the places of the samples in the unit disc; (count,): the shares of the disc."""
        x = (np.arange(count, dtype=F) + self.shift) / F(count)
        return (x * x)[:, None] * self.direction, F(4) * x * x * x / F(count)


def line_of(number: int, start: np.ndarray) -> Line:
    """`lineOf`: the line of a set; `start` (3,) is the uniform `line_start`."""
    angle = F(2 * np.pi) * F(number) / F(16)
    c, s = np.cos(angle), np.sin(angle)
    reverse = int(f"{number:04b}"[::-1], 2)
    direction = np.array([c * start[0] - s * start[1], s * start[0] + c * start[1]], F)
    return Line(direction, np.mod(start[2] + (F(reverse) + F(0.5)) / F(16), F(1)))


def rotated_ssao(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """Sample i of n contributes (1 - strength × occlusion) / n. Their sum is clamped."""
    radius, count = seen.number("radius"), int(seen.uniforms["line_samples"])
    receiver = receiver_at(seen, texel)
    height = seen.number("bias") * radius
    if seen.number("scale") < 1:
        height = lift_off(seen, height, radius, receiver.surface)
    receiver = lifted(receiver, height)
    z = receiver.surface[2]
    reach = radius * seen.vector("pixel_from_ray")[0] / (F(1) if seen.orthographic else -z)
    line = line_of(receiver.number, seen.samples("line_start", seed))
    pixels = np.floor(receiver.pixel + reach * line.points(count)[0]) + F(0.5)
    points = _on_plane(seen, receiver, pixels, z - radius)
    found = blocked(seen, receiver, points, seen.number("thickness") * radius)
    ways = found.position - receiver.position
    with np.errstate(invalid="ignore"):  # an occluder that does not block may be the background
        squared = np.maximum((ways**2).sum(axis=1), F(1e-20))
        cosine = np.maximum(ways @ receiver.normal, 0) / np.sqrt(squared)
        occlusion = np.where(found.blocked, cosine * np.maximum(1 - squared / radius**2, 0), 0)
    parts = {"visibility": ((1 - seen.number("strength") * occlusion) / count)[:, None]}
    return Samples(
        "sample", receiver.position, receiver.normal, points, points[:, None], found.blocked[:, None],
        found.position[:, None], parts, {"visibility": np.clip(parts["visibility"].sum(axis=0), 0, 1)},
    )  # fmt: skip


def _on_plane(seen: Inputs, receiver: Receiver, pixels: np.ndarray, far: np.floating) -> np.ndarray:
    """(n, 3): `onPlane`, the points of the triangle's plane that are seen at `pixels` (n, 2)."""
    ends = position_at(seen, pixels, far)
    eyes = ends * np.array([1, 1, 0], F) if seen.orthographic else np.zeros_like(ends)
    ways = ends - eyes
    facing = ways @ receiver.facet
    share = ((receiver.position - eyes) @ receiver.facet) / np.minimum(facing, F(-1e-20))
    on = (facing < 0) & (share > 0)
    return np.where(on[:, None], eyes + ways * np.minimum(share, 1)[:, None], ends).astype(F)
