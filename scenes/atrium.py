"""A courtyard of two storeys of arcades, with curtains, a fountain, and the sun in one corner.

The large scene, in the style of Sponza. It stands for the large scenes of the papers: SSDO 2009, Fig. 1 (537k
triangles), S3HO 2012, Fig. 9, HAO 2009, Fig. 7. Lessons: details of every size (dentils, balusters, flutes, arches,
aisles) show the effect of the radius, and curtains in strong colours show the bounce. `detail`, from 1 to 4, adds
triangles, not shapes.
"""

from functools import cache

import numpy as np

from aolab import Camera, DirectionalLight, Environment, Instance, Material, Mesh, Scene, Texture
from aolab.scene.shapes import block, column, in_range, lathe, loft, placed

BAY, LONG, SHORT, AISLE, THICK = 3.6, 7, 2, 3.2, 0.6  # bay width (m); bays along x, z; aisle depth; wall thickness
LENGTH, WIDTH = LONG * BAY, SHORT * BAY
LOWER, SPRING, UPPER, SPRING_2, EAVES = 0.0, 3.4, 5.8, 8.2, 10.3  # heights of the floors and springing lines
ARCH, ARCH_2 = 1.42, 1.5  # radii of the arches
SIDES = (
    (0, LONG, WIDTH / 2),
    (90, SHORT, LENGTH / 2),
    (180, LONG, WIDTH / 2),
    (270, SHORT, LENGTH / 2),
)  # rotation in degrees, number of bays, distance from the centre

STONE, PLASTER = Material((0.68, 0.54, 0.37), name="sandstone"), Material((0.74, 0.60, 0.42), name="plaster")
MARBLE, TERRACOTTA = Material((0.76, 0.73, 0.67), name="marble"), Material((0.56, 0.24, 0.12), name="terracotta")
WATER, LEAVES = Material((0.10, 0.30, 0.33), name="water"), Material((0.12, 0.26, 0.07), name="leaves")
DADO_RED = Material((0.40, 0.11, 0.06), name="dado")
CLOTH = tuple(Material(rgb, name="cloth") for rgb in ((0.50, 0.03, 0.03), (0.04, 0.22, 0.07), (0.03, 0.08, 0.36)))

SKY = Environment.sky((0.17, 0.34, 0.75), (0.46, 0.43, 0.40), (0.26, 0.19, 0.12))

# fmt: off
# sections: distance from the columns' line towards the court, height
BACK = -AISLE - 0.1
GALLERY = (BACK, -0.42), (0.34, -0.42), (0.34, -0.34), (0.40, -0.26), (0.47, -0.12), (0.54, -0.10), (0.54, 0), (BACK, 0)
ROOF = (BACK, -0.12), (0.34, -0.12), (0.36, -0.02), (0.46, 0.12), (0.60, 0.16), (0.72, 0.30), (0.72, 0.40), (BACK, 0.9)
DADO = (BACK, 0), (0.18 + BACK, 0), (0.18 + BACK, 1.2), (0.23 + BACK, 1.22), (0.23 + BACK, 1.3), (BACK, 1.3)
RAIL = (-0.12, 0), (0.12, 0), (0.14, 0.03), (0.14, 0.09), (0.09, 0.13), (-0.09, 0.13), (-0.14, 0.09), (-0.14, 0.03)
SILL = (-0.12, 0), (0.12, 0), (0.12, 0.08), (-0.12, 0.08)
# surfaces of revolution: radius, height
BASIN = (1.5, 0), (1.5, 0.12), (1.42, 0.16), (1.42, 0.42), (1.5, 0.46), (1.5, 0.56), (1.28, 0.56), (1.28, 0.2)
STEM = ((0.34, 0), (0.34, 0.5), (0.16, 0.62), (0.13, 0.9), (0.2, 1.12), (0.12, 1.2), (0.45, 1.32), (0.66, 1.46),
        (0.7, 1.56), (0.64, 1.56), (0.4, 1.42), (0.09, 1.4), (0.07, 1.7), (0.13, 1.78), (0.03, 1.92))
POT = (0.24, 0), (0.3, 0.1), (0.4, 0.5), (0.44, 0.52), (0.44, 0.62), (0.36, 0.62), (0.34, 0.5)
# curtains: share of the height, width, depth of the folds; tied at a third of the height
GATHERED = (0, 0.62, 0.07), (0.33, 0.26, 0.05), (0.37, 0.25, 0.05), (0.7, 0.8, 0.06), (1, 1.43, 0.045)
# fmt: on


def atrium(detail: int = 2, sun_elevation: float = 62.0, sun_azimuth: float = 58.0) -> Scene:
    """`detail` from 1 to 4. The sun's angles are in degrees, its azimuth from the camera's direction (+x) to +z."""
    in_range("atrium", detail=(detail, 1, 4), sun_elevation=(sun_elevation, 1, 90))
    in_range("atrium", sun_azimuth=(sun_azimuth, -360, 360))
    elevation, azimuth = np.radians((sun_elevation, sun_azimuth))
    towards = np.array((np.cos(elevation) * np.cos(azimuth), np.sin(elevation), np.cos(elevation) * np.sin(azimuth)))
    sun = DirectionalLight(tuple(-towards), (6.6, 5.0, 3.1))
    camera = Camera((-11.3, 2.7, 1.5), (0, 3.65, -0.55), fov=58, near=0.1)
    return Scene(_building(detail), (sun,), SKY, camera, name="atrium")


