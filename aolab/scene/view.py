"""A camera, or another projection, at a resolution, as the uniforms that every shader shares."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..maths.harmonics import rotation
from .camera import Camera

Size = tuple[int, int]
Region = tuple[int, int, int, int]  # x, y, width, height in pixels; y up


def matrix_bytes(matrix: np.ndarray) -> bytes:
    """Row-major (4, 4) as GLSL stores it: float32, column by column."""
    return np.ascontiguousarray(matrix.T, np.float32).tobytes()


def moved(offset: np.ndarray) -> np.ndarray:
    """(4, 4) float64: the translation by `offset` (3,)."""
    matrix = np.eye(4)
    matrix[:3, 3] = offset
    return matrix


def ray_scale_offset(camera: Camera, size: Size) -> tuple[float, float, float, float]:
    """scale.xy, offset.xy of ray.xy = pixel · scale + offset, for the view-space ray (ray.xy, -1) through a pixel."""
    half_x, half_y = camera.half_extent(size)
    return 2 * half_x / size[0], 2 * half_y / size[1], -half_x, -half_y


FAR = 100.0  # diagonals: from there, float32 would move a vertex by 6e-6 of the scene's size


def shader_origin(bounds: np.ndarray) -> np.ndarray:
    """(3,) float64: the origin of the world that shaders compute in: 0, or the centre of a scene that is far from it.

    float32 is finest near 0. A house at map coordinates, 4e6 units from the origin, would have steps of 0.5 units.
    """
    far = np.abs(bounds).max() > FAR * np.linalg.norm(bounds[1] - bounds[0])
    return bounds.mean(axis=0) if far else np.zeros(3)


@dataclass(frozen=True)
class View:
    """`camera` drawn at `size`, with clip planes that hold the world `bounds` (2, 3).

    The picture may be a tile of a larger texture, an atlas of `atlas` pixels, with its lower left corner at `origin`:
    then pixels are those of the atlas.
    """

    camera: Camera
    size: Size
    bounds: np.ndarray
    origin: tuple[int, int] = (0, 0)
    atlas: Size | None = None

    @property
    def sheet(self) -> Size:
        """The size of the whole texture."""
        return self.atlas or self.size

    @property
    def region(self) -> Region:
        """The pixels of the texture that this view covers."""
        return *self.origin, *self.size

    @property
    def view_from_shader(self) -> np.ndarray:
        """(4, 4) float64: to view space from the world of the shaders, whose origin is `shader_origin`."""
        return self.camera.view_from_world @ moved(shader_origin(self.bounds))

    @cached_property
    def uniforms(self) -> dict[str, object]:
        """Uniform values by name; see glsl/lib/space.glsl."""
        scale_x, scale_y, left, bottom = ray_scale_offset(self.camera, self.size)
        offset_x, offset_y = left - self.origin[0] * scale_x, bottom - self.origin[1] * scale_y
        view_from_world = self.view_from_shader
        return {
            "ray_from_pixel": (scale_x, scale_y, offset_x, offset_y),
            "pixel_from_ray": (1 / scale_x, 1 / scale_y, -offset_x / scale_x, -offset_y / scale_y),
            "texel_size": (1 / self.sheet[0], 1 / self.sheet[1]),
            "view_region": tuple(np.divide((*self.origin, *np.add(self.origin, self.size)), self.sheet * 2)),
            "world_origin": tuple(shader_origin(self.bounds)),
            "view_from_world": matrix_bytes(view_from_world),
            "world_from_view": matrix_bytes(np.linalg.inv(view_from_world)),
            "clip_from_view": matrix_bytes(self.camera.clip_from_view(self.size, self.bounds)),
        }

    def positions(self, pixel: np.ndarray, view_z: np.ndarray | float) -> np.ndarray:
        """(..., 3) float64: view-space points at depths `view_z` (...), seen at `pixel` (..., 2), window coordinates.

        The twin of `viewPosAt` in glsl/lib/space.glsl.
        """
        scale, offset = np.reshape(ray_scale_offset(self.camera, self.size), (2, 2))
        view_z = np.broadcast_to(np.asarray(view_z, np.float64), pixel.shape[:-1])
        distance = 1.0 if self.camera.ortho is not None else -view_z[..., None]
        return np.concatenate([(pixel * scale + offset) * distance, view_z[..., None]], axis=-1)

    def pixels(self, position: np.ndarray) -> np.ndarray:
        """(..., 2) float64: the window coordinates of view-space points (..., 3); `pixelAt` in glsl/lib/space.glsl."""
        scale, offset = np.reshape(ray_scale_offset(self.camera, self.size), (2, 2))
        distance = 1.0 if self.camera.ortho is not None else np.maximum(-position[..., 2:], 1e-20)
        return (position[..., :2] / distance - offset) / scale

    def sights(self, pixel: np.ndarray) -> np.ndarray:
        """(..., 3) float64: view-space directions, z = -1, in which `pixel` (..., 2), window coordinates, is seen."""
        if self.camera.ortho is not None:
            return np.broadcast_to((0.0, 0.0, -1.0), (*pixel.shape[:-1], 3))
        return self.positions(pixel, -1.0)

    def pixel_width(self, view_z: np.ndarray) -> np.ndarray:
        """(...) float64: the width of a pixel in scene units, at depths `view_z` (...)."""
        width = 2 * self.camera.half_extent(self.size)[1] / self.size[1]
        return np.full(np.shape(view_z), width) if self.camera.ortho is not None else -view_z * width

    @property
    def constants(self) -> dict[str, bool]:
        """Constants by name; see glsl/lib/space.glsl."""
        return {"orthographic": self.camera.ortho is not None}

    @cached_property
    def sh_from_world(self) -> np.ndarray:
        """(16, 16): turns spherical harmonics of world space into those of view space."""
        return rotation(self.camera.view_from_world[:3, :3])

    def scaled(self, scale: float) -> "View":
        """The same view at a share of the resolution, at least one pixel a side."""
        width, height = (max(1, round(side * scale)) for side in self.size)
        return View(self.camera, (width, height), self.bounds)


@dataclass(frozen=True)
class Projection:
    """Any view and projection matrix, (4, 4), at a resolution: a light's map, or a grid seen along an axis.

    The world is that of the shaders, whose origin is `shader_origin`.

    `origin` and `atlas` as of `View`. A shader gets the matrices and `texel_size`; it has no rays of a pinhole.
    """

    view_from_world: np.ndarray
    clip_from_view: np.ndarray
    size: Size
    origin: tuple[int, int] = (0, 0)
    atlas: Size | None = None

    @property
    def sheet(self) -> Size:
        """The size of the whole texture."""
        return self.atlas or self.size

    @property
    def region(self) -> Region:
        """The pixels of the texture that this projection covers."""
        return *self.origin, *self.size

    @property
    def constants(self) -> dict[str, bool]:
        """Constants by name: shaders that read rays take it for a pinhole."""
        return {"orthographic": False}

    @cached_property
    def uniforms(self) -> dict[str, object]:
        """Uniform values by name."""
        return {
            "texel_size": (1 / self.sheet[0], 1 / self.sheet[1]),
            "view_from_world": matrix_bytes(self.view_from_world),
            "world_from_view": matrix_bytes(np.linalg.inv(self.view_from_world)),
            "clip_from_view": matrix_bytes(self.clip_from_view),
            "clip_from_world": matrix_bytes(self.clip_from_view @ self.view_from_world),
        }


Viewpoint = View | Projection
