"""The twin of glsl/lib/march.glsl: the directions of a pixel, each tested for blocking at a few points."""

from dataclasses import dataclass

import numpy as np

from .blocking import Found, blocked
from .inputs import F, Inputs
from .receiver import Receiver, Texel, marching_receiver, way_along
from .samples import Samples


@dataclass(frozen=True, eq=False)
class March:
    """N directions of S points each.

    `kernel` (N, 4): the directions around +z, times their reach in radii, and the offsets of their first points;
    `directions` (N, 3): the same, unit, view space. `ways` (N, 3): as they are marched, which differs for directions
    that lead under the triangle. `along` (N, S): the distance of each point, as a share of the reach; `points`
    (N, S, 3). `found`: the blockers.
    """

    receiver: Receiver
    kernel: np.ndarray
    directions: np.ndarray
    ways: np.ndarray
    along: np.ndarray
    points: np.ndarray
    found: Found

    @property
    def open(self) -> np.ndarray:
        """(N,) bool: the directions on which nothing blocks."""
        return np.logical_not(self.found.blocked.any(axis=1))

    @property
    def first(self) -> np.ndarray:
        """(N, 1) int: the index of the first blocked point on each direction; 0 on an open one."""
        return self.found.blocked.argmax(axis=1)[:, None]

    def samples(self, contributions: dict[str, np.ndarray], values: dict[str, np.ndarray] | None = None) -> Samples:
        """The samples of these directions; without `values`, their contributions' sums."""
        receiver = self.receiver
        return Samples(
            "direction", receiver.position, receiver.normal, receiver.position + self.ways, self.points,
            self.found.blocked, self.found.position, contributions,
            {name: parts.sum(axis=0) for name, parts in contributions.items()} if values is None else values,
        )  # fmt: skip


def march(seen: Inputs, texel: Texel, seed: int) -> March:
    """The march of a texel of the estimate."""
    radius, steps = seen.number("radius"), int(seen.uniforms["steps"])
    receiver = marching_receiver(seen, texel, radius)
    kernel = seen.samples("kernel", seed).reshape(-1, 4)
    offset = kernel[:, 3] + F(receiver.number) / F(16)
    offset = offset - np.floor(offset)
    along = ((np.arange(steps, dtype=F)[None] + offset[:, None]) / F(steps)).astype(F)
    ways = (kernel[:, :3] @ receiver.frame.T) * radius
    directions = ways / np.linalg.norm(ways, axis=1, keepdims=True)
    ways = way_along(receiver, ways)
    points = (receiver.position + ways[:, None] * along[..., None]).astype(F)
    found = blocked(seen, receiver, points, seen.number("thickness") * radius)
    return March(receiver, kernel, directions, ways, along, points, found)
