"""The environment as rays meet it: an even part, which any ray looks up, and a bright part with rays of its own.

A sun covers so few directions that rays spread over the hemisphere miss it, or hit it with far too much weight. So the
map is split: even + bright = the map, texel by texel, with no even texel brighter than `BRIGHT` times the mean. Rays
over the hemisphere look up the even part; a few further rays, drawn in proportion to the bright part, look up the rest
(importance sampling). An environment without a bright part has no such rays.
"""

from functools import cached_property

import numpy as np

from ..scene.environment import Environment, direction_from_uv, uv_from_direction
from .world import bilinear

# Times the mean luminance over the sphere. Measured on `colonnade` under a sky with a sun, at 256 rays: the standard
# error of `ambient` falls from 22.6 % of its root mean square to 2.6 %, that of `indirect` from 50 % to 9.5 %. With 4,
# `boxes` and its two soft boxes pay for rays that gain nothing.
BRIGHT = 8.0
REC_709 = np.array([0.2126, 0.7152, 0.0722])


def environment_radiance(environment: Environment, directions: np.ndarray) -> np.ndarray:
    """(n, 3) float32: the map in world-space `directions` (n, 3), bilinear, as the GPU reads it."""
    return _look_up(environment.radiance, directions)


class Sky:
    """`environment` split in two. Radiance is linear RGB, directions are world-space unit vectors (n, 3) float32."""

    def __init__(self, environment: Environment) -> None:
        radiance = environment.radiance
        luminance = radiance @ REC_709
        rows = -np.diff(np.cos(np.pi * np.arange(len(radiance) + 1) / len(radiance)))  # solid angles; they add up to 2
        limit = BRIGHT * (luminance.mean(axis=1) * rows).sum() / 2
        share = np.minimum(1, limit / np.maximum(luminance, 1e-30))[..., None]
        self._even = (radiance * share).astype(np.float32)
        self._bright = radiance - self._even
        self.has_light = bool(radiance.any())
        self.has_bright_part = bool((luminance > limit).any())

    def even(self, directions: np.ndarray) -> np.ndarray:
        """(n, 3) float32: the even part's radiance."""
        return _look_up(self._even, directions)

    def towards_bright(self, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions (n, 3) drawn in proportion to the bright part, and its radiance / density (n, 3) float32.

        `u`, `v` (n,) are uniform in [0, 1): `u` draws the texel and the height in it, `v` draws the azimuth in it.
        """
        weight, steps = self._distribution
        height, width = weight.shape[:2]
        texel = np.minimum(np.searchsorted(steps, u, side="right"), len(steps) - 1)
        below = np.where(texel > 0, steps[texel - 1], 0)
        within = (u - below) / np.maximum(steps[texel] - below, 1e-300)
        # The tent of bilinear interpolation around the texel's centre: the density between texels is the interpolated
        # weight. It is mirrored at the poles, where the look-up repeats the last row.
        row = np.abs(texel // width + 0.5 + _tent(within))
        row = np.where(row > height, 2 * height - row, row)
        column = texel % width + 0.5 + _tent(v)
        polar = np.pi * row / height
        directions = direction_from_uv(np.stack([column / width, row / height], axis=-1)).astype(np.float32)
        # density over uv, whose area is 2π² sinθ to the solid angle
        density = bilinear(weight, column / width, row / height, repeat_rows=False)[:, 0] * height * width
        scale = 2 * np.pi**2 * np.sin(polar) / np.maximum(density, 1e-30)
        return directions, _look_up(self._bright, directions) * scale.astype(np.float32)[:, None]

    @cached_property
    def _distribution(self) -> tuple[np.ndarray, np.ndarray]:
        """The share (H, W, 1) float32 of each texel in the bright part's light, and the cumulative shares (H·W,)."""
        rows = -np.diff(np.cos(np.pi * np.arange(len(self._bright) + 1) / len(self._bright)))
        weight = (self._bright @ REC_709) * rows[:, None]
        weight /= weight.sum()
        return weight.astype(np.float32)[..., None], np.cumsum(weight)


def _tent(u: np.ndarray) -> np.ndarray:
    """(n,) in [-1, 1] with the density 1 - |x|, from `u` (n,) uniform in [0, 1]."""
    return np.where(u < 0.5, np.sqrt(2 * u) - 1, 1 - np.sqrt(np.maximum(2 - 2 * u, 0)))


def _look_up(radiance: np.ndarray, directions: np.ndarray) -> np.ndarray:
    if (radiance == radiance[0, 0]).all():  # constant: nothing to look up
        return np.broadcast_to(radiance[0, 0], directions.shape)
    u, v = uv_from_direction(directions).T
    return bilinear(radiance, u, v, repeat_rows=False)
