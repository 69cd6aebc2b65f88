"""The integrals over the hemisphere, buffer by buffer: each is a mean over cosine-distributed rays."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..maths.fading import is_hard, reach
from ..maths.harmonics import basis
from .hemisphere import WHOLE, Stratum, frames, strata
from .lamps import from_lamps
from .lighting import irradiance
from .moments import Moments, Pair
from .points import Points
from .sample import Randoms, Sample, Setting
from .senders import sent

RAYS_A_SKY_SAMPLE = 8  # one ray towards the sky's bright part for so many over the hemisphere


def _open(sample: Sample) -> np.ndarray:
    return sample.open[:, None]


def _environment(sample: Sample) -> np.ndarray:
    return sample.open[:, None] * sample.setting.sky.even(sample.directions)


def _open_direction(sample: Sample) -> np.ndarray:
    return sample.open[:, None] * sample.directions


def _harmonics(sample: Sample) -> np.ndarray:
    return sample.open[:, None] * basis(sample.directions, 4).astype(np.float32)


def _fuzzy(sample: Sample) -> np.ndarray:
    return sample.measured[:, None]


def _closed_albedo(sample: Sample) -> np.ndarray:
    return sample.at_hits((1 - sample.measured[sample.blocked, None]) * sample.hit_albedo)


def _path(sample: Sample) -> np.ndarray:
    """(n, 3): a sky of radiance 1 at the end of a path, times the albedos of its reflections but the first.

    Segments longer than the radius see the sky. A path that is still closed after the last bounce carries nothing.
    """
    setting, random = sample.setting, sample.randoms["path"]
    radius = setting.question.reach
    near = sample.first.distance[sample.blocked] < radius
    arrived = np.ones_like(sample.directions)
    rays = sample.blocked[near]
    throughput = sample.hit_albedo[near]
    positions, normals = (part[near] for part in sample.hit_surface)
    arrived[rays] = 0
    for _ in range(setting.question.bounces):
        if not len(rays):
            break
        directions = WHOLE.directions(frames(normals), random, setting.covered)
        hits = setting.world.first_hit(positions, directions, radius)
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
    """`evaluate(sample)` returns (n, channels). `measured`: it weights by the question's measure, not its falloff.

    `needs_hits`: it looks at what was hit, so that occlusion alone is not enough.
    """

    channels: int
    evaluate: Callable[[Sample], np.ndarray]
    needs_hits: bool = False
    measured: bool = False


INTEGRANDS = {
    "open": Integrand(1, _open),
    "environment": Integrand(3, _environment),
    "open_direction": Integrand(3, _open_direction),
    "harmonics": Integrand(16, _harmonics),
    "fuzzy": Integrand(1, _fuzzy, needs_hits=True, measured=True),
    "closed_albedo": Integrand(3, _closed_albedo, needs_hits=True, measured=True),
    "sender": Integrand(3, sent, needs_hits=True),
    "path": Integrand(3, _path, needs_hits=True),
}


def integrate(
    setting: Setting,
    points: Points,
    names: Collection[str],
    crosses: Iterable[Pair],
    randoms: Randoms,
    stopped: Callable[[], bool] = lambda: False,
) -> Moments:
    """The moments of the integrals `names` over `setting.rays` rays a point, with the covariances of `crosses`.

    When `stopped()` becomes true, the rest is left out, and the result is void.

    They are those of `INTEGRANDS`, and `light`, the lights' irradiance, which is exact.
    """
    integrands = {name: INTEGRANDS[name] for name in names if name != "light"}
    channels = {name: one.channels for name, one in integrands.items()}
    moments = Moments(len(points), channels | ({"light": 3} if "light" in names else {}), crosses)
    moments.counted(setting.rays)
    if "light" in names:
        moments.exact("light", irradiance(setting.world, setting.lights, points.position, points.normal))
    if not integrands:
        return moments
    cast = _Cast(setting, integrands)
    axes = frames(points.normal)
    for stratum in strata(setting.rays):
        if stopped():
            return moments
        pair = (cast(points, stratum.directions(axes, randoms["rays"], setting.covered), randoms) for _ in range(2))
        moments.add(*({name: one.evaluate(sample) for name, one in integrands.items()} for sample in pair))
    if "environment" in integrands and setting.sky.has_bright_part:
        for one, other in _bright_sky(setting, points, randoms["sky"]):
            moments.add({"environment": one}, {"environment": other})
    if "sender" in integrands:
        for one, other in from_lamps(setting, points, randoms["lamps"]):
            moments.add({"sender": one}, {"sender": other})
    return moments


class _Cast:
    """Rays over the hemisphere, as far as the integrands look, with or without knowledge of what they hit."""

    def __init__(self, setting: Setting, integrands: Mapping[str, Integrand]) -> None:
        question = setting.question
        measured = any(one.measured for one in integrands.values())
        self._setting = setting
        self._limit = max(setting.limit, reach(question.measure, question.reach) if measured else 0)
        self._needs_hits = not is_hard(question.falloff) or any(one.needs_hits for one in integrands.values())

    def __call__(self, points: Points, directions: np.ndarray, randoms: Randoms) -> Sample:
        hits, ways = None, points.ways(directions)
        if self._needs_hits:
            hits = self._setting.world.first_hit(points.position, ways, self._limit)
            open = self._setting.open(hits.distance)
        else:
            open = self._setting.open_along(points.position, ways)
        return Sample(self._setting, points, directions, ways, open, hits, randoms)


def _bright_sky(
    setting: Setting, points: Points, random: np.random.Generator
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Pairs of samples (n, 3) of the sky's bright part, to be added to those of the rays over the hemisphere."""
    pairs = max(1, setting.rays // (2 * RAYS_A_SKY_SAMPLE))
    for i in range(pairs):
        stratum = Stratum((i / pairs, 0.0), (1 / pairs, 1.0))
        one, other = (_towards_bright(setting, points, stratum, random) for _ in range(2))
        scale = np.float32(setting.rays / (2 * pairs))
        yield one * scale, other * scale


def _towards_bright(setting: Setting, points: Points, stratum: Stratum, random: np.random.Generator) -> np.ndarray:
    """(n, 3): the bright part's radiance in one direction a point, where that is open, × cosθ/π over its density."""
    light = np.zeros((len(points), 3), np.float32)
    directions, radiance = setting.sky.towards_bright(*stratum.square(len(points), random))
    cosine = (directions * points.normal).sum(axis=1)
    rising = np.flatnonzero((cosine > 0) & (cosine**2 >= 1 - setting.covered))
    open = setting.open_along(points.position[rising], points.ways(directions)[rising])
    light[rising] = (open * cosine[rising])[:, None] * radiance[rising] / np.float32(np.pi * setting.covered)
    return light
