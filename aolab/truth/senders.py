"""The light that blocking surfaces send: of the lamps and of the environment, reflected once, and their own."""

import numpy as np

from .hemisphere import WHOLE, frames
from .lamps import balance
from .lighting import color, received
from .sample import Sample


def sent(sample: Sample) -> np.ndarray:
    """(n, 3): the radiance that a blocking surface sends along each ray, times its blocked share; 0 along open rays.

    Without `blocked_senders`, the sum over all surfaces along the ray.
    """
    light = _of_first(sample)
    while not sample.setting.question.blocked_senders and len(sample.blocked):
        sample = sample.beyond()
        light += _of_first(sample)
    return light


def _of_first(sample: Sample) -> np.ndarray:
    """(n, 3): the same of the first surface alone."""
    setting, b = sample.setting, sample.blocked
    positions, normals = sample.hit_surface
    rising = sample.points.cosine(sample.ways[b], b, setting.covered)
    facing = -(sample.ways[b] * normals).sum(axis=1)
    geometry = rising * facing / np.maximum(sample.first.distance[b] ** 2, np.float32(1e-30))
    light = skylight(sample, positions, normals)
    for lamp in setting.lights:
        share = received(setting.world, lamp, positions, normals)
        weight = share * balance(setting, lamp, geometry, share) / np.float32(np.pi)
        light += weight[:, None] * color(lamp)
    light *= sample.hit_albedo
    if setting.world.emits:
        light += setting.world.emission(*(part[b] for part in sample.first[1:]))
    return sample.at_hits((1 - sample.open[b, None]) * light)


def skylight(sample: Sample, positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(m, 3): the environment's irradiance / π at `positions` (m, 3), by one ray each, and one towards its bright part.

    Under `limited_senders` the rays are as long as the receiver's; else their length is unlimited.
    """
    setting, random = sample.setting, sample.randoms["skylight"]
    sky = setting.sky
    light = np.zeros_like(positions)
    if not len(positions) or not sky.has_light:
        return light
    covered = setting.covered if setting.question.limited_senders else 1.0
    directions = WHOLE.directions(frames(normals), random, covered)
    light += _open(sample, positions, directions)[:, None] * sky.even(directions)
    if sky.has_bright_part:
        directions, radiance = sky.towards_bright(*WHOLE.square(len(positions), random))
        cosine = (directions * normals).sum(axis=1)
        rising = np.flatnonzero((cosine > 0) & (cosine**2 >= 1 - covered))
        open = _open(sample, positions[rising], directions[rising])
        light[rising] += (open * cosine[rising])[:, None] * radiance[rising] / np.float32(np.pi * covered)
    return light


def _open(sample: Sample, positions: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(m,) float32: how far the directions are open for a sender."""
    setting = sample.setting
    if setting.question.limited_senders:
        return setting.open_along(positions, directions)
    return (~setting.world.occluded(positions, directions, np.inf)).astype(np.float32)
