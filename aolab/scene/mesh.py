"""Triangles and what they are made of, checked once, on the way in."""

import warnings
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..errors import Notice, SceneError
from ..maths.local_maxima import local_maxima
from ..maths.normals import smooth_normals

CREASE_DEGREES = 40.0  # faces that meet at less than this share a normal; 30-60 is the usual range of modelling tools


@dataclass(frozen=True, eq=False)
class Texture:
    """An image for a material: `pixels` (H, W, 4) uint8, sRGB colour and linear alpha, top row first."""

    pixels: np.ndarray
    name: str = ""

    def __post_init__(self) -> None:
        if self.pixels.ndim != 3 or self.pixels.shape[2] != 4 or self.pixels.dtype != np.uint8 or not self.pixels.size:
            raise SceneError(
                f"texture '{self.name}': pixels are {self.pixels.shape} {self.pixels.dtype}, not (H, W, 4) uint8"
            )


@dataclass(frozen=True, eq=False)
class Material:
    """A diffuse surface: albedo = `base_color` (linear RGB, [0, 1]) × texture × vertex colour.

    `alpha_cutoff`: fragments whose alpha is below it are not drawn; None draws all.
    """

    base_color: tuple[float, float, float] = (0.8, 0.8, 0.8)
    texture: Texture | None = None
    alpha: float = 1.0
    alpha_cutoff: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        color = np.asarray(self.base_color, float)
        if color.shape != (3,) or not np.isfinite(color).all() or (color < 0).any() or (color > 1).any():
            raise SceneError(f"material '{self.name}': base_color = {self.base_color} is not three numbers in [0, 1]")


def _array(value: object, columns: tuple[int, ...], dtype: type, what: str) -> np.ndarray:
    with np.errstate(over="ignore"):  # beyond float32 is infinite, and refused as such
        array = np.array(value, dtype, order="C")  # a copy: the caller's array stays writeable
    if array.ndim != 2 or array.shape[1] not in columns:
        raise SceneError(f"{what} have shape {array.shape}, not (n, {' or '.join(map(str, columns))})")
    array.flags.writeable = False
    return array


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in local space.

    `vertices` (V, 3) float32; `faces` (F, 3) uint32; `normals` (V, 3), made from the faces when None, smooth up to
    `crease` degrees (which splits vertices along the creases); `uv` (V, 2), v up; `colors` (V, 4) linear RGBA float32.
    Degenerate triangles are dropped, counted, and reported as a `Notice`.
    Raises `SceneError` for an empty mesh, non-finite numbers (mesh and index named), indices out of range.
    """

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray | None = None
    uv: np.ndarray | None = None
    colors: np.ndarray | None = None
    material: Material = field(default_factory=Material)
    name: str = "mesh"
    crease: float = CREASE_DEGREES

    def __post_init__(self) -> None:
        what = f"mesh '{self.name}'"
        faces = np.asarray(self.faces)
        if not np.size(self.vertices) or not faces.size:
            raise SceneError(f"{what} is empty: {len(self.vertices)} vertices, {len(faces)} triangles")
        vertices = _array(self.vertices, (3,), np.float32, f"{what}: vertices")
        self._refuse_nonfinite(vertices, f"{what}: vertex")
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise SceneError(f"{what}: faces have shape {faces.shape}, not (n, 3)")
        wrong = np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))
        if len(wrong):
            raise SceneError(
                f"{what}: triangle {wrong[0]} has indices {faces[wrong[0]].tolist()}, "
                f"but there are {len(vertices)} vertices"
            )
        faces = self._drop_degenerate(vertices, faces.astype(np.uint32), what)
        attributes: dict[str, np.ndarray | None] = {"normals": None, "uv": None, "colors": None}
        for key, columns in {"normals": (3,), "uv": (2,), "colors": (4,)}.items():
            value = getattr(self, key)
            if value is None:
                continue
            attributes[key] = array = _array(value, columns, np.float32, f"{what}: {key}")
            if len(array) != len(vertices):
                raise SceneError(f"{what}: {len(array)} {key} for {len(vertices)} vertices")
            self._refuse_nonfinite(array, f"{what}: {key} of vertex")
        if self.material.texture is not None and attributes["uv"] is None:
            warnings.warn(f"{what}: a texture but no uv; drawn in its base colour", Notice, stacklevel=3)
            object.__setattr__(self, "material", replace(self.material, texture=None))
        if attributes["normals"] is None or not (np.abs(attributes["normals"]).max(axis=1) > 0).all():
            vertices, faces, source, attributes["normals"] = smooth_normals(vertices, faces, self.crease)
            for key in ("uv", "colors"):
                array = attributes[key]
                attributes[key] = None if array is None else array[source]
        for key, array in {"vertices": vertices, "faces": faces, **attributes}.items():
            if array is not None:
                array = np.ascontiguousarray(array)
                array.flags.writeable = False
            object.__setattr__(self, key, array)

    @cached_property
    def welded(self) -> tuple[np.ndarray, np.ndarray]:
        """The mesh with vertices at one place as one: points (P, 3), and the triangles' edges (3 F, 2) between them."""
        points, point = np.unique(self.vertices, axis=0, return_inverse=True)
        corners = point.reshape(-1)[self.faces]
        edges = np.concatenate([corners[:, (0, 1)], corners[:, (1, 2)], corners[:, (2, 0)]])
        return points.astype(np.float64), np.sort(edges, axis=1)

    @cached_property
    def is_closed(self) -> bool:
        """Whether every edge joins two triangles (or four, ...): the mesh bounds a solid."""
        points, edges = self.welded
        _, uses = np.unique(edges[:, 0].astype(np.int64) * len(points) + edges[:, 1], return_counts=True)
        return bool((uses % 2 == 0).all())

    @cached_property
    def local_maxima(self) -> tuple[np.ndarray, np.ndarray]:
        """Points (n, 3) of local space, higher than their neighbours along one of `features.AXES`, and which one."""
        return local_maxima(*self.welded)

    @staticmethod
    def _refuse_nonfinite(array: np.ndarray, what: str) -> None:
        wrong = np.flatnonzero(~np.isfinite(array).all(axis=1))
        if len(wrong):
            raise SceneError(
                f"{what} {wrong[0]} is {array[wrong[0]].tolist()}; {len(wrong)} of {len(array)} are not finite"
            )

    @staticmethod
    def _drop_degenerate(vertices: np.ndarray, faces: np.ndarray, what: str) -> np.ndarray:
        corner = vertices.astype(np.float64)[faces]
        edges = corner[:, (1, 2)] - corner[:, (0, 0)]
        doubled_area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
        # relative to the triangle's own longest edge: scale must not decide
        keep = doubled_area > 1e-10 * (edges**2).sum(axis=2).max(axis=1)
        dropped = len(faces) - int(keep.sum())
        if dropped == len(faces):
            raise SceneError(f"{what} is empty: all of its {dropped} triangles are degenerate (no area)")
        if dropped:
            warnings.warn(
                f"{what}: dropped {dropped} of {len(faces)} triangles, degenerate (no area)", Notice, stacklevel=4
            )
        return faces[keep]
