"""Where the camera's pixels lie on the surfaces: from the G-buffer, set onto the triangles that rays will meet."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..pipeline.frame import Frame
from ..scene.scene import Scene
from ..scene.view import View
from .world import World

# The G-buffer's normals are half floats: three components, each rounded by up to 2^-12. A normal this close to the
# triangle's is the triangle's, and rays along a flat surface do not dip into it.
HALF_ROUNDING = 1e-3
# A ray through a pixel's centre and the rasteriser agree on the triangle when the plane passes within this share (1/n)
# of a pixel's width. Measured on a scanned mesh at 960×540: 99.9 % of the pixels lie within 1/8000.
SAME_PLANE = 16
# Where they disagree, rays so far off the centre (x, y, in pixels) look for the G-buffer's surface, the nearest first.
BESIDE = [
    (r * x, r * y)
    for r in (0.1, 0.4)
    for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1))
]
# A normal whose cosine to the triangle's is below this faces away from it; perpendicular ones, of a corner, do not.
FACING = -0.01
EPSILON = float(np.finfo(np.float32).eps)


@dataclass(frozen=True)
class Points:
    """Some of the pixels that show a surface. Positions are in the coordinates of `World`; vectors in world space."""

    position: np.ndarray  # (n, 3) float32: where rays start, lifted off the surface
    normal: np.ndarray  # (n, 3) float32, unit: the G-buffer's, on the viewer's side
    facet: np.ndarray  # (n, 3) float32, unit: the triangle's, on the same side

    def __len__(self) -> int:
        return len(self.position)

    @cached_property
    def are_smooth(self) -> bool:
        """Whether some shading normals are not those of the triangles."""
        return not np.array_equal(self.normal, self.facet)

    def ways(self, directions: np.ndarray) -> np.ndarray:
        """(n, 3): the ways on which `directions` (n, 3) are traced, as `wayAlong` in glsl/lib/receiver.glsl.

        A direction that leads under the triangle, as shading normals allow, is mirrored at the triangle's plane.
        """
        if not self.are_smooth:
            return directions
        return directions - self.facet * np.minimum(2 * (directions * self.facet).sum(axis=1), 0)[:, None]

    def cosine(self, ways: np.ndarray, where: np.ndarray, covered: float) -> np.ndarray:
        """(m,): π times the density of the directions that are traced along `ways` (m, 3), at the points `where` (m,).

        It is cosθ within the cone that `covered` describes (see `hemisphere`), plus that of the mirrored direction.
        """
        density = _within((ways * self.normal[where]).sum(axis=1), covered)
        if not self.are_smooth:
            return density
        rising = (ways * self.facet[where]).sum(axis=1)
        mirrored = ways - 2 * self.facet[where] * rising[:, None]
        density = density + _within((mirrored * self.normal[where]).sum(axis=1), covered)
        return np.where(rising > 0, density, 0)


def _within(cosine: np.ndarray, covered: float) -> np.ndarray:
    """The cosines of directions within the cone, 0 of others."""
    return np.where((cosine > 0) & (cosine**2 >= 1 - covered), cosine, 0)


class Surface:
    """The surface at the centre of every pixel that shows one; `pixel` holds their indices, row-major from the top.

    The point is where a ray through the pixel's centre meets a triangle, lifted by `World.lift` along that triangle's
    normal, on the viewer's side. Nothing can lie between such a point and the eye, in particular not the other wall of
    a corner whose edge the rasteriser drew a fraction of a pixel beside the edge that rays meet. The G-buffer's depth
    decides whether both mean the same surface. Where they do not (silhouettes: a rasteriser snaps vertices to a
    fraction of a pixel), rays close to the pixel's centre look for the G-buffer's surface; if none finds it, the point
    starts a pixel's width off the G-buffer's position, along its normal.

    The normal is the G-buffer's; if `normals` is geometric, the one that no map bends. Where that faces away from the
    triangle that the ray meets, it is the triangle's: at a silhouette the rasteriser may draw the far side of a solid,
    whose normal, turned to the viewer, points inside.
    """

    def __init__(self, frame: Frame, scene: Scene, view: View, world: World, normals: str = "shading") -> None:
        self.pixel = np.flatnonzero(frame.mask)
        self.view = view
        own = normals == "geometric" and "geometricNormal" in frame.buffers
        self._view_z, self._albedo = frame["viewZ"], frame["albedo"]
        self._normal = frame["geometricNormal" if own else "viewNormal"]
        self._facet = frame["facetNormal" if "facetNormal" in frame else "viewNormal"]
        self._world = world
        self._world_from_view = np.linalg.inv(view.camera.view_from_world)
        self._eye = self._world_from_view[:3, 3] - world.centre
        self._near = view.camera.clip_planes(scene.bounds)[0]
        # the rounding of the rasteriser's float32 transform, in the shaders' world
        origin = scene.shader_origin
        extent = np.abs(scene.bounds - origin).max() + np.linalg.norm(self._world_from_view[:3, 3] - origin)
        self._rounding = 8 * EPSILON * float(extent)

    def __len__(self) -> int:
        return len(self.pixel)

    @property
    def albedo(self) -> np.ndarray:
        """(n, 3) float32, of all points."""
        return self._albedo.reshape(-1, 3)[self.pixel]

    def points(self, where: np.ndarray) -> Points:
        """The points of the pixels number `where` (m,). Safe to call from any thread."""
        pixel = self.pixel[where]
        shading, facet = (
            _unit(normal.reshape(-1, 3)[pixel].astype(np.float64) @ self._world_from_view[:3, :3].T)
            for normal in (self._normal, self._facet)
        )
        position, geometric, same = self._meet(pixel, (0.0, 0.0))
        for offset in BESIDE:
            if same.all():
                break
            rest = np.flatnonzero(~same)
            position[rest], geometric[rest], same[rest] = self._meet(pixel[rest], offset)
        rest = np.flatnonzero(~same)
        shown, pixel_width = self._shown(pixel[rest])
        position[rest] = shown + facet[rest] * (pixel_width + self._rounding)[:, None]
        away = (shading * geometric).sum(axis=1) < FACING
        flat = np.linalg.norm(shading - geometric, axis=1) < HALF_ROUNDING
        facet = np.where(same[:, None], geometric, facet)
        shading = np.where((same & (away | flat))[:, None], geometric, shading)
        flat = np.linalg.norm(shading - facet, axis=1) < HALF_ROUNDING
        facet = np.where(flat[:, None], shading, facet)
        return Points(position.astype(np.float32), shading.astype(np.float32), facet.astype(np.float32))

    def _meet(self, pixel: np.ndarray, offset: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Where rays through pixels meet a triangle, lifted (m, 3); its normal (m, 3); is it the G-buffer's (m,)?

        The rays pass `offset` (x, y), in pixels, beside the pixels' centres.
        """
        to_world, at = self._world_from_view[:3, :3].T, window(self.view, pixel, offset)
        first = (self._eye + self.view.positions(at, -self._near) @ to_world).astype(np.float32)
        directions = _unit(self.view.sights(at) @ to_world)
        hits = self._world.first_hit(first, directions.astype(np.float32), np.inf)
        normal = self._world.normals[hits.triangle].astype(np.float64)
        normal *= -np.sign((normal * directions).sum(axis=1, keepdims=True))
        corner = self._world.corners[hits.triangle, 0]
        shown, pixel_width = self._shown(pixel)
        off_plane = np.abs(((shown - corner) * normal).sum(axis=1))
        same = (hits.triangle >= 0) & (off_plane <= pixel_width / SAME_PLANE + self._rounding)
        met = first + directions * np.where(hits.triangle >= 0, hits.distance, 0).astype(np.float64)[:, None]
        height = ((met - corner) * normal).sum(axis=1)  # the error of single precision
        return met + normal * (self._world.lift - height)[:, None], normal, same

    def _shown(self, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The G-buffer's positions (m, 3), and the width (m,) of a pixel there, scene units."""
        view_z = self._view_z.reshape(-1)[pixel].astype(np.float64)
        position = self.view.positions(window(self.view, pixel), view_z)
        return self._eye + position @ self._world_from_view[:3, :3].T, self.view.pixel_width(view_z)


def window(view: View, pixel: np.ndarray, offset: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    """(n, 2) float64: window coordinates of the centres of pixels, row-major from the top left.

    `offset` (x to the right, y up), in pixels, moves them off the centres.
    """
    width, height = view.size
    return np.stack([pixel % width + 0.5 + offset[0], height - 0.5 - pixel // width + offset[1]], axis=-1)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)
