"""The light from far away: an equirectangular map of radiance, and the irradiance that it casts."""

from dataclasses import dataclass
from functools import cached_property
from os import PathLike

import numpy as np

from ..errors import SceneError, notice
from ..input import Budget, as_path
from ..maths.harmonics import evaluate, irradiance, project
from .camera import Vec3

HALF_MAX = 65504.0  # the largest finite float16 (IEEE 754 binary16), which HDR files and textures hold
SKY_SIZE = (128, 256)  # rows, columns: 1.4° a texel, finer than anything in a gradient but the sun
PROJECTION_CELLS = (256, 512)  # rows, columns to which a finer map is averaged before its projection


def direction_from_uv(uv: np.ndarray) -> np.ndarray:
    """World-space unit directions (..., 3) of equirectangular `uv` (..., 2): the inverse of `uv_from_direction`."""
    uv = np.asarray(uv, np.float64)
    azimuth, polar = 2 * np.pi * (uv[..., 0] - 0.5), np.pi * uv[..., 1]
    return np.stack([np.sin(polar) * np.sin(azimuth), np.cos(polar), -np.sin(polar) * np.cos(azimuth)], axis=-1)


def uv_from_direction(directions: np.ndarray) -> np.ndarray:
    """Equirectangular uv (..., 2) in [0, 1] of world-space unit `directions` (..., 3); `environmentUv` in GLSL.

    Single precision stays single precision.
    """
    precision = np.float32 if getattr(directions, "dtype", None) == np.float32 else np.float64
    x, y, z = np.moveaxis(np.asarray(directions, precision), -1, 0)
    polar = np.arctan2(np.hypot(x, z), y)  # acos(y), but precise near the poles
    return np.stack([0.5 + np.arctan2(x, -z) / (2 * np.pi), polar / np.pi], axis=-1)


