"""One ray a point and its hit: the input of the integrands."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..maths.fading import is_hard, openness, reach
from ..modules.question import Question
from ..scene.lights import Light
from .casters import Hits
from .hemisphere import covered_by
from .points import Points
from .sky import Sky
from .world import World

# one generator a purpose: the rays of one buffer do not depend on which other buffers are computed
PURPOSES = ("rays", "skylight", "path", "sky", "lamps")
Randoms = Mapping[str, np.random.Generator]


def randoms(*seed: int) -> Randoms:
    """Independent generators by purpose, decided by the numbers of `seed`."""
    return {name: np.random.Generator(np.random.SFC64([*seed, i])) for i, name in enumerate(PURPOSES)}


@dataclass(frozen=True)
class Setting:
    """The problem apart from the surface: the world, the sky, the lights, the question, and `rays` a point."""

    world: World
    sky: Sky
    lights: tuple[Light, ...]
    question: Question
    rays: int

    @cached_property
    def covered(self) -> float:
        """The share of ∫ cosθ dω over the hemisphere that lies within the question's cone."""
        return covered_by(self.question.spread)

    @cached_property
    def limit(self) -> float:
        """The distance from which on occluders leave a direction open."""
        return reach(self.question.falloff, self.question.reach)

    def in_radii(self, distance: np.ndarray) -> np.ndarray:
        """`distance` (n,) float32 as multiples of the radius; infinity stays infinity, also for an infinite radius."""
        hit = np.isfinite(distance)
        return np.divide(distance, np.float32(self.question.reach), out=distance.copy(), where=hit)

    def open(self, distance: np.ndarray) -> np.ndarray:
        """(n,) float32: how far an occluder at `distance` (n,) leaves its direction open."""
        return openness(self.in_radii(distance), self.question.falloff, self.question.sigma).astype(np.float32)

    def open_along(self, positions: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """(n,) float32: how far rays from lifted `positions` along `directions`, both (n, 3), are open."""
        if is_hard(self.question.falloff):
            return (~self.world.occluded(positions, directions, self.limit)).astype(np.float32)
        return self.open(self.world.first_hit(positions, directions, self.limit).distance)


@dataclass
class Sample:
    """One ray a point, along its way (`Points.ways`). `hits` is None if no integrand reads it."""

    setting: Setting
    points: Points
    directions: np.ndarray  # (n, 3) float32, world space, unit
    ways: np.ndarray  # (n, 3)
    open: np.ndarray  # (n,) float32
    hits: Hits | None
    randoms: Randoms

    def beyond(self) -> "Sample":
        """The same rays behind their first hits."""
        b, setting = self.blocked, self.setting
        start = self.first.distance[b] + np.float32(2 * setting.world.lift)
        origins = self.points.position[b] + self.ways[b] * start[:, None]
        further = setting.world.first_hit(origins, self.ways[b], np.float32(setting.limit) - start)
        empty = (np.inf, -1, 0, 0)
        hits = Hits(*(np.full_like(part, value) for part, value in zip(self.first, empty, strict=True)))
        for part, new in zip(hits, (further.distance + start, *further[1:]), strict=True):
            part[b] = new
        return replace(self, open=setting.open(hits.distance), hits=hits)

    @property
    def first(self) -> Hits:
        assert self.hits is not None
        return self.hits

    @cached_property
    def blocked(self) -> np.ndarray:
        """Indices of the rays that hit something."""
        return np.flatnonzero(self.first.triangle >= 0)

    @cached_property
    def hit_albedo(self) -> np.ndarray:
        """(blocked, 3): the albedo of the surfaces that were hit."""
        return self.setting.world.albedo(*(part[self.blocked] for part in self.first[1:]))

    @cached_property
    def hit_surface(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions and normals (blocked, 3) of the hits, on the side that was hit."""
        b = self.blocked
        return self.setting.world.hit_surface(
            self.points.position[b], self.ways[b], self.first.distance[b], self.first.triangle[b]
        )

    @cached_property
    def measured(self) -> np.ndarray:
        """(n,): μ(d), the openness by the question's `measure`."""
        question = self.setting.question
        return openness(self.setting.in_radii(self.first.distance), question.measure, question.sigma)

    def at_hits(self, values: np.ndarray) -> np.ndarray:
        """(n, 3): `values` (blocked, 3) at their rays, 0 at the others."""
        full = np.zeros_like(self.directions)
        full[self.blocked] = values
        return full
