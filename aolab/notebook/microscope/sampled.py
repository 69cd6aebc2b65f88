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
        names, blocked = [""] * len(samples.ends), np.flatnonzero(~samples.open)
        found = self._meshes_at(samples.occluders[blocked, samples.first[blocked]])
        for i, name in zip(blocked, found, strict=True):
            names[i] = name
        return tuple(names)

    def _meshes_at(self, positions: np.ndarray) -> list[str]:
        """The name of the mesh nearest to each view-space point (n, 3), among those whose triangles are near."""
        scene = self.frame.scene
        assert scene is not None  # a lab rendered the frame
        world_from_view = np.linalg.inv(self.frame.camera.view_from_world)
        points = positions.astype(np.float64) @ world_from_view[:3, :3].T + world_from_view[:3, 3]
        margin, found = 0.02 * scene.radius, [(np.inf, "a surface")] * len(points)
        for instance in scene.instances:
            matrix = instance.world_from_local
            corners = instance.mesh.vertices[instance.mesh.faces].astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
            low, high = corners.min(axis=1) - margin, corners.max(axis=1) + margin
            inside = ((low.min(axis=0) <= points) & (high.max(axis=0) >= points)).all(axis=1)
            for i in np.flatnonzero(inside):
                point = points[i]
                near = ((low <= point) & (high >= point)).all(axis=1)
                if near.any():
                    on = trimesh.triangles.closest_point(corners[near], np.broadcast_to(point, (int(near.sum()), 3)))
                    distance = float(np.linalg.norm(on - point, axis=1).min())
                    found[i] = min(found[i], (distance, instance.name or instance.mesh.name))
        return [name for _, name in found]

    def __str__(self) -> str:
        samples = self.sets[0]
        values = ", ".join(f"{name} {_digits(one)}" for name, one in self.values.items())
        count = f", the first of {len(self.sets)} sample sets" if len(self.sets) > 1 else ""
        lines = [f"{self.name}: {values}"]
        lines.append(f"replay and shader differ by {self.difference:.1e}; {self.summary}{count}")
        name, parts = next(iter(samples.contributions.items()))
        chosen = samples.foremost(MOST_LINES)
        places = self._meshes_at(samples.ends[chosen]) if samples.until == "light" else [""] * len(chosen)
        for i, place in zip(chosen, places, strict=True):
            lines.append(f"  {samples.noun} {i}: {self._way(i, place)}; {name} {_digits(parts[i])}")
        if len(parts) > MOST_LINES:
            lines.append(f"  and {len(parts) - MOST_LINES} {samples.noun}s that contribute less")
        return "\n".join(lines)

    @property
    def summary(self) -> str:
        """The number of ways, and how many of them are open."""
        samples = self.sets[0]
        count, open_ = len(samples.ends), samples.open.sum()
        tested = f"{open_} of {count} {samples.noun}s open"
        return tested if samples.points.shape[1] else f"{count} {samples.noun}s, not tested for blocking"

    def _way(self, i: int, place: str) -> str:
        """Whether a way is open, how far, and the name of the mesh that blocks it; `place` has the light."""
        samples = self.sets[0]
        parts = [f"on {place} at {samples.distances[i]:.3g}"] if place else []
        if not samples.open[i]:
            at = float(np.linalg.norm(samples.points[i, samples.first[i]] - samples.receiver))
            parts.append(f"blocked at {at:.3g} by {self.blockers[i]}")
        elif samples.points.shape[1]:
            parts.append("open" if samples.until != "reach" else f"open to {samples.distances[i]:.3g}")
        if 0 < samples.shares[i] < 1:
            parts.append(f"its shadow map lets {samples.shares[i]:.0%} through")
        return ", ".join(parts)


def _digits(values: np.ndarray) -> str:
    return np.array2string(values, formatter={"float_kind": "{:.3g}".format})
