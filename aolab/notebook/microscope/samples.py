"""The samples of one pixel: the interface between the twins of shaders, and a microscope's text and picture."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np


@dataclass(frozen=True, eq=False)
class Samples:
    """The samples that one pixel took, for one sample set: N ways, each tested for blocking at S points.

    A way is a direction, the way to a point on the screen, or the way to a light; `noun` is its word. View space, scene
    units.

    `receiver` (3,): the shaded point, lifted off its surface; `normal` (3,), unit.
    `ends` (N, 3): the end of each way, by `until`: the `reach` within which occluders count, a `light`, or, for lights
    at `infinity`, a point on the way.
    `points` (N, S, 3): the tested points; `blocked` (N, S) bool; `occluders` (N, S, 3): the surface point that each
    point was tested against. S is 0 if the shader tests nothing.
    `contributions` {buffer: (N, channels)}: the part of each way in the shader's outputs, and `values`
    {buffer: (channels,)}: the outputs. A value is the sum of its contributions, after the shader's last step: the
    power of `ssao`, the clamp of `rotated_ssao`.
    `partly` (N,): the open share of ways whose shadow has a soft edge, as shadow maps have.
    """

    noun: str
    receiver: np.ndarray
    normal: np.ndarray
    ends: np.ndarray
    points: np.ndarray
    blocked: np.ndarray
    occluders: np.ndarray
    contributions: Mapping[str, np.ndarray]
    values: Mapping[str, np.ndarray]
    partly: np.ndarray | None = None
    until: Literal["reach", "light", "infinity"] = "reach"

    @property
    def shares(self) -> np.ndarray:
        """(N,): the open share of each way."""
        if self.partly is not None:
            return self.partly
        return np.where(self.blocked.any(axis=1), 0.0, 1.0)

    @property
    def open(self) -> np.ndarray:
        """(N,) bool: the ways that are more open than blocked."""
        return self.shares > 0.5

    @property
    def distances(self) -> np.ndarray:
        """(N,): from the receiver to the end of each way."""
        return np.linalg.norm(self.ends - self.receiver, axis=1)

    @property
    def sizes(self) -> np.ndarray:
        """(N,): the size of each way's contribution to the first buffer."""
        return np.abs(next(iter(self.contributions.values()))).max(axis=1)

    def foremost(self, most: int) -> np.ndarray:
        """(n,) int: the numbers, in their order, of the at most `most` ways that contribute most."""
        return np.sort(np.argsort(-self.sizes, kind="stable")[:most])

    @property
    def first(self) -> np.ndarray:
        """(N,) int: the index of the first blocked point on each way; 0 on an open one."""
        return self.blocked.argmax(axis=1) if self.blocked.size else np.zeros(len(self.ends), int)