@cache
def _building(detail: int) -> tuple[Instance, ...]:
    return (*_shell(), *_arcades(detail), *_mouldings(detail), *_curtains(detail), *_court(detail))


def _shell() -> list[Instance]:
    """The floor, the outer walls of the aisles, and two slabs with cornices, open above the court."""
    length, width = LENGTH + 2 * AISLE, WIDTH + 2 * AISLE
    across, along = block((0.4, 11.4, width), PLASTER, "wall"), block((length + 0.79, 11.39, 0.4), PLASTER, "wall")
    shell = [Instance(_floor(length, width))]
    for side in (-1, 1):
        shell.append(Instance(across, placed(side * (length / 2 + 0.2), -0.1, 0)))
        shell.append(Instance(along, placed(0, -0.11, side * (width / 2 + 0.2))))
    slabs = (
        (GALLERY, STONE, UPPER),
        (ROOF, STONE, EAVES),
        (DADO, DADO_RED, LOWER - 0.01),
        (DADO, DADO_RED, UPPER - 0.01),
    )
    return [*shell, *(Instance(_around(section, material), placed(0, y, 0)) for section, material, y in slabs)]


def _arcades(detail: int) -> list[Instance]:
    """The columns and arched walls of both storeys, around the court."""
    below = column(SPRING, 0.31, STONE, flutes=4 + 4 * detail, finesse=detail)
    above = column(SPRING_2 - UPPER, 0.2, MARBLE, flutes=8, finesse=detail)
    parts = []
    for x, z in ((x, z) for x in _stops(LONG) for z in _stops(SHORT)):
        if abs(x) == LENGTH / 2 or abs(z) == WIDTH / 2:
            parts += [Instance(below, placed(x, LOWER - 0.01, z)), Instance(above, placed(x, UPPER - 0.01, z))]
    for y, radius, top in ((SPRING, ARCH, UPPER - 0.4), (SPRING_2, ARCH_2, EAVES - 0.1)):
        # the short walls fit between the long walls
        walls = {
            LONG: _arches(LONG, radius, top - y + 0.02, THICK / 2, detail),
            SHORT: _arches(SHORT, radius, top - y + 0.01, 0.02 - THICK / 2, detail),
        }
        band = _archivolt(radius, detail)
        for turn, bays, away in SIDES:
            side = placed(0, y - 0.005, 0, turn=turn)
            parts.append(Instance(walls[bays], side @ placed(0, 0, -away)))
            parts += _row(band, side, _stops(bays)[:-1] + BAY / 2, 0, THICK / 2 - away)
    return parts


def _mouldings(detail: int) -> list[Instance]:
    """The dentils below both cornices, and the balustrade of the gallery."""
    belly = [(0.05 + 0.035 * np.sin(np.pi * t) - 0.02 * t, 0.1 + 0.5 * t) for t in np.linspace(0, 1, 1 + 2 * detail)]
    turned = [(0.075, 0), (0.075, 0.06), (0.045, 0.08), *belly, (0.055, 0.62), (0.075, 0.65), (0.075, 0.72)]
    baluster, dentil = lathe(turned, 6 + 2 * detail, MARBLE, "baluster"), block((0.14, 0.16, 0.16), STONE, "dentil")
    parts = [Instance(_around(RAIL, MARBLE), placed(0, UPPER + 0.78, 0))]
    parts += [Instance(_around(SILL, MARBLE), placed(0, UPPER - 0.01, 0))]
    for turn, bays, away in SIDES:
        side, reach = placed(0, 0, 0, turn=turn), bays * BAY / 2 - THICK / 2 - 0.2
        for start in _stops(bays)[:-1]:
            parts += _row(baluster, side, start + np.linspace(0.45, BAY - 0.45, 9), UPPER + 0.065, -away)
        for y in (UPPER - 0.57, EAVES - 0.27):
            parts += _row(dentil, side, np.linspace(-reach, reach, round(reach / 0.15)), y, 0.36 - away)
    return parts


def _row(mesh: Mesh, side: np.ndarray, at: np.ndarray, y: float, z: float) -> list[Instance]:
    """Instances of a mesh at each x of `at`, in the coordinates of the court's side `side`."""
    return [Instance(mesh, side @ placed(x, y, z)) for x in at]


def _curtains(detail: int) -> list[Instance]:
    """A pair of curtains in every arch of the long sides, gathered to the columns; the colours alternate."""
    meshes, pairs = [_curtain(material, detail) for material in CLOTH], []
    for side in (-1, 1):
        for bay, x in enumerate(_stops(LONG)[:-1]):
            mesh, z = meshes[(bay + (side > 0)) % 3], side * WIDTH / 2
            pairs.append(Instance(mesh, placed(x, 0.02, z)))
            pairs.append(Instance(mesh, placed(x + BAY, 0.02, z, scale=(-1, 1, 1))))
    return pairs


