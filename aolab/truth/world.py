"""The scene as rays meet it: triangles, their materials, and the holes of cut-out textures."""

from functools import cached_property

import numpy as np

from ..pictures.images import linear_from_srgb
from ..scene.mesh import Texture
from ..scene.scene import Instance, Scene
from .casters import Engine, Hits, caster

# Origins are lifted off their surface by this many units in the last place of the scene's extent. Embree works in
# float32: a vertex and an origin are each rounded by half a unit, their difference spans up to two extents, and the
# distance to the plane is a sum of three products of it: about ten units. Measured on 200 random planes: 4 suffice.
LIFT_ULPS = 16


class World:
    """Triangles of a scene. Coordinates are world space, moved so that `centre` is 0, where float32 is finest."""

    def __init__(self, scene: Scene, engine: Engine = "auto") -> None:
        self.centre = scene.bounds.mean(axis=0)  # (3,) float64, world space
        self.corners = (scene.world_triangles() - self.centre).astype(np.float32)  # (t, 3, 3)
        self.lift = float(LIFT_ULPS * np.finfo(np.float32).eps * np.abs(self.corners).max())  # scene units
        self._caster = caster(engine, self.corners)
        self._surface = _Surfaces(scene.instances)

    @cached_property
    def normals(self) -> np.ndarray:
        """(t, 3) float32: the triangles' own unit normals, by their winding."""
        corner = self.corners.astype(np.float64)
        normals = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        # only rounding can hit a triangle that is degenerate in float32; any direction will do
        return (normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)).astype(np.float32)

    def occluded(self, origins: np.ndarray, directions: np.ndarray, limit: np.ndarray | float) -> np.ndarray:
        """(n,) bool: whether a surface is nearer than `limit`."""
        if not self._surface.has_holes:
            return self._caster.occluded(origins, directions, limit)
        return self.first_hit(origins, directions, limit).triangle >= 0

    def first_hit(self, origins: np.ndarray, directions: np.ndarray, limit: np.ndarray | float) -> Hits:
        """The nearest surface along each ray. Holes of cut-out textures and backs of single-sided surfaces are none."""
        hits = self._caster.first_hit(origins, directions, limit)
        if not self._surface.has_holes:
            return hits
        limits = np.broadcast_to(np.asarray(limit, np.float32), len(origins))
        rays = self._holes(hits, directions)
        while len(rays):
            passed = hits.distance[rays] + np.float32(self.lift)
            start = origins[rays] + directions[rays] * passed[:, None]
            further = self._caster.first_hit(start, directions[rays], np.maximum(limits[rays] - passed, 0))
            for known, new in zip(hits, (further.distance + passed, *further[1:]), strict=True):
                known[rays] = new
            rays = rays[self._holes(further, directions[rays])]
        return hits

    def _holes(self, hits: Hits, directions: np.ndarray) -> np.ndarray:
        """Indices of the hits where a ray meets nothing: a hole, or the back of a surface that has none."""
        hole = self._surface.in_hole(hits)
        one_sided = self._surface.front[hits.triangle.clip(0)]
        from_behind = (self.normals[hits.triangle.clip(0)] * directions).sum(axis=1) * one_sided > 0
        hole[from_behind & (hits.triangle >= 0)] = True
        return np.flatnonzero(hole)

    def albedo(self, triangle: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(n, 3) float32, linear: the diffuse albedo at points of triangles."""
        return self._surface.rgba(triangle, u, v)[:, :3].clip(0, 1)

    @property
    def emits(self) -> bool:
        """Whether a surface sends light by itself."""
        return self._surface.emits

    def emission(self, triangle: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(n, 3) float32, linear: the radiance that surfaces send by themselves at points of triangles."""
        return self._surface.emission(triangle, u, v)

    def hit_surface(
        self, origins: np.ndarray, directions: np.ndarray, distance: np.ndarray, triangle: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """The ends of rays: positions (n, 3), lifted to the side that the rays came from, and unit normals there."""
        normals = self.normals[triangle]
        normals = normals * np.where((normals * directions).sum(axis=1) > 0, -1, 1).astype(np.float32)[:, None]
        return origins + directions * distance[:, None] + normals * np.float32(self.lift), normals


class _Surfaces:
    """base colour × vertex colour × texture, by triangle, in the order of `Scene.world_triangles`."""

    def __init__(self, instances: tuple[Instance, ...]) -> None:
        meshes = [instance.mesh for instance in instances]
        counts = [len(mesh.faces) for mesh in meshes]
        base = [np.array((*mesh.material.base_color, mesh.material.alpha), np.float32) for mesh in meshes]
        if any(mesh.colors is not None for mesh in meshes):  # (t, 3, 4): a colour a corner
            corner_colors = [
                np.broadcast_to(np.float32(1), (len(m.faces), 3, 4)) if m.colors is None else m.colors[m.faces]
                for m in meshes
            ]
            self._colors = np.concatenate([color * b for color, b in zip(corner_colors, base, strict=True)])
        else:  # (t, 1, 4)
            self._colors = np.repeat(np.stack(base), counts, axis=0)[:, None]

        of_meshes = [[m.material.texture for m in meshes], [m.material.emission_texture for m in meshes]]
        self._textures = list(dict.fromkeys(texture for textures in of_meshes for texture in textures if texture))
        numbers = {texture: i for i, texture in enumerate(self._textures)}
        self._texture, self._glow = (  # (t,): the number of the texture, -1 where there is none
            np.repeat(np.array([numbers[texture] if texture else -1 for texture in textures], np.int32), counts)
            for textures in of_meshes
        )
        emission = np.array([m.material.emission for m in meshes], np.float32)
        self.emits = bool(emission.any())
        self._emission = np.repeat(emission, counts, axis=0) if self.emits else emission
        self._uv = None
        if self._textures:
            self._uv = np.concatenate([
                np.zeros((len(m.faces), 3, 2), np.float32) if m.uv is None else m.uv[m.faces] for m in meshes
            ])  # fmt: skip
        cutoffs = [-1.0 if m.material.alpha_cutoff is None else m.material.alpha_cutoff for m in meshes]
        self._cutoff = np.repeat(np.array(cutoffs, np.float32), counts)
        self._blend = np.repeat([mesh.material.blend for mesh in meshes], counts)
        fronts = [_front(instance) for instance in instances]
        self.front = np.repeat(np.array(fronts, np.float32), counts)  # (t,): see `_front`
        self.has_holes = max(cutoffs) > 0 or bool(self._blend.any()) or any(fronts)

    @cached_property
    def _linear(self) -> list[np.ndarray]:
        """The textures as (H, W, 4) float32, linear."""
        return [
            np.concatenate([linear_from_srgb(t.pixels[..., :3]), t.pixels[..., 3:].astype(np.float32) / 255], axis=2)
            for t in self._textures
        ]

    def rgba(self, triangle: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(n, 4) float32, linear: base colour and alpha."""
        weights = np.stack([1 - u - v, u, v], axis=1)[..., None]
        color = self._colors[triangle]
        color = color[:, 0].copy() if color.shape[1] == 1 else (color * weights).sum(axis=1)
        self._multiply(color, self._texture, triangle, weights)
        return color

    def emission(self, triangle: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(n, 3) float32, linear."""
        color = np.ones((len(triangle), 4), np.float32)
        color[:, :3] = self._emission[triangle]
        self._multiply(color, self._glow, triangle, np.stack([1 - u - v, u, v], axis=1)[..., None])
        return color[:, :3]

    def _multiply(self, color: np.ndarray, textures: np.ndarray, triangle: np.ndarray, weights: np.ndarray) -> None:
        """Multiply `color` (n, 4) by the textures (t,) of the triangles, bilinear at their finest level."""
        if self._uv is None:
            return
        which = textures[triangle]
        for i in np.unique(which[which >= 0]):
            here = np.flatnonzero(which == i)
            uv = (self._uv[triangle[here]] * weights[here]).sum(axis=1)
            u, v = _wrapped(self._textures[i], uv[:, 0], 1 - uv[:, 1])
            color[here] *= bilinear(self._linear[i], u, v, repeat_rows=True)

    def in_hole(self, hits: Hits) -> np.ndarray:
        """(n,) bool: the hits where the surface is cut out.

        A blended surface is one of as many rays as its alpha states; where it is hit decides which.
        """
        hole = np.zeros(len(hits.triangle), bool)
        hit = np.flatnonzero(hits.triangle >= 0)
        hit = hit[(self._cutoff[hits.triangle[hit]] > 0) | self._blend[hits.triangle[hit]]]
        triangle, u, v = hits.triangle[hit], hits.u[hit], hits.v[hit]
        even = (triangle * 0.754877666 + u * 12.9898e3 + v * 78.233e3) % 1  # as good as random in [0, 1)
        threshold = np.where(self._blend[triangle], even, self._cutoff[triangle])
        hole[hit] = self.rgba(triangle, u, v)[:, 3] < threshold
        return hole


def _front(instance: Instance) -> float:
    """0 for a surface with two sides, else the side of the triangles' world-space winding that is the front: 1 or -1.

    A closed mesh with its fronts outside counts as two-sided: no ray from outside meets a back first.
    """
    if instance.mesh.material.double_sided or instance.mesh.is_solid:
        return 0.0
    return float(np.sign(np.linalg.det(instance.world_from_local[:3, :3])))


def _wrapped(texture: Texture, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates (v downwards) at which the repeated texture, between texels, shows what `texture` shows at u, v."""
    height, width = texture.pixels.shape[:2]
    found = []
    for at, count, wrap in ((u, width, texture.wrap[0]), (v, height, texture.wrap[1])):
        if wrap == "mirror":
            at = np.abs((at + 1) % 2 - 1)
        if texture.nearest:
            at = (np.floor(at * count) + 0.5) / count
        found.append(at if wrap == "repeat" else at.clip(0.5 / count, 1 - 0.5 / count))
    return found[0], found[1]


def bilinear(image: np.ndarray, u: np.ndarray, v: np.ndarray, repeat_rows: bool) -> np.ndarray:
    """(n, C) float32: `image` (H, W, C) at u (along a row) and v (from the first row down), in [0, 1]; u repeats."""
    height, width, channels = image.shape
    texels = image.reshape(-1, channels)  # one index a texel: several times faster than a row and a column
    x, y = u * np.float32(width) - np.float32(0.5), v * np.float32(height) - np.float32(0.5)
    left, top = np.floor(x), np.floor(y)
    right_share, low_share = ((a - b).astype(np.float32)[:, None] for a, b in ((x, left), (y, top)))
    column, row = left.astype(np.int64), top.astype(np.int64)
    columns = column % width, (column + 1) % width
    rows = (row % height, (row + 1) % height) if repeat_rows else (row.clip(0), (row + 1).clip(max=height - 1))
    upper, lower = (
        _between(texels.take(r * width + columns[0], axis=0), texels.take(r * width + columns[1], axis=0), right_share)
        for r in rows
    )
    return _between(upper, lower, low_share)


def _between(a: np.ndarray, b: np.ndarray, share: np.ndarray) -> np.ndarray:
    """a + (b - a) · share, in the memory of `a` and `b`."""
    b -= a
    b *= share
    a += b
    return a
