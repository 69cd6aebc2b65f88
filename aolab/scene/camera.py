"""The camera: a pinhole, or parallel rays; right-handed, y up; view space looks down -z."""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import radians, tan

import numpy as np

from ..errors import SceneError
from ..maths.numbers import numbers, vector
from ..maths.transforms import look_along, orthographic, perspective

Vec3 = tuple[float, float, float]

_SIDES = np.array([*product((0, 1), repeat=3)])  # (8, 3): of each corner of a box, the low or the high side


def corners(bounds: np.ndarray) -> np.ndarray:
    """(8, 3): the corners of a box (2, 3)."""
    return bounds[_SIDES, (0, 1, 2)]


@dataclass(frozen=True)
class Camera:
    """A camera in world space: a perspective one, or an orthographic one where `ortho` is given.

    `eye`, `target` and `up` are world-space points and a direction (scene units); `fov` is the vertical field of
    view in degrees, in (0, 180). `near` and `far` are clip distances in scene units; None takes them from the scene.
    `ortho` is the height of the picture in scene units; then all rays are parallel, and `fov` has no effect.
    `fit`: in a picture higher than wide, `fov` and `ortho` are those of its width, so that nothing is cut off.
    Raises `SceneError` for a camera that looks nowhere or holds non-finite numbers.
    """

    eye: Vec3
    target: Vec3
    up: Vec3 = (0.0, 1.0, 0.0)
    fov: float = 45.0
    near: float | None = None
    far: float | None = None
    ortho: float | None = None
    fit: bool = False

    def __post_init__(self) -> None:
        for name in ("eye", "target", "up"):
            value = vector(getattr(self, name))
            if value is None:
                raise SceneError(f"camera: {name} = {getattr(self, name)} is not three finite numbers")
            object.__setattr__(self, name, tuple(value.tolist()))
        for name in ("fov", "ortho", "near", "far"):
            value = getattr(self, name)
            if (found := numbers(value)) is None or (value is not None and found.shape):
                raise SceneError(f"camera: {name} = {value!r:.80} is not a number")
        if not 0 < self.fov < 180:
            raise SceneError(f"camera: fov = {self.fov} is outside (0, 180) degrees")
        forward = np.subtract(self.target, self.eye)
        if not np.linalg.norm(forward) > 0:
            raise SceneError(f"camera: eye and target are both {self.eye}; it looks nowhere")
        if np.linalg.norm(np.cross(forward, self.up)) <= 1e-9 * np.linalg.norm(forward) * np.linalg.norm(self.up):
            raise SceneError(f"camera: up = {self.up} is parallel to the view direction; choose another up")
        if self.ortho is not None and not 0 < self.ortho < np.inf:
            raise SceneError(f"camera: ortho = {self.ortho} is no finite height above 0")
        if self.near is not None and not 0 < self.near < np.inf:
            raise SceneError(f"camera: near = {self.near} must be finite and above 0")
        if self.far is not None and not (self.near or 0) < self.far < np.inf:
            raise SceneError(f"camera: far = {self.far} must be finite and above near = {self.near or 0}")

    @cached_property
    def view_from_world(self) -> np.ndarray:
        """(4, 4) float64, a rigid transform; read-only."""
        matrix = look_along(np.asarray(self.eye), np.subtract(self.target, self.eye), np.asarray(self.up))
        matrix.flags.writeable = False
        return matrix

    def half_extent(self, size: tuple[int, int]) -> tuple[float, float]:
        """Half the width and height that a picture of (width, height) pixels shows, in scene units.

        They are those at distance 1 from a perspective camera, and at every distance from an orthographic one.
        """
        width, height = size
        half = tan(radians(self.fov) / 2) if self.ortho is None else self.ortho / 2
        pixels = self._side(size)
        return half * width / pixels, half * height / pixels

    def with_margin(self, size: tuple[int, int], larger: tuple[int, int]) -> "Camera":
        """The camera whose picture of `larger` pixels holds this camera's picture of `size` in its middle."""
        scale = self._side(larger) / self._side(size)
        if self.ortho is not None:
            return replace(self, ortho=self.ortho * scale)
        return replace(self, fov=float(2 * np.degrees(np.arctan(np.tan(np.radians(self.fov) / 2) * scale))))

    def _side(self, size: tuple[int, int]) -> int:
        """The side of the picture, in pixels, that `fov` and `ortho` are measured along."""
        return min(size) if self.fit else size[1]

    def clip_planes(self, bounds: np.ndarray) -> tuple[float, float]:
        """Near and far distances that hold `bounds` (2, 3), where the camera does not give narrower ones."""
        distances = -(corners(bounds) @ self.view_from_world[2, :3] + self.view_from_world[2, 3])
        reach = max(float(distances.max()) * 1.01, 1e-6)
        far = min(self.far or reach, reach)  # beyond, there is nothing, and the depth buffer would lose precision
        # 24 bits of depth: 1e-3 keeps 3 mm apart at 25 m, and parallel rays lose nothing
        near = max(float(distances.min()) * 0.99, far * (1e-3 if self.ortho is None else 1e-6))
        near = self.near or min(near, far / 2)  # a far plane that is given stays
        return near, max(far, near * 1.001)

    def clip_from_view(self, size: tuple[int, int], bounds: np.ndarray) -> np.ndarray:
        """(4, 4) float64, OpenGL clip space."""
        near, far = self.clip_planes(bounds)
        project = perspective if self.ortho is None else orthographic
        return project(*self.half_extent(size), near, far)

    def orbited(self, azimuth: float = 0.0, elevation: float = 0.0, zoom: float = 1.0) -> "Camera":
        """The camera with its eye turned around the target: `azimuth` degrees to the right, `elevation` degrees up.

        `zoom` divides the distance, and the height of an orthographic picture. The eye stays at least 1 degree away
        from the poles of `up`. Raises `SceneError` if `zoom` is not above 0.
        """
        if not 0 < zoom < np.inf:
            raise SceneError(f"camera: zoom = {zoom} is not a number above 0")
        target, up = np.asarray(self.target), np.asarray(self.up) / np.linalg.norm(self.up)
        away = np.subtract(self.eye, target)
        distance = np.linalg.norm(away)
        height = np.arcsin(np.clip(away @ up / distance, -1, 1))
        ahead = away - (away @ up) * up
        ahead /= np.linalg.norm(ahead)
        turn = np.radians(azimuth)
        ahead = np.cos(turn) * ahead + np.sin(turn) * np.cross(up, ahead)
        limit = np.radians(89.0)
        height = np.clip(height + np.radians(elevation), -limit, limit)
        eye = target + (np.cos(height) * ahead + np.sin(height) * up) * distance / zoom
        return replace(self, eye=tuple(eye.tolist()), ortho=None if self.ortho is None else self.ortho / zoom)

    @classmethod
    def framing(cls, bounds: np.ndarray, direction: Vec3 = (0.5, 0.35, 1.0), fov: float = 35.0) -> "Camera":
        """A camera that sees all of `bounds` (2, 3) in a picture of any shape, from `direction` as seen from their
        centre."""  # fmt: skip
        centre = bounds.mean(axis=0)
        towards = np.asarray(direction) / np.linalg.norm(direction)
        probe = cls(eye=tuple(towards), target=(0, 0, 0), fov=fov)
        x, y, z = probe.view_from_world[:3, :3] @ (corners(bounds) - centre).T
        # the distance at which each corner falls inside the frame, 5 % away from its edge
        distance = float((z + np.maximum(np.abs(x), np.abs(y)) * 1.05 / np.tan(np.radians(fov) / 2)).max())
        return cls(eye=tuple(centre + towards * max(distance, 1e-6)), target=tuple(centre), fov=fov, fit=True)
