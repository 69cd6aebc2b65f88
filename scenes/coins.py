"""Coins and a marble on a table under a low sun: details that a shadow map loses at their contact.

For SSDO 2009, Fig. 9 to 12. Lesson: a shadow map needs a bias, and a shadow that is shorter than the bias vanishes.
The texels of the sun's map are wider than half a coin is thick, so that flat coins seem to float and the marble loses
its foot. Samples on the screen find these shadows again (`fill=16`). One unit is 1 cm.
"""

from functools import cache

import numpy as np

from aolab import Camera, DirectionalLight, Environment, Instance, Material, Mesh, Scene
from aolab.scene.shapes import block, in_range, lathe, placed

TABLE = Material((0.62, 0.5, 0.38), name="wood")
COPPER, SILVER = Material((0.72, 0.4, 0.24), name="copper"), Material((0.62, 0.62, 0.6), name="silver")
GLAZE = Material((0.12, 0.3, 0.6), name="glaze")
SKY = Environment.sky(zenith=(0.25, 0.3, 0.4), horizon=(0.5, 0.52, 0.55), ground=(0.2, 0.18, 0.15))
SIZE, THICKNESS = 50.0, 0.2  # side of the table; a coin's thickness
# x, z, coins one above the other, silver or copper
PILES = ((-2.6, -1.4, 7, True), (0.4, -2.2, 3, False), (2.9, -0.6, 5, True), (-0.9, 1.2, 1, False), (1.6, 1.9, 1, True),
         (-3.6, 2.2, 1, True), (4.4, 2.6, 2, False), (-1.4, 4.0, 1, False))  # fmt: skip
MARBLE = (0.0, 0.85, 3.1)


def coins(sun_elevation: float = 28.0, count: int = len(PILES)) -> Scene:
    in_range("coins", sun_elevation=(sun_elevation, 5, 90), count=(count, 1, len(PILES)))
    angle = np.radians(sun_elevation)
    sun = DirectionalLight((np.cos(angle), -np.sin(angle), 0.25 * np.cos(angle)), (3.2, 2.9, 2.4))
    camera = Camera((1.0, 7.5, 13.0), (0.2, 0.1, 0.7), fov=38)
    return Scene(_table(count), (sun,), SKY, camera, name="coins")


@cache
def _table(count: int) -> tuple[Instance, ...]:
    placements = [Instance(block((SIZE, 2.0, SIZE), TABLE, "table"), placed(0, -2.0, 0))]
    silver, copper = _coin(1.15, SILVER), _coin(0.95, COPPER)
    for number, (x, z, height, is_silver) in enumerate(PILES[:count]):
        for level in range(height):
            shift = 0.09 * np.array((np.cos(2.4 * level + number), np.sin(2.4 * level + number)))
            where = placed(x + shift[0], level * THICKNESS - 0.001 * (level == 0), z + shift[1])
            placements.append(Instance(silver if is_silver else copper, where))
    return (*placements, Instance(_marble(), placed(*MARBLE)))


def _coin(radius: float, material: Material) -> Mesh:
    """A disc with a raised rim."""
    profile = [(radius - 0.02, 0.0), (radius, 0.02), (radius, THICKNESS - 0.02), (radius - 0.02, THICKNESS)]
    inside = [(radius - 0.12, THICKNESS), (radius - 0.14, THICKNESS - 0.03), (0.05, THICKNESS - 0.03)]
    return lathe(profile + inside, 48, material, "coin")


def _marble() -> Mesh:
    angle = np.linspace(0.02, np.pi - 0.02, 33)
    profile = [(0.86 * np.sin(a), -0.86 * np.cos(a)) for a in angle]
    return lathe(profile, 64, GLAZE, "marble")
