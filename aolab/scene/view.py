"""A camera at a resolution, as the uniforms that every shader shares."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..maths.harmonics import rotation
from .camera import Camera

Size = tuple[int, int]


def matrix_bytes(matrix: np.ndarray) -> bytes:
    """Row-major (4, 4) as GLSL stores it: float32, column by column."""
    return np.ascontiguousarray(matrix.T, np.float32).tobytes()


def ray_scale_offset(camera: Camera, size: Size) -> tuple[float, float, float, float]:
    """scale.xy, offset.xy of ray.xy = pixel · scale + offset, for the view-space ray (ray.xy, -1) through a pixel."""
    tan_x, tan_y = camera.tan_half_fov(size)
    return 2 * tan_x / size[0], 2 * tan_y / size[1], -tan_x, -tan_y


@dataclass(frozen=True)
class View:
    """`camera` drawn at `size`, with clip planes that hold the world `bounds` (2, 3)."""

    camera: Camera
    size: Size
    bounds: np.ndarray

    @cached_property
    def uniforms(self) -> dict[str, object]:
        """Uniform values by name; see glsl/lib/space.glsl."""
        scale_x, scale_y, offset_x, offset_y = ray = ray_scale_offset(self.camera, self.size)
        view_from_world = self.camera.view_from_world
        return {
            "ray_from_pixel": ray,
            "pixel_from_ray": (1 / scale_x, 1 / scale_y, -offset_x / scale_x, -offset_y / scale_y),
            "texel_size": (1 / self.size[0], 1 / self.size[1]),
            "view_from_world": matrix_bytes(view_from_world),
            "world_from_view": matrix_bytes(np.linalg.inv(view_from_world)),
            "clip_from_view": matrix_bytes(self.camera.clip_from_view(self.size, self.bounds)),
        }

    @cached_property
    def sh_from_world(self) -> np.ndarray:
        """(16, 16): turns spherical harmonics of world space into those of view space."""
        return rotation(self.camera.view_from_world[:3, :3])

    def scaled(self, scale: float) -> "View":
        """The same view at a share of the resolution, at least one pixel a side."""
        width, height = (max(1, round(side * scale)) for side in self.size)
        return View(self.camera, (width, height), self.bounds)
