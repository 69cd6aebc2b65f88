"""`aolab.microscope`: every sample of one pixel, replayed."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from PIL import Image

from ..errors import ParameterError
from ..pictures.html import png
from ..pipeline.frame import Frame
from .contributions import contributions, summed
from .reading import inside
from .replay import Samples, replay, surfaces


@dataclass(frozen=True, eq=False)
class Microscope:
    """The samples of one pixel. A notebook shows `picture()`; `str` gives a line for each direction.

    `pixel` (column, row) of the image; `texel`: the same of the estimate, which may have a lower resolution.
    `sets`: the samples of each accumulated sample set; `contributions`: for each set, {buffer: (N, channels)}.
    `values` {buffer: (channels,)}: the replayed texel; `rendered`: the texel that the shader wrote. Both are raw:
    before the filter.
    """

    frame: Frame
    pixel: tuple[int, int]
    texel: tuple[int, int]
    sets: tuple[Samples, ...]
    contributions: tuple[dict[str, np.ndarray], ...]
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
        """For each direction of the first set: the name of the mesh that blocks it, or ""."""
        samples = self.sets[0]
        positions = samples.occluders[np.arange(len(samples.directions)), samples.first].astype(np.float64)
        world_from_view = np.linalg.inv(self.frame.camera.view_from_world)
        world = positions @ world_from_view[:3, :3].T + world_from_view[:3, 3]
        return tuple(
            "" if is_open else self._mesh_at(point) for is_open, point in zip(samples.open, world, strict=True)
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
        samples, lines = self.sets[0], []
        value = ", ".join(
            f"{name} {np.array2string(one, precision=4, suppress_small=True)}" for name, one in self.values.items()
        )
        count = f", the first of {len(self.sets)} sample sets" if len(self.sets) > 1 else ""
        lines.append(f"pixel {self.pixel} of {self.frame.info['module']}: {value}")
        share = f"{samples.open.sum()} of {len(samples.open)} directions open{count}"
        lines.append(f"replay and shader differ by {self.difference:.1e}; {share}")
        name, parts = next(iter(self.contributions[0].items()))
        for i, (is_open, blocker) in enumerate(zip(samples.open, self.blockers, strict=True)):
            distance = samples.along[i, samples.first[i]] * samples.reach[i]
            seen = f"open to {samples.reach[i]:.3g}" if is_open else f"blocked at {distance:.3g} by {blocker}"
            part = np.array2string(parts[i], precision=4, suppress_small=True)
            lines.append(f"  direction {i}: {seen}; {name} {part}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        samples = self.sets[0]
        return f"<Microscope of pixel {self.pixel}: {samples.open.sum()} of {len(samples.open)} directions open>"

    def picture(self) -> Image.Image:
        """The samples over the image, and in three dimensions. Blue: open; orange: blocked; black: the blockers."""
        from .microscope_picture import draw

        return draw(self)

    def _repr_png_(self) -> bytes:
        return png(self.picture())


def microscope(frame: Frame, pixel: tuple[int, int]) -> Microscope:
    """Every sample that a frame's module took for `pixel` (column, row), counted from the top left.

    The samples are computed again in NumPy from the frame's depths and normals: directions, distances, whether and by
    which mesh each is blocked, and the contribution of each direction to the value. `Microscope.difference` compares
    the replayed value with the shader's. Works for `ssao`, `ssdo` (without its bounce), `s3ho`, `ssbn`, and your own
    modules that derive from `aolab.modules.marched.Marched` and write `visibility`; with any occluders.
    Raises `ParameterError` for another module, a frame that no lab rendered, and a pixel outside or in the background.
    """
    column, row = inside(pixel, frame.size, "microscope")
    seen = surfaces(frame)
    (width, height), (few, rows) = frame.size, seen.size
    texel = int((column + 0.5) * few / width), int((row + 0.5) * rows / height)
    sets, parts = [], []
    assert frame.scene is not None  # a lab rendered the frame
    assert frame.scene.environment is not None  # Scene sets it
    world_from_view = np.linalg.inv(frame.camera.view_from_world)[:3, :3]
    for seed in seen.seeds:
        samples = replay(seen, texel, seed)
        if samples is None:
            where = "in the background; frame.mask is True at surfaces"
            if frame.mask[row, column]:
                where = f"in the background at the lower resolution of the estimate, {few}x{rows}"
            raise ParameterError(f"microscope: pixel ({column}, {row}) is {where}")
        sets.append(samples)
        parts.append(contributions(seen.module, samples, frame.scene.environment, world_from_view))
    totals = [summed(seen.module, one) for one in parts]
    values = {name: np.mean([total[name] for total in totals], axis=0) for name in totals[0]}
    rendered = {
        name: np.atleast_1d(frame.channels(f"{name}_raw")[texel[1], texel[0]])[: len(value)].astype(np.float64)
        for name, value in values.items()
    }
    return Microscope(frame, (column, row), texel, tuple(sets), tuple(parts), values, rendered)
