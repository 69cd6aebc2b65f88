"""Two rows of columns. A pink column is hidden behind the nearest column, exactly in line with the camera.

For SSDO 2009, Fig. 7. Lesson: a method that reads one depth layer misses the hidden column, although the column shades
the visible floor (Fig. 7, top) and reflects pink light onto it (bottom). Peeled layers, more cameras, voxels or rays
find the column. `hidden=False` removes it. No pixel of the column itself is visible: with one depth layer, only its
shadow is missing then.
"""

from functools import cache

import numpy as np

from aolab import Camera, DirectionalLight, Environment, Instance, Material, Scene
from aolab.scene.shapes import beam, block, column, in_range, placed

HEIGHT, RADIUS, SPACING, NAVE = 4.4, 0.36, 2.6, 4.4  # metres
EYE, FRONT = np.array((-4.9, 2.3, 4.8)), np.array((-NAVE / 2, 0, 0))  # the camera, and the hiding column
BEHIND = 1.6  # times the distance. The front shaft's least radius (0.84) × 1.6 covers the pink one's greatest (1.28)
MARBLE = Material((0.78, 0.74, 0.67), name="marble")
PAVING = Material((0.62, 0.57, 0.50), name="paving")
PINK = Material((0.84, 0.16, 0.40), name="pink")
SEA = Environment.sky((0.10, 0.20, 0.44), (0.40, 0.47, 0.54), (0.07, 0.13, 0.18))


def colonnade(count: int = 7, hidden: bool = True, sun_elevation: float = 34.0, fluted: bool = True) -> Scene:
    """`count` columns per row; `hidden` adds the pink column; `sun_elevation` in degrees; `fluted` or round shafts."""
    in_range("colonnade", count=(count, 2, 50), sun_elevation=(sun_elevation, 1, 90))
    elevation, azimuth = np.radians((sun_elevation, -125))  # from behind the camera, to its left
    towards = (np.cos(elevation) * np.sin(azimuth), np.sin(elevation), -np.cos(elevation) * np.cos(azimuth))
    sun = DirectionalLight(tuple(-np.array(towards)), (3.1, 2.25, 1.4))
    instances = _temple(count, fluted) + ((_pink(fluted),) if hidden else ())
    return Scene(instances, (sun,), SEA, Camera(tuple(EYE), (-1.75, 2.05, 0), fov=49), name="colonnade")


@cache
def _temple(count: int, fluted: bool) -> tuple[Instance, ...]:
    shaft = column(HEIGHT, RADIUS, MARBLE, fluted=fluted)
    length = (count - 1) * SPACING
    lintel = beam(_entablature(), length + 4 * RADIUS, MARBLE, "entablature")
    temple = []
    for step in range(3):
        size = (NAVE + 2.2 + 0.8 * step, 0.24, length + 2.2 + 0.8 * step)
        temple.append(Instance(block(size, PAVING, "step"), placed(0, -0.24 - 0.22 * step, -length / 2)))
    for side in (-1, 1):
        temple += [Instance(shaft, placed(side * NAVE / 2, -0.01, -i * SPACING)) for i in range(count)]
        temple.append(Instance(lintel, placed(side * NAVE / 2, HEIGHT - 0.02, -length / 2, turn=90)))
    return tuple(temple)


@cache
def _pink(fluted: bool) -> Instance:
    x, _, z = EYE + BEHIND * (FRONT - EYE)
    return Instance(column(HEIGHT - 0.6, RADIUS, PINK, square_ends=False, fluted=fluted), placed(x, -0.01, z), "hidden")


def _entablature() -> list[tuple[float, float]]:
    """The section of the entablature (architrave in two steps, frieze, cornice): height, signed half width."""
    half = [(0, 0.42), (0.22, 0.43), (0.225, 0.46), (0.42, 0.47), (0.46, 0.52), (0.50, 0.53), (0.505, 0.45)]
    half += [(0.86, 0.46), (0.94, 0.56), (0.945, 0.68), (1.08, 0.70), (1.16, 0.78), (1.20, 0.79)]
    return [(y, -z) for y, z in half] + half[::-1]
