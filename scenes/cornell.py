"""The Cornell box: one lamp, two coloured walls, and daylight through the open front.

The usual test scene for bounced light. Lessons: ambient occlusion darkens the corners and the gap between the blocks,
for ambient light reaches them only in part. The red and green of the walls bleed in the indirect bounce (SSDO 2009,
section 3.2), and an albedo near 1 shows creases that are too dark (ambient transfer 2009, Fig. 9). One unit is 10 cm.
The dimensions are those of the box at Cornell: https://www.graphics.cornell.edu/online/box/data.html
"""

from functools import cache

import numpy as np

from aolab import Camera, Environment, Instance, Material, Mesh, PointLight, Scene
from aolab.scene.shapes import block, in_range, loft, placed, ring

WIDTH, HEIGHT, DEPTH, WALL = 5.56, 5.488, 5.592, 0.2
LAMP = (1.3, 1.05)  # width, depth of the opening in the ceiling
WHITE = Material((0.73, 0.71, 0.66), name="white")
RED = Material((0.61, 0.05, 0.05), name="red")
GREEN = Material((0.12, 0.43, 0.1), name="green")
# published corners x, z on the floor (x increases to the left, z away from the viewer), and heights
SHORT = ((1.30, 0.65), (0.82, 2.25), (2.40, 2.72), (2.90, 1.14)), 1.65
TALL = ((4.23, 2.47), (2.65, 2.96), (3.14, 4.56), (4.72, 4.06)), 3.30


def cornell(lamp: float = 1.0, daylight: float = 1.0) -> Scene:
    in_range("cornell", lamp=(lamp, 0, 100), daylight=(daylight, 0, 100))
    bulb = PointLight((0, HEIGHT - 0.03, -DEPTH / 2), tuple(lamp * np.array((36.0, 28.0, 18.0))))
    return Scene(_room(), (bulb,), _front(daylight), Camera((0, 2.73, 8.0), (0, 2.73, 0), fov=39.5), name="cornell")


@cache
def _room() -> tuple[Instance, ...]:
    sunk = 0.01  # solids overlap by this depth, so that no two faces share a plane
    outer, middle, side = WIDTH + 2 * WALL, -(DEPTH + WALL) / 2, (WALL, HEIGHT + 2 * sunk, DEPTH + WALL)
    across = (WIDTH + WALL) / 2
    return (
        Instance(block((outer, WALL, side[2] + 2 * sunk), WHITE, "floor"), placed(0, -WALL, middle)),
        Instance(_ceiling(outer, side[2] + 2 * sunk), placed(0, HEIGHT, middle)),
        Instance(
            block((LAMP[0] + 0.2, WALL, LAMP[1] + 0.2), WHITE, "lid"), placed(0, HEIGHT + WALL - sunk, -DEPTH / 2)
        ),
        Instance(block((WIDTH + sunk, side[1], WALL), WHITE, "back wall"), placed(0, -sunk, -DEPTH - WALL / 2 + sunk)),
        Instance(block(side, RED, "left wall"), placed(-across, -sunk, middle)),
        Instance(block(side, GREEN, "right wall"), placed(across, -sunk, middle)),
        Instance(_standing(*SHORT, "short block")),
        Instance(_standing(*TALL, "tall block")),
    )


def _ceiling(width: float, depth: float) -> Mesh:
    """The ceiling, `WALL` thick, with the lamp's opening in the middle of the room."""
    corners = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) / 2
    rings = [
        [
            (x * width, 0, z * depth),
            (x * width, WALL, z * depth),
            (x * LAMP[0], WALL, z * LAMP[1] + WALL / 2),
            (x * LAMP[0], 0, z * LAMP[1] + WALL / 2),
        ]
        for x, z in corners
    ]
    return loft(np.array(rings), WHITE, "ceiling", closed=True)


def _standing(corners: tuple[tuple[float, float], ...], height: float, name: str) -> Mesh:
    outline = (WIDTH / 2, 0) - np.array(corners)
    return loft(np.array([ring(outline, -0.01), ring(outline, height)]), WHITE, name)


@cache
def _front(strength: float) -> Environment:
    """An environment with a soft bright window in front (+z), which lights the room, and a dim rest."""
    azimuth = 2 * np.pi * ((np.arange(64) + 0.5) / 64 - 0.5)
    polar = np.pi * (np.arange(32) + 0.5) / 32
    towards_front = -np.cos(azimuth) * np.sin(polar)[:, None]
    window = np.clip(towards_front, 0, 1)[..., None] ** 2 * (0.42, 0.47, 0.55)
    return Environment(strength * (window + np.array((0.05, 0.053, 0.06))), "open front")