def _curtain(material: Material, detail: int) -> Mesh:
    """A curtain from a column (x = 0) half across its bay: two sheets, 24 mm apart, with the same folds."""
    across, thickness, rings = np.linspace(0, 1, 9 + 8 * detail), np.array((0, 0, 0.024)), []
    share, *sizes = np.array(GATHERED).T
    for y in np.linspace(0, 1, 5 + 4 * detail):
        width, depth = (np.interp(y, share, size) for size in sizes)
        folds = depth * np.sin(2 * np.pi * (5 * across + 0.08 * np.sin(5 * y)))
        front = np.stack([0.36 + width * across, np.full_like(across, y * (SPRING - 0.05)), folds], axis=-1)
        rings.append(np.concatenate([front + thickness / 2, (front - thickness / 2)[::-1]]))
    return loft(np.array(rings), material, "curtain")


def _court(detail: int) -> list[Instance]:
    """The fountain, and the pots with round bushes."""
    points = 12 + 12 * detail
    polar = np.linspace(0.04, np.pi - 0.04, 6 + 6 * detail)
    ball = [(0.5 * np.sin(a) * (1 + 0.03 * np.sin(9 * a)), 0.9 - 0.5 * np.cos(a)) for a in polar]
    pot, bush = lathe(POT, points, TERRACOTTA, "pot"), lathe(ball, points, LEAVES, "bush")
    water = lathe([(1.3, 0.3), (1.3, 0.44)], points, WATER, "water")
    fountain = (lathe(BASIN, points, MARBLE, "basin"), lathe(STEM, points, MARBLE, "fountain"), water)
    parts = [Instance(mesh, placed(0, -0.01, 0)) for mesh in fountain]
    for x in np.array((-1.5, -0.5, 0.5, 1.5)) * BAY:
        for z in (-2.45, 2.45):
            parts += [Instance(pot, placed(x, -0.01, z)), Instance(bush, placed(x, 0, z))]
    return parts


def _stops(bays: int) -> np.ndarray:
    """Positions of the columns along a side, from its middle."""
    return (np.arange(bays + 1) - bays / 2) * BAY


def _arches(bays: int, radius: float, top: float, overhang: float, detail: int) -> Mesh:
    """A wall along x, `THICK` thick and `top` high, with half circles cut out of its lower edge."""
    angle = np.linspace(np.pi, 0, 8 * detail + 1)
    end, half = bays * BAY / 2 + overhang, THICK / 2
    below = [(-end, 0.0)]
    for middle in _stops(bays)[:-1] + BAY / 2:
        below += [(middle + radius * np.cos(a), radius * np.sin(a)) for a in angle]
    below.append((end, 0.0))
    rings = [[(x, y, -half), (x, top, -half), (x, top, half), (x, y, half)] for x, y in below]
    return loft(np.array(rings), PLASTER, "arches")


def _archivolt(radius: float, detail: int) -> Mesh:
    """The moulding around an arch. It projects from the wall's face, the plane z = 0."""
    section = [(-0.015, -0.1), (-0.015, 0.05), (0.10, 0.05), (0.12, 0.08), (0.24, 0.08), (0.24, -0.1)]  # radius, z
    angles = np.linspace(0, np.pi, 8 * detail + 1)
    rings = [[((radius + out) * np.cos(a), (radius + out) * np.sin(a), z) for out, z in section] for a in angles]
    return loft(np.array(rings), STONE, "archivolt")


def _around(section: tuple[tuple[float, float], ...], material: Material) -> Mesh:
    """A moulding: `section` extruded around the court."""
    corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    rings = [[(x * (LENGTH / 2 - out), y, z * (WIDTH / 2 - out)) for out, y in section] for x, z in corners]
    return loft(np.array(rings), material, "moulding", closed=True)


def _floor(length: float, width: float) -> Mesh:
    """A floor of flagstones in two colours, a quarter of a bay each, with small random differences."""
    random, pixels, side = np.random.default_rng(1), 32, BAY / 4
    rows, columns = round(width / side) + 1, round(length / side) + 1
    dark = np.add.outer(np.arange(rows), np.arange(columns)) % 2
    tone = np.where(dark[..., None], (150, 118, 92), (206, 186, 156)) * random.uniform(0.92, 1.06, (rows, columns, 1))
    image = np.repeat(np.repeat(tone, pixels, axis=0), pixels, axis=1)
    joint = np.arange(max(image.shape)) % pixels == 0
    image[joint[: len(image)]] *= 0.7
    image[:, joint[: image.shape[1]]] *= 0.7
    rgba = np.dstack([image, np.full(image.shape[:2], 255)]).clip(0, 255).astype(np.uint8)
    flags = Material((0.95, 0.95, 0.95), Texture(rgba, "flags"), name="flags")
    slab = block((length, 0.3, width), Material(), "floor")
    uv = slab.vertices[:, (0, 2)] / (columns * side, rows * side) + 0.5
    return Mesh(slab.vertices - np.array((0, 0.3, 0)), slab.faces, slab.normals, uv, material=flags, name="floor")
