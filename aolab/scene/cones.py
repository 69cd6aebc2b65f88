"""The environment's mean radiance in cones: bent normals look it up (Klehm et al. 2011, "pre-convolved" maps)."""

from dataclasses import dataclass

import numpy as np

from .environment import Environment, averaged
from .prefiltered import BLUR_CELLS, octahedral_directions

SLICES = 8  # half angles from 11.25° in equal steps to 90°
TEXELS = 32  # a side of a slice, an octahedral map: 5° a texel, half the narrowest cone


@dataclass(frozen=True)
class Cones:
    """`cone_environment`: slices one above the other, each with a border of one texel, to be read between texels."""

    smooth: bool = True

    def __call__(self, environment: Environment) -> np.ndarray:
        return np.concatenate([bordered(one) for one in cones(environment)])


def cones(environment: Environment, slices: int = SLICES, texels: int = TEXELS) -> np.ndarray:
    """(slices, texels, texels, 3) float32: ∫ L cosθ dω / ∫ cosθ dω over the cone around each direction.

    Slice i has the half angle (i + 1) / slices · 90°, and θ is the angle to its axis: the last one is irradiance / π. A
    cone's edge is soft over one cell of the map. A constant environment stays exactly that.
    """
    if np.ptp(environment.radiance, axis=(0, 1)).max() == 0:  # nothing to average
        return np.broadcast_to(environment.radiance[0, 0], (slices, texels, texels, 3))
    directions = octahedral_directions(texels).reshape(-1, 3).astype(np.float32)
    values, cells, solid_angles = averaged(fine(environment.radiance), BLUR_CELLS)
    flux = np.concatenate([values, np.ones_like(values[..., :1])], axis=-1) * solid_angles[..., None]
    flux, cells = flux.reshape(-1, 4).astype(np.float32), cells.reshape(-1, 3).astype(np.float32)
    softness = np.float32(np.pi / BLUR_CELLS[0])
    result = np.empty((slices, len(directions), 3), np.float32)
    for start in range(0, len(directions), 128):  # bounds the matrix
        part = slice(start, start + 128)
        cosine = np.clip(directions[part] @ cells.T, 0, 1)
        angle = np.arccos(cosine)
        for i in range(slices):
            edge = np.float32((i + 1) / slices * np.pi / 2)
            inside = np.clip((edge - angle) / softness + np.float32(0.5), 0, 1)
            sums = (inside * cosine) @ flux
            result[i, part] = sums[:, :3] / sums[:, 3:]
    return result.reshape(slices, texels, texels, 3)


def fine(radiance: np.ndarray) -> np.ndarray:
    """The map with its texels repeated until there are `BLUR_CELLS` of them: the narrowest cone holds some."""
    for axis, wanted in enumerate(BLUR_CELLS):
        radiance = np.repeat(radiance, -(-wanted // radiance.shape[axis]), axis=axis)
    return radiance


def bordered(octahedral: np.ndarray) -> np.ndarray:
    """(n + 2, n + 2, C) from an octahedral map (n, n, C): beyond an edge the map goes on, mirrored at its middle."""
    rows = np.concatenate([octahedral[:1, ::-1], octahedral, octahedral[-1:, ::-1]])
    left = np.concatenate([octahedral[-1:, -1:], octahedral[::-1, :1], octahedral[:1, -1:]])
    right = np.concatenate([octahedral[-1:, :1], octahedral[::-1, -1:], octahedral[:1, :1]])
    return np.concatenate([left, rows, right], axis=1)
