"""A wall with a carved relief that exists only in a height map, and two columns before it.

For ambient transfer 2009, Fig. 9, whose carved object is checked "using the displacement map of the surface rather than
the z-buffer". Lessons: the depth buffer holds a flat wall, and finds the shadow of the columns alone; the height map
brings the shading of the carving (`occluders="height"`). With `carved`, the carving is geometry, for rays.
"""

from functools import cache

import numpy as np

from aolab import Camera, DirectionalLight, Environment, HeightMap, Instance, Material, Mesh, Scene
from aolab.scene.shapes import block, column, in_range, placed

WIDTH, HEIGHT, DEEP = 4.0, 2.25, 0.09  # of the wall; of the relief
TEXELS = 256  # of the map, in u; the carved wall has as many quads
STONE = (0.6, 0.3, 0.3)  # "The average albedo of the texture of the carved object", section 6
SKY = Environment.sky(zenith=(0.5, 0.55, 0.62), horizon=(0.75, 0.75, 0.72), ground=(0.3, 0.27, 0.24))


def relief(depth: float = 1.0, carved: bool = False) -> Scene:
    in_range("relief", depth=(depth, 0, 4))
    ground = Instance(block((12.0, 0.3, 8.0), Material((0.5, 0.45, 0.4)), "ground"), placed(0, -0.3, 2.0))
    stones = [Instance(_column(), placed(x, -0.01, 0.55)) for x in (-1.35, 1.35)]
    sun = DirectionalLight((0.8, -0.7, -0.9), (0.9, 0.85, 0.75))
    camera = Camera((0.9, 1.5, 3.4), (0, 1.05, 0), fov=44)
    return Scene((Instance(_wall(depth, carved)), ground, *stones), (sun,), SKY, camera, name="relief")


@cache
def _column() -> Mesh:
    return column(2.0, 0.13, Material((0.62, 0.58, 0.52)), flutes=12, finesse=3)


@cache
def _wall(depth: float, carved: bool) -> Mesh:
    """The plane z = 0, its uv over the whole; carved, a grid with the map's heights in z."""
    heights = depth * _carving()
    rows, columns = heights.shape
    material = Material(STONE, name="stone") if carved else Material(STONE, height=HeightMap(heights, "carving"))
    u, v = np.meshgrid((np.arange(columns) + 0.5) / columns, 1 - (np.arange(rows) + 0.5) / rows)
    z = heights
    if not carved:
        (u, v), z = np.meshgrid((0.0, 1.0), (1.0, 0.0)), np.zeros((2, 2))
    vertices = np.stack([(u - 0.5) * WIDTH, v * HEIGHT, z], axis=-1).reshape(-1, 3)
    index = np.arange(u.size).reshape(u.shape)
    a, b, c, d = index[1:, :-1], index[1:, 1:], index[:-1, 1:], index[:-1, :-1]
    quads = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    uv = np.stack([u, v], axis=-1).reshape(-1, 2)
    return Mesh(vertices, quads, uv=uv, material=material, name="wall", crease=60.0)


def _carving() -> np.ndarray:
    """(rows, TEXELS) heights in scene units: bricks with round joints, and a sun of rings and rays cut into them."""
    rows = round(TEXELS * HEIGHT / WIDTH)
    x, y = np.meshgrid((np.arange(TEXELS) + 0.5) / TEXELS * WIDTH, HEIGHT - (np.arange(rows) + 0.5) / rows * HEIGHT)
    course = np.floor(y / 0.25)
    joint = np.minimum(_off_middle((x + 0.25 * (course % 2)) / 0.5) * 0.5, _off_middle(y / 0.25) * 0.25)
    bricks = np.clip(joint / 0.035, 0, 1)
    radius, angle = np.hypot(x - WIDTH / 2, y - 1.15), np.arctan2(y - 1.15, x - WIDTH / 2)
    rings = 0.5 + 0.5 * np.cos(2 * np.pi * radius / 0.24)
    rays = 0.5 + 0.5 * np.cos(12 * angle)
    sun = np.where(radius < 0.36, rings, np.maximum(rays, 0.35 * rings))
    inside = np.clip((0.85 - radius) / 0.05, 0, 1)
    return DEEP * (bricks * (1 - inside) + sun * inside)


def _off_middle(cells: np.ndarray) -> np.ndarray:
    """The distance from the nearest edge of a cell, in cells."""
    return 0.5 - np.abs(cells - np.floor(cells) - 0.5)
