"""The environment as rays meet it: an even part, which any ray looks up, and a bright part with rays of its own.

A sun covers so few directions that rays spread over the hemisphere miss it, or hit it with far too much weight. So the
map is split: even + bright = the map, texel by texel, with no even texel brighter than `BRIGHT` times the mean. Rays
over the hemisphere look up the even part; a few further rays, drawn in proportion to the bright part, look up the rest
(importance sampling). An environment without a bright part has no such rays.
"""

from functools import cached_property

import numpy as np

from ..scene.environment import Environment, uv_from_direction
from .world import bilinear

BRIGHT = 8.0  # times the mean luminance over the sphere; see `docs/truth.md` for the noise with and without
_REC_709 = np.array([0.2126, 0.7152, 0.0722])


def environment_radiance(environment: Environment, directions: np.ndarray) -> np.ndarray:
    """(n, 3) float32: the map in world-space `directions` (n, 3), bilinear, as the GPU reads it."""
    return _look_up(environment.radiance, directions)


class Sky:
    """`environment` split in two. Radiance is linear RGB, directions are world-space unit vectors (n, 3) float32."""

    def __init__(self, environment: Environment) -> None:
        radiance = environment.radiance
        luminance = radiance @ _REC_709
        self._row_edges = np.cos(np.pi * np.arange(len(radiance) + 1) / len(radiance))  # cosines of the polar angle
        solid_angle = -np.diff(self._row_edges)[:, None] * 2 * np.pi / radiance.shape[1]
        limit = BRIGHT * (luminance * solid_angle).sum() / (4 * np.pi)
        share = np.minimum(1, limit / np.maximum(luminance, 1e-30))[..., None]
        self._even = (radiance * share).astype(np.float32)
        self._bright = radiance - self._even
        self._solid_angle = solid_angle
        self.has_light = bool(radiance.any())
        self.has_bright_part = bool((luminance > limit).any())

    def even(self, directions: np.ndarray) -> np.ndarray:
        """(n, 3) float32: the even part's radiance."""
        return _look_up(self._even, directions)

    def towards_bright(self, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions (n, 3) drawn in proportion to the bright part, and its radiance / density (n, 3) float32.

        `u`, `v` (n,) are uniform in [0, 1): `u` picks the texel and the height within it, `v` the azimuth within it.
        """
        steps, density = self._distribution
        texel = np.minimum(np.searchsorted(steps, u, side="right"), len(steps) - 1)
        below = np.where(texel > 0, steps[texel - 1], 0)
        within = (u - below) / np.maximum(steps[texel] - below, 1e-300)
        width = self._even.shape[1]
        row, column = texel // width, texel % width
        up = self._row_edges[row] + (self._row_edges[row + 1] - self._row_edges[row]) * within
        azimuth = 2 * np.pi * ((column + v) / width - 0.5)
        across = np.sqrt(np.maximum(1 - up * up, 0))
        directions = np.stack([across * np.sin(azimuth), up, -across * np.cos(azimuth)], axis=-1).astype(np.float32)
        return directions, _look_up(self._bright, directions) / density[texel].astype(np.float32)[:, None]

    @cached_property
    def _distribution(self) -> tuple[np.ndarray, np.ndarray]:
        """The cumulative distribution over texels (H·W,), and the density (H·W,) over solid angle in each.

        A texel's value reaches half a texel beyond its edges, for the look-up is bilinear: so a texel is drawn by the
        brightest of its neighbours and itself.
        """
        luminance = self._bright @ _REC_709
        padded = np.pad(np.pad(luminance, ((1, 1), (0, 0)), "edge"), ((0, 0), (1, 1)), "wrap")
        brightest = np.lib.stride_tricks.sliding_window_view(padded, (3, 3)).max(axis=(2, 3))
        weight = (brightest * self._solid_angle).ravel()
        steps = np.cumsum(weight) / weight.sum()
        return steps, brightest.ravel() / weight.sum()


def _look_up(radiance: np.ndarray, directions: np.ndarray) -> np.ndarray:
    if (radiance == radiance[0, 0]).all():  # constant: nothing to look up
        return np.broadcast_to(radiance[0, 0], directions.shape)
    u, v = uv_from_direction(directions).T
    return bilinear(radiance, u, v, repeat_rows=False)
