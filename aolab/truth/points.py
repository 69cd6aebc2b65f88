"""Where the camera's pixels lie on the surfaces: from the G-buffer, set onto the triangles that rays will meet."""

from dataclasses import dataclass

import numpy as np

from ..frame import Frame
from ..scene import Scene
from ..view import View, ray_scale_offset
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
    """The pixels that show a surface. Positions are in the coordinates of `World`; vectors are in world space."""

    pixel: np.ndarray  # (n,) int64, row-major from the top left
    position: np.ndarray  # (n, 3) float32: where rays start, lifted off the surface
    normal: np.ndarray  # (n, 3) float32, unit: the G-buffer's, on the viewer's side
    albedo: np.ndarray  # (n, 3) float32

    def part(self, start: int, stop: int) -> "Points":
        """The points from `start` up to `stop`."""
        return Points(*(getattr(self, name)[start:stop] for name in ("pixel", "position", "normal", "albedo")))

    def __len__(self) -> int:
        return len(self.pixel)


def surface_points(frame: Frame, scene: Scene, view: View, world: World) -> Points:
    """The surface at the centre of every pixel that shows one.

    The position is rebuilt from viewZ and moved onto the plane of the triangle that a ray through the pixel meets,
    then lifted by `World.lift` along that triangle's normal, on the viewer's side. Where ray and rasteriser disagree
    on the triangle (edges: a rasteriser snaps vertices to a fraction of a pixel), the point starts a pixel's width
    off along the shading normal instead.
    """
    pixel = np.flatnonzero(frame.mask)
    depth = -frame["viewZ"].reshape(-1)[pixel].astype(np.float64)
    rays = pixel_rays(view)[pixel]
    world_from_view = np.linalg.inv(view.camera.view_from_world)
    to_world = world_from_view[:3, :3]
    eye = world_from_view[:3, 3] - world.centre
    directions = rays @ to_world.T
    positions = eye + directions * depth[:, None]
    shading = _unit(frame["viewNormal"].reshape(-1, 3)[pixel].astype(np.float64) @ to_world.T)

    near = view.camera.clip_planes(scene.bounds)[0]
    lengths = np.linalg.norm(directions, axis=1, keepdims=True)
    start, unit = (eye + near * directions).astype(np.float32), (directions / lengths).astype(np.float32)
    hits = world.first_hit(start, unit, np.inf)

    pixel_width = depth * 2 * view.camera.tan_half_fov(view.size)[1] / view.size[1]
    # what the rasteriser's float32 transform may add, far from the origin
    rounding = 8 * EPSILON * (np.abs(scene.bounds).max() + np.linalg.norm(eye + world.centre))
    tolerance = pixel_width / SAME_PLANE + rounding

    geometric = world.normals[hits.triangle].astype(np.float64)
    geometric *= -np.sign((geometric * directions).sum(axis=1, keepdims=True))
    height = ((positions - world.corners[hits.triangle, 0]) * geometric).sum(axis=1)
    facing = (shading * geometric).sum(axis=1) > 0
    same = (hits.triangle >= 0) & (np.abs(height) <= tolerance) & facing
    geometric[~same], height[~same] = shading[~same], 0.0
    flat = same & (np.linalg.norm(shading - geometric, axis=1) < HALF_ROUNDING)
    shading[flat] = geometric[flat]
    lift = np.where(same, world.lift - height, pixel_width + rounding)
    albedo = frame["albedo"].reshape(-1, 3)[pixel]
    position = (positions + geometric * lift[:, None]).astype(np.float32)
    return Points(pixel, position, shading.astype(np.float32), albedo)


def pixel_rays(view: View) -> np.ndarray:
    """(pixels, 3) float64: the view-space ray through each pixel's centre, z = -1, row-major from the top left."""
    width, height = view.size
    scale_x, scale_y, offset_x, offset_y = ray_scale_offset(view.camera, view.size)
    x = (np.arange(width) + 0.5) * scale_x + offset_x
    y = (np.arange(height)[::-1] + 0.5) * scale_y + offset_y
    grid_x, grid_y = np.meshgrid(x, y)
    return np.stack([grid_x, grid_y, np.full_like(grid_x, -1)], axis=-1).reshape(-1, 3)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)