@dataclass(frozen=True, eq=False)
class Environment:
    """Light from infinitely far away.

    `radiance` (H, W, 3) float32: linear RGB, equirectangular, top row first. For a world-space direction d,
    u = 0.5 + atan2(d.x, -d.z) / 2π and v = acos(d.y) / π: the first row looks up (+y), the centre column down -z, and
    u grows towards +x. The texel in row i, column j has its centre at u = (j + 0.5) / W, v = (i + 0.5) / H.
    Pixels that are NaN or negative become 0, infinite ones the largest finite one (at most 65504); a `Notice` counts
    them. Raises `SceneError` for another shape.
    """

    radiance: np.ndarray
    name: str = "environment"

    def __post_init__(self) -> None:
        try:
            with np.errstate(over="ignore"):  # beyond float32 is infinite, and repaired as such
                radiance = np.array(self.radiance, np.float32, order="C")
        except (TypeError, ValueError) as error:
            raise SceneError(f"environment '{self.name}': radiance is not an array of numbers: {error}") from None
        if radiance.ndim != 3 or radiance.shape[2] != 3 or not radiance.size:
            raise SceneError(f"environment '{self.name}': radiance has shape {radiance.shape}, not (H, W, 3)")
        self._repair(radiance)
        radiance.flags.writeable = False
        object.__setattr__(self, "radiance", radiance)

    def __repr__(self) -> str:
        height, width = self.radiance.shape[:2]
        return f"<Environment '{self.name}': {width}x{height}, radiance up to {self.radiance.max():.3g}>"

    def _repr_png_(self) -> bytes:
        from ..pictures import display

        return display.environment_png(self.radiance)

    def _repair(self, radiance: np.ndarray) -> None:
        if radiance.min() >= 0 and radiance.max() < np.inf:  # a NaN makes this false
            return
        nan, infinite, negative = np.isnan(radiance), radiance == np.inf, radiance < 0
        largest = min(float(radiance.max(where=np.isfinite(radiance), initial=0)) or HALF_MAX, HALF_MAX)
        radiance[nan | negative] = 0
        radiance[infinite] = largest
        counts = {"NaN": nan, "negative": negative, "infinite": infinite}
        found = ", ".join(f"{mask.any(axis=2).sum()} {kind}" for kind, mask in counts.items() if mask.any())
        notice(
            f"environment '{self.name}': of {nan[..., 0].size} pixels, {found}: "
            f"NaN and negative became 0, infinite {largest:g}"
        )

    @classmethod
    def constant(cls, rgb: Vec3 | float) -> "Environment":
        """The same radiance `rgb` from everywhere: the irradiance is π·rgb on any surface."""
        try:
            radiance = np.broadcast_to(np.asarray(rgb, np.float32), (1, 2, 3))
        except (TypeError, ValueError):
            raise SceneError(f"constant: rgb = {rgb!r:.80} is not a number or three numbers") from None
        return cls(radiance, "constant")

    @classmethod
    def sky(
        cls,
        zenith: Vec3 = (0.3, 0.56, 1.08),
        horizon: Vec3 = (1.05, 1.12, 1.2),
        ground: Vec3 = (0.36, 0.32, 0.27),
        sun_direction: Vec3 | None = None,
        sun_radiance: Vec3 = (160.0, 145.0, 120.0),
        sun_angle: float = 6.0,
    ) -> "Environment":
        """A smooth sky over a ground, and a sun if `sun_direction` (from the ground towards it, world space) is given.

        `zenith`, `horizon`, `ground`: linear radiance. The sun is a soft disc `sun_angle` degrees across that sends as
        much light as a sharp one of `sun_radiance`, at any resolution.
        """
        directions, solid_angles = _cells(np.arange(SKY_SIZE[0] + 1), np.arange(SKY_SIZE[1] + 1))
        up = directions[..., 1:2]
        zenith_share = np.sqrt(np.clip(up, 0, 1))  # most of the change is near the horizon, as in a clear sky
        ground_share = _smoothstep(0.0, 0.12, -up)  # a hazy edge 7° deep: no step that would alias in reflections
        sky = np.asarray(horizon) * (1 - zenith_share) + np.asarray(zenith) * zenith_share
        radiance = sky * (1 - ground_share) + np.asarray(ground) * ground_share
        if sun_direction is not None:
            radiance += _sun(directions, solid_angles, sun_direction, sun_angle)[..., None] * np.asarray(sun_radiance)
        return cls(radiance, "sky")

    @classmethod
    def load(cls, path: str | PathLike[str], memory: int | str | None = None) -> "Environment":
        """An equirectangular map: `.hdr` or `.exr` (linear), or an 8-bit picture (sRGB: no light brighter than 1).

        `memory`: how much decoding may take, as in "4GB"; None takes `AOLAB_MEMORY`, else 2 GB. Raises `FileError` for
        a file that is missing, unknown, corrupt or too large.
        """
        from ..pictures.images import RADIANCE_SUFFIXES, linear_from_srgb, read_image, read_radiance

        path, budget = as_path(path), Budget(memory)
        if path.suffix.lower() in RADIANCE_SUFFIXES:
            return cls(read_radiance(path, budget=budget), path.name)
        return cls(linear_from_srgb(read_image(path, path.name, budget=budget)[..., :3]), path.name)

    @classmethod
    def light_probe(cls, path: str | PathLike[str]) -> "Environment":
        """A light probe in the angular map of Debevec 1998: a square picture, of which the inscribed circle counts.

        Its centre looks down -z, its rim along +z, up is +y; the angle to -z grows evenly from the centre to the rim.
        Files as for `load`; raises `FileError`, and `SceneError` for a picture that is not square.
        """
        from scipy.ndimage import map_coordinates

        probe = cls.load(path)
        side, width = probe.radiance.shape[:2]
        if side != width:
            raise SceneError(f"light probe '{probe.name}': it is {width}x{side}, and an angular map is square")
        directions, _ = _cells(np.arange(side + 1), np.arange(2 * side + 1))
        x, y, z = np.moveaxis(directions, -1, 0)
        from_centre = np.arccos(np.clip(-z, -1, 1)) / np.pi / np.maximum(np.hypot(x, y), 1e-12)
        row, column = ((1 + part * from_centre) / 2 * side - 0.5 for part in (-y, x))
        bands = np.moveaxis(probe.radiance, -1, 0)
        values = [map_coordinates(band, (row, column), order=1, mode="nearest") for band in bands]
        return cls(np.stack(values, axis=-1), probe.name)

    def rotated(self, degrees: float) -> "Environment":
        """The environment turned about +y, counter-clockwise seen from above; between texels it is interpolated."""
        if not np.isfinite(degrees):
            raise SceneError(f"environment '{self.name}': cannot be rotated by {degrees} degrees")
        shift = (degrees / 360) % 1 * self.radiance.shape[1]
        whole, part = int(shift), shift % 1
        left = np.roll(self.radiance, -whole, axis=1)
        return Environment((1 - part) * left + part * np.roll(left, -1, axis=1) if part else left, self.name)

    @cached_property
    def radiance_sh(self) -> np.ndarray:
        """(16, 3) float64: the projection of the radiance itself, L(ω) ≈ Σ radiance_sh[i] y_i(ω)."""
        values, directions, solid_angles = averaged(self.radiance)
        return project(values.reshape(-1, 3), directions.reshape(-1, 3), solid_angles.ravel(), bands=4)

    @cached_property
    def irradiance_sh(self) -> np.ndarray:
        """(9, 3) float64: E(n) = Σ irradiance_sh[i] y_i(n), in the basis of `aolab.maths.harmonics`.

        The bands left out are 1 % on average for natural light (Ramamoorthi & Hanrahan 2001, abstract), and at any
        normal at most 3/32 of ∫ L dω: a point light in the surface's plane, which has 1/4 - 5/32 instead of 0.
        """
        return irradiance(self.radiance_sh[:9])

    def irradiance(self, normals: np.ndarray) -> np.ndarray:
        """Irradiance (..., 3) on surfaces with world-space unit `normals` (..., 3); never below 0."""
        return np.maximum(evaluate(self.irradiance_sh, normals), 0)


