"""Meshes for scenes made of code. All but `placed` and `in_range` build on one shape: the loft.

Every mesh is closed (two-manifold), in scene units, y up, with its normals outside; `material` is its surface.
"""

from collections.abc import Sequence

import numpy as np

from ..errors import ParameterError
from .camera import Vec3
from .mesh import Material, Mesh


def loft(
    rings: np.ndarray,
    material: Material,
    name: str = "loft",
    *,
    closed: bool = False,
    colors: np.ndarray | None = None,
) -> Mesh:
    """A skin over `rings` (R, P, 3), polygons of P points each, and a cap on the first and on the last.

    `closed` joins the last ring to the first, instead of the caps. Caps join point i with point P - 1 - i: right for
    convex rings and for ribbons (there along one edge and back along the other). `colors` (R, 3): linear, a ring each.
    """
    rings = np.asarray(rings, float)
    count, points = rings.shape[:2]
    index = np.arange(count * points).reshape(count, points)
    low, high = (index, np.roll(index, -1, axis=0)) if closed else (index[:-1], index[1:])
    quads = np.stack([low, np.roll(low, -1, axis=1), np.roll(high, -1, axis=1), high], axis=-1).reshape(-1, 4)
    faces = [quads[:, (0, 1, 2)], quads[:, (0, 2, 3)]]
    if not closed:
        cap = np.array(_ladder(points))
        faces += [cap[:, ::-1], cap + index[-1, 0]]
    triangles = np.concatenate(faces)
    vertices = rings.reshape(-1, 3)
    if _volume(vertices, triangles) < 0:
        triangles = triangles[:, ::-1]
    rgba = None if colors is None else np.insert(np.repeat(colors, points, axis=0), 3, 1, axis=1)
    return Mesh(vertices, triangles, colors=rgba, material=material, name=name)


def _ladder(points: int) -> list[tuple[int, int, int]]:
    """Triangles of a polygon, in strips between its two halves; fans would need a star-shaped one."""
    triangles, left, right = [], 0, points - 1
    while right - left > 1:
        triangles.append((left, left + 1, right))
        left += 1
        if right - left > 1:
            triangles.append((left, right - 1, right))
            right -= 1
    return triangles


def _volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = np.moveaxis((vertices - vertices.mean(axis=0))[faces], 1, 0)
    return float((np.cross(a, b) * c).sum()) / 6


def circle(points: int) -> np.ndarray:
    """(points, 2): x, z on the unit circle, from 45° on, where a square has a corner."""
    angle = np.pi / 4 + 2 * np.pi * np.arange(points) / points
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def square(points: int) -> np.ndarray:
    """(points, 2): x, z on the square of half width 1, at the angles of `circle`; points in fours have its corners."""
    return circle(points) / np.abs(circle(points)).max(axis=1, keepdims=True)


def rounded(width: float, depth: float, radius: float, points: int) -> np.ndarray:
    """(points, 2): x, z on a rectangle with round corners; `points` in fours."""
    corner = np.repeat([(1, 1), (-1, 1), (-1, -1), (1, -1)], points // 4, axis=0)
    quarter = np.linspace(0, np.pi / 2, points // 4)
    angle = np.concatenate([quarter + turn * np.pi / 2 for turn in range(4)])
    arc = radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return corner * (np.array([width, depth]) / 2 - radius) + arc


def ring(outline: np.ndarray, y: float) -> np.ndarray:
    """(P, 3): an outline (P, 2) of x and z at the height y."""
    return np.insert(outline, 1, y, axis=1)


def block(size: Vec3, material: Material, name: str = "block") -> Mesh:
    """A box of `size` that stands on y = 0, centred on x = z = 0."""
    width, height, depth = size
    outline = square(4) * (width / 2, depth / 2)
    return loft(np.array([ring(outline, 0), ring(outline, height)]), material, name)


def beam(section: Sequence[tuple[float, float]], length: float, material: Material, name: str = "beam") -> Mesh:
    """`section` (points y, z; see `loft` for which) drawn along x, from -length/2 to length/2."""
    ends = [np.insert(np.asarray(section, float), 0, x, axis=1) for x in (-length / 2, length / 2)]
    return loft(np.array(ends), material, name)


def lathe(profile: Sequence[tuple[float, float]], points: int, material: Material, name: str = "lathe") -> Mesh:
    """A turned piece: `profile` holds radius (> 0) and height, from the bottom to the top."""
    return loft(np.array([ring(circle(points) * radius, y) for radius, y in profile]), material, name)


def column(
    height: float,
    radius: float,
    material: Material,
    *,
    flutes: int = 20,
    finesse: int = 4,
    fluted: bool = True,
    square_ends: bool = True,
) -> Mesh:
    """A column that stands on y = 0: plinth, base, fluted shaft with entasis, echinus, abacus.

    `radius` is the shaft's at its foot; the plinth and the abacus, square or round, reach to 1.35 of it. `flutes` in
    fours; `finesse` is how many points a flute has, and rings a moulding. Without `fluted` the shaft is round.
    """
    points = flutes * finesse
    depth = 0.09 if fluted else 0.0  # of the radius: shallower than Doric
    hollow = depth * np.sin(np.pi * (np.arange(points) % finesse) / finesse)
    top = height / radius  # everything below in radii

    def outline(size: float, squareness: float = 0.0, fluting: float = 0.0) -> np.ndarray:
        shape = squareness * square(points) + (1 - squareness) * circle(points)
        return shape * (size * (1 - fluting * hollow[:, None]))

    def moulding(low: float, high: float, size: float, bulge: float) -> list[np.ndarray]:
        share = np.linspace(0, 1, finesse + 2)
        return [ring(outline(size + bulge * np.sin(np.pi * t)), low + (high - low) * t) for t in share]

    ends = float(square_ends)
    rings = [ring(outline(1.35, ends), 0.0), ring(outline(1.35, ends), 0.3)]
    rings += moulding(0.301, 0.62, 1.17, 0.15) + moulding(0.66, 0.78, 1.1, -0.04) + moulding(0.82, 1.04, 1.08, 0.1)
    for t in np.linspace(0, 1, 2 + 2 * finesse):
        fluting = np.clip(12 * min(t, 1 - t), 0, 1)
        rings.append(ring(outline(1 - 0.16 * t**1.7, 0, fluting), 1.12 + (top - 2.1) * t))
    rings += moulding(top - 0.96, top - 0.84, 0.86, 0.06)
    for t in np.linspace(0, 1, 2 + finesse):
        rings.append(ring(outline(0.86 + 0.42 * np.sin(t * np.pi / 2) ** 1.5), top - 0.8 + 0.46 * t))
    rings += [ring(outline(size, ends), y) for size, y in ((1.3, top - 0.32), (1.35, top - 0.28), (1.35, top))]
    return loft(np.array(rings) * radius, material, "column")


def placed(x: float, y: float, z: float, *, turn: float = 0.0, scale: Vec3 | float = 1.0) -> np.ndarray:
    """(4, 4) world_from_local: scaled, turned about +y (degrees, counter-clockwise from above), then moved."""
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) * np.broadcast_to(scale, 3)
    matrix[:3, 3] = x, y, z
    return matrix


def in_range(scene: str, **values: tuple[float, float, float]) -> None:
    """Check a scene's parameters, each given as (value, least, greatest). Raises `ParameterError`."""
    for name, (value, least, greatest) in values.items():
        if not least <= value <= greatest:  # false for NaN too
            raise ParameterError(f"scene '{scene}': {name} = {value} is outside [{least:g}, {greatest:g}]")
