"""The samples that a pass took for one pixel, its values, and a text of both."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh

from ...pipeline.frame import Frame
from .samples import Samples

MOST_LINES = 64  # of the samples of a pass


@dataclass(frozen=True, eq=False)
class Sampled:
    """The samples that a pass took for one pixel. `name` is the pass's, as in `Frame.timings`.

    `texel` (column, row): that of the pass's picture, which may have a lower resolution. `sets`: the samples of each
    accumulated sample set. `values` {buffer: (channels,)}: the replayed texel, the mean of the sets; `rendered`: the
    texel that the shader wrote. Both are raw: before the filter.
    """

    frame: Frame
    name: str
    texel: tuple[int, int]
    sets: tuple[Samples, ...]
    values: dict[str, np.ndarray]
    rendered: dict[str, np.ndarray]

    @property
    def difference(self) -> float:
        """The largest difference between a replayed and a rendered value, relative to values above 1."""
        return max(
            float(np.max(np.abs(self.values[name] - one) / np.maximum(np.abs(one), 1)))
            for name, one in self.rendered.items()
        )

    @cached_property
    def blockers(self) -> tuple[str, ...]:
        """For each way of the first set: the name of the mesh that blocks it, or ""."""
        samples = self.sets[0]
        if not samples.blocked.size:
            return ("",) * len(samples.ends)
        positions = samples.occluders[np.arange(len(samples.ends)), samples.first].astype(np.float64)
        world_from_view = np.linalg.inv(self.frame.camera.view_from_world)
        points = positions @ world_from_view[:3, :3].T + world_from_view[:3, 3]
        return tuple(
            "" if is_open else self._mesh_at(point) for is_open, point in zip(samples.open, points, strict=True)
        )

    def _mesh_at(self, point: np.ndarray) -> str:
        """The name of the mesh nearest to a world-space point, among those whose bounds contain it."""
        scene = self.frame.scene
        assert scene is not None  # a lab rendered the frame
        margin, found = 0.02 * scene.radius, (np.inf, "a surface")
        for instance in scene.instances:
            matrix = instance.world_from_local
            corners = instance.mesh.vertices[instance.mesh.faces].astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
            near = ((corners.min(axis=1) <= point + margin) & (corners.max(axis=1) >= point - margin)).all(axis=1)
            if near.any():
                on = trimesh.triangles.closest_point(corners[near], np.broadcast_to(point, (int(near.sum()), 3)))
                distance = float(np.linalg.norm(on - point, axis=1).min())
                found = min(found, (distance, instance.name or instance.mesh.name))
        return found[1]

    def __str__(self) -> str:
        samples = self.sets[0]
        values = ", ".join(f"{name} {_digits(one)}" for name, one in self.values.items())
        count = f", the first of {len(self.sets)} sample sets" if len(self.sets) > 1 else ""
        lines = [f"{self.name}: {values}"]
        share = f"{samples.open.sum()} of {len(samples.open)} {samples.noun}s open{count}"
        lines.append(f"replay and shader differ by {self.difference:.1e}; {share}")
        name, parts = next(iter(samples.contributions.items()))
        lines += [f"  {samples.noun} {i}: {self._way(i)}; {name} {_digits(part)}" for i, part in _most(parts)]
        if len(parts) > MOST_LINES:
            lines.append(f"  and {len(parts) - MOST_LINES} {samples.noun}s that contribute less")
        return "\n".join(lines)

    def _way(self, i: int) -> str:
        """Whether a way is open, how far, and the name of the mesh that blocks it."""
        samples = self.sets[0]
        if samples.open[i]:
            reach = float(np.linalg.norm(samples.ends[i] - samples.receiver))
            way = "open" if samples.far else f"open to {reach:.3g}"
        else:
            place = samples.points[i, samples.first[i]]
            way = f"blocked at {float(np.linalg.norm(place - samples.receiver)):.3g} by {self.blockers[i]}"
        return way if samples.shares[i] in (0, 1) else f"{way}, {samples.shares[i]:.0%} of its light arrives"


def _most(parts: np.ndarray) -> list[tuple[int, np.ndarray]]:
    """The numbers and contributions of the `MOST_LINES` ways that contribute most, in their order."""
    size = np.abs(parts).max(axis=1)
    chosen = np.sort(np.argsort(-size, kind="stable")[:MOST_LINES])
    return [(int(i), parts[i]) for i in chosen]


def _digits(values: np.ndarray) -> str:
    return np.array2string(values, precision=4, suppress_small=True)
