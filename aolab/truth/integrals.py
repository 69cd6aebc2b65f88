"""What is integrated over the hemisphere, buffer by buffer: each a mean over cosine-distributed rays."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from ..maths.harmonics import basis
from ..maths.sampling import influence
from ..scene.environment import Environment
from ..scene.lights import Light
from .casters import Hits
from .hemisphere import frames, strata
from .lighting import environment_radiance, irradiance
from .points import Points
from .world import World

Measure = Literal["classical", "linear", "sqrt", "exponential"]


@dataclass(frozen=True)
class Setting:
    """What the integrals depend on besides the surface. `radius` may be infinite; see `reference` for the others."""

    world: World
    environment: Environment
    lights: tuple[Light, ...]
    radius: float
    falloff: float
    measure: Measure
    bounces: int

    @property
    def limit(self) -> float:
        """How far rays go, scene units: nothing beyond it counts."""
        return np.inf if self.measure == "exponential" else self.radius


def fuzzy_openness(distance: np.ndarray, measure: Measure) -> np.ndarray:
    """μ of Umenhoffer et al. 2009, figure 1, `distance` in radii; `exponential` takes σ = 1/radius and never ends."""
    if measure == "exponential":
        return 1 - np.exp(-distance)
    return {"classical": np.floor, "linear": np.positive, "sqrt": np.sqrt}[measure](np.minimum(distance, 1))


def in_radii(hits: Hits, radius: float) -> np.ndarray:
    """(n,): distances as multiples of the radius, infinite where nothing was hit, also when the radius is."""
    return np.divide(hits.distance, np.float32(radius), out=hits.distance.copy(), where=hits.triangle >= 0)


@dataclass
class Sample:
    """One ray a point: what the integrands look at. `hits` is None where only `open` was asked for."""

    setting: Setting
    points: Points
    directions: np.ndarray  # (n, 3) float32, world space, unit
    open: np.ndarray  # (n,) float32: 1 - influence of what was hit
    hits: Hits | None
    random: np.random.Generator

    @property
    def first(self) -> Hits:
        assert self.hits is not None
        return self.hits

    @cached_property
    def blocked(self) -> np.ndarray:
        """Indices of the rays that hit something nearer than the setting's limit."""
        return np.flatnonzero(self.first.triangle >= 0)

    @cached_property
    def hit_albedo(self) -> np.ndarray:
        """(blocked, 3): a(y)."""
        return self.setting.world.albedo(*(part[self.blocked] for part in self.first[1:]))

    @cached_property
    def hit_surface(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions and normals (blocked, 3) of what was hit, on the side that was hit."""
        b = self.blocked
        return self.setting.world.hit_surface(
            self.points.position[b], self.directions[b], self.first.distance[b], self.first.triangle[b]
        )

    @cached_property
    def openness(self) -> np.ndarray:
        """(n,): μ(d)."""
        return fuzzy_openness(in_radii(self.first, self.setting.radius), self.setting.measure)

    def at_hits(self, values: np.ndarray) -> np.ndarray:
        """(n, 3), 0 where nothing was hit."""
        full = np.zeros_like(self.directions)
        full[self.blocked] = values
        return full


def _open(sample: Sample) -> np.ndarray:
    return sample.open[:, None]


def _environment(sample: Sample) -> np.ndarray:
    return sample.open[:, None] * environment_radiance(sample.setting.environment, sample.directions)


def _open_direction(sample: Sample) -> np.ndarray:
    return sample.open[:, None] * sample.directions


def _harmonics(sample: Sample) -> np.ndarray:
    return sample.open[:, None] * basis(sample.directions, 4).astype(np.float32)


def _fuzzy(sample: Sample) -> np.ndarray:
    return sample.openness[:, None]


def _closed_albedo(sample: Sample) -> np.ndarray:
    return sample.at_hits((1 - sample.openness[sample.blocked, None]) * sample.hit_albedo)


def _sender(sample: Sample) -> np.ndarray:
    """Radiance of what blocks, lit by the lights and by the environment; as much of it as blocks."""
    positions, normals = sample.hit_surface
    light = irradiance(sample.setting.world, sample.setting.lights, positions, normals) / np.float32(np.pi)
    light += _skylight(sample, positions, normals)
    return sample.at_hits((1 - sample.open[sample.blocked, None]) * sample.hit_albedo * light)


def _skylight(sample: Sample, positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """The environment's irradiance / π at `positions` (n, 3), by one ray each, however far it goes."""
    setting = sample.setting
    if not len(positions) or not setting.environment.radiance.any():
        return np.zeros_like(positions)
    directions = next(strata(2)).directions(frames(normals), sample.random)
    open = setting.world.first_hit(positions, directions, np.inf).triangle < 0
    return np.where(open[:, None], environment_radiance(setting.environment, directions), np.float32(0))


def _path(sample: Sample) -> np.ndarray:
    """Sky of radiance 1 reached by a path whose segments within the radius meet surfaces; the first albedo left out.

    A path still closed after the last bounce carries nothing.
    """
    setting = sample.setting
    near = sample.first.distance[sample.blocked] < setting.radius
    arrived = np.ones_like(sample.directions)
    rays = sample.blocked[near]
    throughput = sample.hit_albedo[near]
    positions, normals = (part[near] for part in sample.hit_surface)
    arrived[rays] = 0
    whole = next(strata(2))
    for _ in range(setting.bounces):
        if not len(rays):
            break
        directions = whole.directions(frames(normals), sample.random)
        hits = setting.world.first_hit(positions, directions, setting.radius)
        closed = hits.triangle >= 0
        arrived[rays[~closed]] = throughput[~closed]
        albedo = setting.world.albedo(*(part[closed] for part in hits[1:]))
        positions, normals = setting.world.hit_surface(
            positions[closed], directions[closed], hits.distance[closed], hits.triangle[closed]
        )
        rays, throughput = rays[closed], throughput[closed] * albedo
    return arrived


@dataclass(frozen=True)
class Integrand:
    """`evaluate(sample)` gives (n, channels); with `needs_hits`, occlusion alone is not enough."""

    channels: int
    evaluate: Callable[[Sample], np.ndarray]
    needs_hits: bool = False


INTEGRANDS = {
    "open": Integrand(1, _open),
    "environment": Integrand(3, _environment),
    "open_direction": Integrand(3, _open_direction),
    "harmonics": Integrand(16, _harmonics),
    "fuzzy": Integrand(1, _fuzzy, needs_hits=True),
    "closed_albedo": Integrand(3, _closed_albedo, needs_hits=True),
    "sender": Integrand(3, _sender, needs_hits=True),
    "path": Integrand(3, _path, needs_hits=True),
}


def integrate(
    setting: Setting, points: Points, rays: int, names: Iterable[str], random: np.random.Generator
) -> dict[str, np.ndarray]:
    """The mean of each integrand over `rays` rays a point, (n, channels) and `standard_error`, that of `open`."""
    integrands: Mapping[str, Integrand] = {name: INTEGRANDS[name] for name in names}
    needs_hits = setting.falloff > 0 or any(integrand.needs_hits for integrand in integrands.values())
    sums = {name: np.zeros((len(points), one.channels), np.float32) for name, one in integrands.items()}
    squared_differences = np.zeros(len(points), np.float32)
    axes = frames(points.normal)
    for stratum in strata(rays):
        opens = []
        for _ in range(2):
            sample = _cast(setting, points, stratum.directions(axes, random), needs_hits, random)
            opens.append(sample.open)
            for name, integrand in integrands.items():
                sums[name] += integrand.evaluate(sample)
        squared_differences += (opens[0] - opens[1]) ** 2
    means = {name: total / np.float32(rays) for name, total in sums.items()}
    return {**means, "standard_error": np.sqrt(squared_differences)[:, None] / np.float32(rays)}


def _cast(
    setting: Setting, points: Points, directions: np.ndarray, needs_hits: bool, random: np.random.Generator
) -> Sample:
    hits = None
    if needs_hits:
        hits = setting.world.first_hit(points.position, directions, setting.limit)
        open = 1 - influence(in_radii(hits, setting.radius) ** 2, setting.falloff)
    else:
        open = (~setting.world.occluded(points.position, directions, setting.limit)).astype(np.float32)
    return Sample(setting, points, directions, open, hits, random)
