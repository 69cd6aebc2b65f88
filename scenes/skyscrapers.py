"""A city of towers under a blue sky and a low yellow sun.

For S3HO 2012, Fig. 6. Lesson: with directional occlusion the side of a tower that faces away from the sun has a dark
blue shadow, the side towards the sun hardly any; plain occlusion gives the same grey on all sides. The streets are
narrow compared with the towers' height, so the effect of the radius shows: a small radius darkens the kerbs, a large
radius whole streets. One unit is ten metres. The same `seed` gives the same city.
"""

from functools import cache

import numpy as np

from aolab import Camera, DirectionalLight, Environment, Instance, Material, Mesh, Scene
from aolab.scene.shapes import in_range, loft, placed, ring, square

BLOCK, STREET, STOREY = 2.0, 0.8, 0.34
GLASS = (0.62, 0.68, 0.76)  # factor on the wall's albedo
WALLS = ((0.72, 0.70, 0.66), (0.62, 0.60, 0.57), (0.70, 0.63, 0.54), (0.55, 0.57, 0.60), (0.66, 0.52, 0.44))
ASPHALT, PAVEMENT = Material((0.30, 0.30, 0.31), name="asphalt"), Material((0.56, 0.55, 0.53), name="pavement")
SKY = Environment.sky((0.08, 0.18, 0.50), (0.36, 0.50, 0.74), (0.24, 0.33, 0.48))


def skyscrapers(seed: int = 7, blocks: int = 8, sun_elevation: float = 30.0, sun_azimuth: float = 82.0) -> Scene:
    """`sun_azimuth` and `sun_elevation` in degrees; the azimuth is measured from -z towards +x."""
    in_range("skyscrapers", seed=(seed, 0, 2**32 - 1), blocks=(blocks, 1, 32), sun_elevation=(sun_elevation, 1, 90))
    in_range("skyscrapers", sun_azimuth=(sun_azimuth, -360, 360))
    elevation, azimuth = np.radians((sun_elevation, sun_azimuth))
    towards = (np.cos(elevation) * np.sin(azimuth), np.sin(elevation), -np.cos(elevation) * np.cos(azimuth))
    sun = DirectionalLight(tuple(-np.array(towards)), (4.9, 3.4, 1.4))
    side = blocks * (BLOCK + STREET)
    camera = Camera((0.46 * side, 0.29 * side, 0.58 * side), (-0.02 * side, 0.085 * side, -0.02 * side), fov=34)
    return Scene(_city(seed, blocks), (sun,), SKY, camera, name="skyscrapers")


@cache
def _city(seed: int, blocks: int) -> tuple[Instance, ...]:
    random = np.random.default_rng(seed)
    pitch = BLOCK + STREET
    side = blocks * pitch
    city = [Instance(_tower(1, ASPHALT), placed(0, -0.3, 0, scale=(side, 0.3, side)), "ground")]
    for row, column in np.ndindex(blocks, blocks):
        x, z = ((index - (blocks - 1) / 2) * pitch for index in (column, row))
        city.append(
            Instance(_tower(1, PAVEMENT), placed(x, -0.01, z, scale=(BLOCK + 0.2, 0.06, BLOCK + 0.2)), "pavement")
        )
        centrality = 1 - np.hypot(x, z) / side  # the towers of the centre are taller
        for plot_x, plot_z, width, depth in _plots(random):
            height = float(np.clip(random.lognormal(0.7, 0.5) * 2.3 * centrality**1.8, 0.7, 6.5))
            city += _building(random, x + plot_x, z + plot_z, width, depth, height)
    return tuple(city)


def _plots(random: np.random.Generator) -> list[tuple[float, float, float, float]]:
    """Centre x, z, width and depth of each tower of a block, which has one, two or four towers."""
    gap = 0.12
    half, whole, quarter = (BLOCK - gap) / 2, BLOCK, (BLOCK + gap) / 4
    kind = random.integers(4)
    if kind == 0:
        return [(0, 0, whole, whole)]
    if kind == 1:
        return [(-quarter, 0, half, whole), (quarter, 0, half, whole)]
    if kind == 2:
        return [(0, -quarter, whole, half), (0, quarter, whole, half)]
    return [(sx * quarter, sz * quarter, half, half) for sx in (-1, 1) for sz in (-1, 1)]


def _building(
    random: np.random.Generator, x: float, z: float, width: float, depth: float, height: float
) -> list[Instance]:
    """A tower of up to three stacked parts, each narrower than the part below, and a plant room on the roof."""
    material = _wall(int(random.integers(len(WALLS))))
    parts, bottom = [], 0.03
    setbacks = int(random.integers(1, 4)) if height > 2.5 else 1
    for level in range(setbacks):
        part = height * (0.5, 0.3, 0.2)[level] if setbacks > 1 else height
        storeys = max(1, round(part / STOREY))
        parts.append(Instance(_tower(storeys, material), placed(x, bottom, z, scale=(width, part, depth))))
        bottom += part - 0.01
        width, depth = width * 0.74, depth * 0.74
    offset = random.uniform(-0.12, 0.12, 2) * (width, depth)
    plant = placed(x + offset[0], bottom, z + offset[1], scale=(width * 0.5, 0.22, depth * 0.45))
    return [*parts, Instance(_tower(1, material), plant)]


@cache
def _wall(index: int) -> Material:
    return Material(WALLS[index], name="wall")


@cache
def _tower(storeys: int, material: Material) -> Mesh:
    """A unit box, to be scaled when placed, with a parapet and a band of glass for each storey."""
    if storeys == 1:
        return loft(np.array([ring(square(4) / 2, 0), ring(square(4) / 2, 1)]), material, "slab")
    floors = np.arange(storeys)[:, None] / storeys
    sill = 0.35 / storeys
    # a storey is a flush parapet and a band of glass that is set back
    half = np.tile((0.5, 0.5, 0.488, 0.488), storeys)
    height = (floors + np.array((0, sill, sill, 1 / storeys))).ravel()
    rings = [ring(square(4) * size, y) for size, y in zip([*half, 0.5, 0.5], [*height, 1, 1 + sill], strict=True)]
    colors = [*[(1, 1, 1), (1, 1, 1), GLASS, GLASS] * storeys, (1, 1, 1), (1, 1, 1)]
    return loft(np.array(rings), material, "tower", colors=np.array(colors))
