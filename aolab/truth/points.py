"""Where the camera's pixels lie on the surfaces: from the G-buffer, set onto the triangles that rays will meet."""

from dataclasses import dataclass

import numpy as np

from ..pipeline.frame import Frame
from ..scene.scene import Scene
from ..scene.view import View, ray_scale_offset
from .world import World

# The G-buffer's normals are half floats: three components, each rounded by up to 2^-12. A normal this close to the
# triangle's is the triangle's, and rays along a flat surface do not dip into it.
HALF_ROUNDING = 1e-3
# A ray through a pixel's centre and the rasteriser agree on the triangle when the plane passes within this share (1/n)
# of a pixel's width. Measured on a scanned mesh at 960×540: 99.9 % of the pixels lie within 1/8000.
SAME_PLANE = 16
EPSILON = float(np.finfo(np.float32).eps)


@dataclass(frozen=True)
class Points:
    """Some of the pixels that show a surface. Positions are in the coordinates of `World`; vectors in world space."""

    position: np.ndarray  # (n, 3) float32: where rays start, lifted off the surface
    normal: np.ndarray  # (n, 3) float32, unit: the G-buffer's, on the viewer's side
    albedo: np.ndarray  # (n, 3) float32

    def __len__(self) -> int:
        return len(self.position)


class Surface:
    """The surface at the centre of every pixel that shows one; `pixel` holds their indices, row-major from the top.

    The position is rebuilt from viewZ and moved onto the plane of the triangle that a ray through the pixel meets,
    then lifted by `World.lift` along that triangle's normal, on the viewer's side. Where ray and rasteriser disagree
    on the triangle (edges: a rasteriser snaps vertices to a fraction of a pixel), the point starts a pixel's width
    off along the shading normal instead.
    """

    def __init__(self, frame: Frame, scene: Scene, view: View, world: World) -> None:
        self.pixel = np.flatnonzero(frame.mask)
        self._view_z, self._normal, self._albedo = frame["viewZ"], frame["viewNormal"], frame["albedo"]
        self._view, self._world = view, world
        self._world_from_view = np.linalg.inv(view.camera.view_from_world)
        self._eye = self._world_from_view[:3, 3] - world.centre
        self._near = view.camera.clip_planes(scene.bounds)[0]
        # the rounding of the rasteriser's float32 transform, in the world whose origin is the scene's centre
        extent = np.abs(scene.bounds - world.centre).max() + np.linalg.norm(self._eye)
        self._rounding = 8 * EPSILON * float(extent)

    def __len__(self) -> int:
        return len(self.pixel)

    def points(self, start: int, stop: int) -> Points:
        """The points from `start` up to `stop`. Safe to call from any thread."""
        pixel = self.pixel[start:stop]
        depth = -self._view_z.reshape(-1)[pixel].astype(np.float64)
        to_world = self._world_from_view[:3, :3].T
        directions = pixel_rays(self._view, pixel) @ to_world
        positions = self._eye + directions * depth[:, None]
        shading = _unit(self._normal.reshape(-1, 3)[pixel].astype(np.float64) @ to_world)

        first = (self._eye + self._near * directions).astype(np.float32)
        triangle = self._world.first_hit(first, _unit(directions).astype(np.float32), np.inf).triangle
        geometric = self._world.normals[triangle].astype(np.float64)
        geometric *= -np.sign((geometric * directions).sum(axis=1, keepdims=True))
        height = ((positions - self._world.corners[triangle, 0]) * geometric).sum(axis=1)

        pixel_width = depth * 2 * self._view.camera.half_extent(self._view.size)[1] / self._view.size[1]
        facing = (shading * geometric).sum(axis=1) > 0
        same = (triangle >= 0) & (np.abs(height) <= pixel_width / SAME_PLANE + self._rounding) & facing
        geometric = np.where(same[:, None], geometric, shading)
        flat = same & (np.linalg.norm(shading - geometric, axis=1) < HALF_ROUNDING)
        shading[flat] = geometric[flat]
        lift = np.where(same, self._world.lift - height, pixel_width + self._rounding)
        position = (positions + geometric * lift[:, None]).astype(np.float32)
        return Points(position, shading.astype(np.float32), self._albedo.reshape(-1, 3)[pixel])


def pixel_rays(view: View, pixel: np.ndarray) -> np.ndarray:
    """(n, 3) float64: the view-space rays, z = -1, through the centres of pixels, row-major from the top left."""
    width, height = view.size
    scale_x, scale_y, offset_x, offset_y = ray_scale_offset(view.camera, view.size)
    x = (pixel % width + 0.5) * scale_x + offset_x
    y = (height - 0.5 - pixel // width) * scale_y + offset_y
    return np.stack([x, y, np.full_like(x, -1)], axis=-1)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)
