"""An environment as a set of lights from far away."""

import numpy as np

from ..maths.cells import equal_energy_cells
from .environment import Environment, averaged

LUMINANCE = np.array((0.2126, 0.7152, 0.0722))  # of linear sRGB (ITU-R BT.709)
LEAST_ROWS = 64  # a coarser map is repeated to so many rows, so that it can be cut into 256 cells


def environment_lights(environment: Environment, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions (n, 3) to lights in world space, unit, and what each sends, (n, 3): ∫ L dω over its cell.

    There are up to `count` cells of nearly the same energy, the luminance times the solid angle (Debevec 2005), each
    with its light at the energy's centroid. The sum of all lights is the whole environment's.
    """
    radiance = environment.radiance
    times = -(-LEAST_ROWS // len(radiance))
    values, directions, solid_angles = averaged(radiance.repeat(times, axis=0).repeat(times, axis=1))
    flux = values * solid_angles[..., None]
    energy = np.maximum(flux @ LUMINANCE, 1e-12 * flux.sum(axis=-1))  # blue alone counts, too
    rows = len(energy)
    widths = np.sin(np.pi * (np.arange(rows) + 0.5) / rows) * 2 * rows / energy.shape[1]
    towards, sent = [], []
    for top, bottom, left, right in equal_energy_cells(energy, count, widths):
        part = np.s_[top:bottom, left:right]
        centroid = (energy[part][..., None] * directions[part]).sum(axis=(0, 1))
        length = np.linalg.norm(centroid)
        middle = directions[(top + bottom) // 2, (left + right) // 2]
        towards.append(centroid / length if length > 0 else middle)
        sent.append(flux[part].sum(axis=(0, 1)))
    return np.reshape(towards, (-1, 3)), np.reshape(sent, (-1, 3))