def _smoothstep(low: float, high: float, value: np.ndarray) -> np.ndarray:
    t = np.clip((value - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def _cells(row_edges: np.ndarray, column_edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Directions (h, w, 3) and solid angles (h, w), steradians, of the cells between whole rows and columns."""
    cosine = np.cos(np.pi * row_edges / row_edges[-1])
    azimuth = np.pi * (2 * column_edges / column_edges[-1] - 1)
    solid_angles = np.outer(-np.diff(cosine), np.diff(azimuth))  # exact: ∫∫ sinθ dθ dφ
    up = (cosine[1:] + cosine[:-1])[:, None] / 2  # halves the cell's solid angle
    middle = (azimuth[1:] + azimuth[:-1])[None] / 2
    across = np.sqrt(1 - up * up)
    parts = np.broadcast_arrays(across * np.sin(middle), up, -across * np.cos(middle))
    return np.stack(parts, axis=-1), solid_angles


def averaged(
    radiance: np.ndarray, most: tuple[int, int] = PROJECTION_CELLS
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Means over solid angle of an equirectangular map: values (h, w, 3), directions (h, w, 3), solid angles (h, w).

    There are at most `most` rows and columns.
    """
    edges = [
        np.linspace(0, size, min(size, cells) + 1).astype(int)
        for size, cells in zip(radiance.shape[:2], most, strict=True)
    ]
    directions, solid_angles = _cells(*edges)
    if solid_angles.shape == radiance.shape[:2]:
        return radiance, directions, solid_angles
    height, width = radiance.shape[:2]
    weights = -np.diff(np.cos(np.pi * np.arange(height + 1) / height))
    rows = np.stack([
        (weights[a:b] / weights[a:b].sum()).astype(np.float32) @ radiance[a:b].reshape(b - a, -1)
        for a, b in zip(edges[0], edges[0][1:], strict=False)
    ])  # fmt: skip
    sums = np.add.reduceat(rows.reshape(-1, width, 3).astype(np.float64), edges[1][:-1], axis=1)
    return sums / np.diff(edges[1])[None, :, None], directions, solid_angles


def _sun(directions: np.ndarray, solid_angles: np.ndarray, towards: Vec3, angle: float) -> np.ndarray:
    """(h, w): a soft disc whose integral is that of a sharp one, of value 1 and `angle` degrees across."""
    if np.shape(towards) != (3,) or not np.isfinite(towards).all() or not np.linalg.norm(towards) > 0:
        raise SceneError(f"sky: sun_direction = {towards} is not a direction")
    if not 0 < angle <= 180:
        raise SceneError(f"sky: sun_angle = {angle} is outside (0, 180] degrees")
    radius = np.radians(angle) / 2
    texel = np.pi / len(directions)
    distance = np.arccos(np.clip(directions @ (np.asarray(towards) / np.linalg.norm(towards)), -1, 1))
    disc = _smoothstep(radius + texel, radius - texel, distance)
    return disc * (2 * np.pi * (1 - np.cos(radius)) / (disc * solid_angles).sum())
