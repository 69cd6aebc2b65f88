"""Tables that are made of an environment, for shaders to read; here, the map blurred to one sample's solid angle."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .environment import Environment, averaged, uv_from_direction

SHARP_TEXELS = 256  # a side: 0.6° a texel
BLUR_CELLS = (64, 128)  # rows, columns of the equirectangular map that the blur reads: 2.8° a cell


class Table(Protocol):
    """Makes (h, w, 3) float32 of an environment; equal tables make the same. `smooth`: read between the texels."""

    @property
    def smooth(self) -> bool: ...

    def __call__(self, environment: Environment) -> np.ndarray: ...


@dataclass(frozen=True)
class Blurred:
    """The environment on an octahedral map, blurred to `solid_angle` steradians; see `prefiltered`."""

    solid_angle: float
    smooth: bool = False  # the texels are fine enough

    def __call__(self, environment: Environment) -> np.ndarray:
        return prefiltered(environment, self.solid_angle)


def octahedral_directions(texels: int) -> np.ndarray:
    """(texels, texels, 3): the unit direction of each texel's centre; rows along v, columns along u."""
    x, z = np.meshgrid(*(2 * (np.arange(texels) + 0.5) / texels - 1,) * 2)
    y = 1 - np.abs(x) - np.abs(z)
    fold = np.maximum(-y, 0)
    directions = np.stack([x - np.where(x >= 0, fold, -fold), y, z - np.where(z >= 0, fold, -fold)], axis=-1)
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def octahedral_uv(directions: np.ndarray) -> np.ndarray:
    """uv (..., 2) in [0, 1] of world-space `directions` (..., 3): `octahedralUv` in glsl/lib/octahedral.glsl."""
    directions = np.asarray(directions, np.float64)
    folded = directions[..., ::2] / np.abs(directions).sum(axis=-1, keepdims=True)
    signs = np.where(folded >= 0, 1.0, -1.0)
    below = (1 - np.abs(folded[..., ::-1])) * signs
    return 0.5 * np.where(directions[..., 1:2] < 0, below, folded) + 0.5


def prefiltered(environment: Environment, solid_angle: float) -> np.ndarray:
    """(n, n, 3) float32 radiance on an octahedral map, blurred by a lobe of `solid_angle` steradians; 0: sharp.

    The lobe is von Mises and Fisher's, exp(κ cosθ); the solid angle it takes up, 1 / ∫ f², is about 4π / κ. A constant
    environment stays exactly that.
    """
    if solid_angle <= 0:
        directions = octahedral_directions(SHARP_TEXELS)
        height, width = environment.radiance.shape[:2]
        u, v = np.moveaxis(uv_from_direction(directions), -1, 0)
        row = np.minimum((v * height).astype(int), height - 1)
        return environment.radiance[row, (u * width).astype(int) % width]
    sharpness = 4 * np.pi / solid_angle
    # four texels across the lobe, so that the nearest one is near enough
    texels = int(np.clip(4 * np.sqrt(sharpness), 8, SHARP_TEXELS))
    directions = octahedral_directions(texels).reshape(-1, 3)
    values, cells, solid_angles = averaged(environment.radiance, BLUR_CELLS)
    values, cells = values.reshape(-1, 3), cells.reshape(-1, 3)
    blurred = np.empty((len(directions), 3))
    for start in range(0, len(directions), 1024):  # bounds the matrix
        part = slice(start, start + 1024)
        weights = np.exp(sharpness * (directions[part] @ cells.T - 1)) * solid_angles.ravel()
        blurred[part] = weights @ values / weights.sum(axis=1, keepdims=True)
    return blurred.reshape(texels, texels, 3).astype(np.float32)
