"""Triangles and what they are made of, checked once, on the way in."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal, get_args

import numpy as np

from ..errors import SceneError, notice
from ..maths.connected import connected
from ..maths.local_maxima import local_maxima
from ..maths.normals import NO_LENGTH, smooth_normals, usable_normals
from ..maths.numbers import numbers, vector
from ..maths.tangents import mikktspace

Wrap = Literal["repeat", "mirror", "clamp"]
ALIKE = 1e-5  # 1 - cosine: nearer normals are the same, but for rounding
CHUNK = 256  # triangles, whose distance to a point is taken together
CREASE_DEGREES = 40.0  # faces that meet at less than this share a normal; 30-60 is the usual range of modelling tools


@dataclass(frozen=True, eq=False)
class Texture:
    """An image for a material: `pixels` (H, W, 4) uint8, sRGB colour and linear alpha, top row first.

    `wrap`: how the image goes on outside [0, 1], in u and in v. `nearest`: texels are not interpolated. `mipmaps`:
    far away, averages of texels are drawn. Raises `SceneError` for another shape or wrap.
    """

    pixels: np.ndarray
    name: str = ""
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")
    nearest: bool = False
    mipmaps: bool = True

    def __post_init__(self) -> None:
        if not isinstance(self.pixels, np.ndarray):
            raise SceneError(f"texture '{self.name}': {self.pixels!r:.80} is no array (H, W, 4) uint8")
        if self.pixels.ndim != 3 or self.pixels.shape[2] != 4 or self.pixels.dtype != np.uint8 or not self.pixels.size:
            raise SceneError(
                f"texture '{self.name}': pixels are {self.pixels.shape} {self.pixels.dtype}, not (H, W, 4) uint8"
            )
        if len(self.wrap) != 2 or not {*self.wrap} <= {*get_args(Wrap)}:
            raise SceneError(f"texture '{self.name}': wrap = {self.wrap} is not two of {', '.join(get_args(Wrap))}")


@dataclass(frozen=True, eq=False)
class HeightMap:
    """A relief: `heights` (H, W) float32 over the surface, along its normal, in units of the mesh; top row first.

    `wrap`: how the map goes on outside [0, 1], in u and in v. Raises `SceneError` for another shape, heights that are
    not finite, or another wrap.
    """

    heights: np.ndarray
    name: str = ""
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")

    def __post_init__(self) -> None:
        heights = np.array(self.heights, np.float32)
        if heights.ndim != 2 or not heights.size:
            raise SceneError(f"height map '{self.name}': heights have shape {heights.shape}, not (H, W)")
        if not np.isfinite(heights).all():
            raise SceneError(f"height map '{self.name}': some of its heights are not finite")
        if len(self.wrap) != 2 or not {*self.wrap} <= {*get_args(Wrap)}:
            raise SceneError(f"height map '{self.name}': wrap = {self.wrap} is not two of {', '.join(get_args(Wrap))}")
        heights.flags.writeable = False
        object.__setattr__(self, "heights", heights)


@dataclass(frozen=True, eq=False)
class Material:
    """A diffuse surface: albedo = `base_color` (linear RGB, [0, 1]) × texture × vertex colour.

    `alpha` in [0, 1] multiplies the texture's and the vertices' alpha. `alpha_cutoff`: points whose alpha is below are
    not drawn; None draws all. `blend`: alpha is the share of the pixels, and of the rays, that meet the surface.
    `double_sided`: False leaves out triangles seen from behind, where their corners run clockwise. `emission` is
    radiance (linear RGB, from 0) that the surface sends besides, times `emission_texture`. `normal_texture` holds
    normals in tangent space, 2 × value - 1, by the MikkTSpace convention; `normal_scale` multiplies their x and y.
    `height` is a relief: the occluder kind `height` tests against it. Without a normal texture it bends the normals.
    `occlusion_texture` holds baked visibility, in red; renders do not read it.
    Raises `SceneError` for a value out of range.
    """

    base_color: tuple[float, float, float] = (0.8, 0.8, 0.8)
    texture: Texture | None = None
    alpha: float = 1.0
    alpha_cutoff: float | None = None
    name: str = ""
    blend: bool = False
    double_sided: bool = True
    emission: tuple[float, float, float] = (0.0, 0.0, 0.0)
    emission_texture: Texture | None = None
    normal_texture: Texture | None = None
    normal_scale: float = 1.0
    height: HeightMap | None = None
    occlusion_texture: Texture | None = None

    def __post_init__(self) -> None:
        what = f"material '{self.name}'"
        color = vector(self.base_color)
        if color is None or (color < 0).any() or (color > 1).any():
            raise SceneError(f"{what}: base_color = {self.base_color} is not three numbers in [0, 1]")
        emission = vector(self.emission)
        if emission is None or (emission < 0).any():
            raise SceneError(f"{what}: emission = {self.emission} is not three finite numbers from 0")
        for name in ("alpha", "normal_scale"):
            if numbers(getattr(self, name)) is None:
                raise SceneError(f"{what}: {name} = {getattr(self, name)!r:.80} is not a number")
        if not 0 <= self.alpha <= 1:
            raise SceneError(f"{what}: alpha = {self.alpha} is outside [0, 1]")
        if not np.isfinite(self.normal_scale):
            raise SceneError(f"{what}: normal_scale = {self.normal_scale} is not a finite number")
        if self.height is not None and not isinstance(self.height, HeightMap):
            raise SceneError(f"{what}: height = {self.height!r:.80} is not a HeightMap")

    @property
    def bends_normals(self) -> bool:
        """Whether a texture changes the normals of the vertices."""
        return self.normal_texture is not None or self.height is not None

    @property
    def has_holes(self) -> bool:
        """Whether points of the surface may be missing, by their alpha."""
        return self.blend or self.alpha_cutoff is not None


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
    `crease` degrees (which splits vertices along the creases); `uv` (V, 2), v up; `colors` (V, 4) linear RGBA float32;
    `visibility` (V, 1), baked (`aolab.bake`).
    Degenerate triangles are dropped, and normals that cannot shade are made anew: each is counted in a `Notice`.
    `tangents` (V, 4): xyz the direction in which u grows, w the sign of the bitangent w · n × t; made by the MikkTSpace
    convention when None and the material has a normal texture.
    A `Notice` warns of vertices so far from the origin that float32 moves them.
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
    tangents: np.ndarray | None = None
    visibility: np.ndarray | None = None

    def __post_init__(self) -> None:
        what = f"mesh '{self.name}'"
        if not isinstance(self.material, Material):
            raise SceneError(f"{what}: material = {self.material!r:.80} is not a Material")
        faces = np.asarray(self.faces)
        for name in ("vertices", "faces"):
            value = getattr(self, name)
            if not isinstance(value, np.ndarray) and numbers(value) is None:
                raise SceneError(f"{what}: {name} = {value!r:.80} are not numbers")
        if not np.size(self.vertices) or not faces.size:
            raise SceneError(f"{what} is empty: {len(self.vertices)} vertices, {len(faces)} triangles")
        vertices = _array(self.vertices, (3,), np.float32, f"{what}: vertices")
        self._refuse_nonfinite(vertices, f"{what}: vertex")
        self._warn_of_rounding(vertices, what)
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise SceneError(f"{what}: faces have shape {faces.shape}, not (n, 3)")
        wrong = np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))
        if len(wrong):
            raise SceneError(
                f"{what}: triangle {wrong[0]} has indices {faces[wrong[0]].tolist()}, "
                f"but there are {len(vertices)} vertices"
            )
        faces = self._drop_degenerate(vertices, faces.astype(np.uint32), what)
        names = {"normals": (3,), "uv": (2,), "colors": (4,), "tangents": (4,), "visibility": (1,)}
        attributes: dict[str, np.ndarray | None] = dict.fromkeys(names)
        for key, columns in names.items():
            value = getattr(self, key)
            if value is None:
                continue
            attributes[key] = array = _array(value, columns, np.float32, f"{what}: {key}")
            if len(array) != len(vertices):
                raise SceneError(f"{what}: {len(array)} {key} for {len(vertices)} vertices")
            self._refuse_nonfinite(array, f"{what}: {key} of vertex")
        material = self.material
        if (material.texture is not None or material.emission_texture is not None) and attributes["uv"] is None:
            notice(f"{what}: a texture but no uv; drawn in its base colour")
            object.__setattr__(self, "material", replace(material, texture=None, emission_texture=None))
        if self.material.bends_normals and attributes["uv"] is None:
            notice(f"{what}: a normal map or a height map but no uv; drawn without")
            object.__setattr__(self, "material", replace(self.material, normal_texture=None, height=None))
        vertices, faces, source, attributes["normals"] = self._with_normals(
            vertices, faces, attributes["normals"], what
        )
        if source is not None:
            for key in ("uv", "colors", "tangents", "visibility"):
                array = attributes[key]
                attributes[key] = None if array is None else array[source]
        uv, tangents = attributes["uv"], attributes["tangents"]
        if tangents is None and self.material.normal_texture is not None and uv is not None:
            vertices, faces, source, attributes["tangents"] = mikktspace(vertices, faces, attributes["normals"], uv)
            for key in ("normals", "uv", "colors", "visibility"):
                array = attributes[key]
                attributes[key] = None if array is None else array[source]
        for key, array in {"vertices": vertices, "faces": faces, **attributes}.items():
            if array is not None:
                array = np.ascontiguousarray(array)
                array.flags.writeable = False
            object.__setattr__(self, key, array)

    def _with_normals(
        self, vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray | None, what: str
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray | None, np.ndarray]:
        """Vertices, faces and normals, and the source of each vertex where vertices were split, else None."""
        count = len(vertices)
        if normals is not None and not np.abs(normals).max() > NO_LENGTH:
            notice(f"{what}: its {count} normals have no length; made from the faces")
            normals = None
        if normals is None:
            return smooth_normals(vertices, faces, self.crease)
        vertices, faces, source, normals, made, flat = usable_normals(vertices, faces, normals)
        if made:
            text = f"{what}: {made} of {count} normals have no length; made from the faces"
            notice(text)
        if flat:
            text = f"{what}: the normals of {flat} of {len(faces)} triangles lie in the triangle's plane; made from it"
            notice(text)
        return vertices, faces, source if flat else None, normals

    @cached_property
    def bounds(self) -> np.ndarray:
        """(2, 3) float64: the least and greatest local coordinates."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)], np.float64)

    @property
    def is_patterned(self) -> bool:
        """Whether the albedo may vary over the mesh: it has a texture, or colours of vertices."""
        return self.material.texture is not None or self.colors is not None

    @cached_property
    def is_smooth(self) -> bool:
        """Whether the normals of a vertex and of a triangle there differ, as on a curved surface."""
        assert self.normals is not None  # __post_init__ makes them
        a, b, c = np.moveaxis(self.vertices.astype(np.float64)[self.faces], 1, 0)
        facets = np.cross(b - a, c - a)
        along = (self.normals[self.faces] * facets[:, None]).sum(axis=2)
        lengths = np.linalg.norm(self.normals, axis=1)[self.faces] * np.linalg.norm(facets, axis=1)[:, None]
        return bool((np.abs(along) < (1 - ALIKE) * lengths).any())

    @cached_property
    def chunk_bounds(self) -> np.ndarray:
        """(chunks, 2, 3) float64: the bounds of each `CHUNK` triangles, in their order."""
        corners = self.vertices[self.faces].reshape(-1, 3).astype(np.float64)
        starts = np.arange(0, len(corners), 3 * CHUNK)
        return np.stack([np.minimum.reduceat(corners, starts), np.maximum.reduceat(corners, starts)], axis=1)

    def chunk(self, number: int) -> np.ndarray:
        """(n, 3): the triangles of a chunk."""
        return self.faces[number * CHUNK : (number + 1) * CHUNK]

    @cached_property
    def welded(self) -> tuple[np.ndarray, np.ndarray]:
        """The mesh with vertices at one place as one: points (P, 3), and the triangles' edges (3 F, 2) between them.

        An edge leads from corner to corner in the order of its triangle. Rows n, n + F, n + 2 F belong to triangle n.
        """
        points, point = np.unique(self.vertices, axis=0, return_inverse=True)
        corners = point.reshape(-1)[self.faces]
        edges = np.concatenate([corners[:, (0, 1)], corners[:, (1, 2)], corners[:, (2, 0)]])
        return points.astype(np.float64), edges

    @cached_property
    def is_closed(self) -> bool:
        """Whether every edge joins two triangles (or four, ...): the mesh bounds a solid."""
        points, edges = self.welded
        _, uses = np.unique(_numbers(np.sort(edges, axis=1), len(points)), return_counts=True)
        return bool((uses % 2 == 0).all())

    @cached_property
    def is_solid(self) -> bool:
        """Whether each part of the mesh is closed, with the fronts of its triangles outside, counterclockwise.

        A ray from outside meets a front first. Triangles that share a point belong to one part.
        """
        points, edges = self.welded
        forth, back = _numbers(edges, len(points)), _numbers(edges[:, ::-1], len(points))
        if not np.array_equal(np.sort(forth), np.sort(back)):  # of two triangles at an edge, one runs forth, one back
            return False
        part = connected(len(points), edges)[edges[: len(self.faces), 0]]
        a, b, c = np.moveaxis(self.vertices.astype(np.float64)[self.faces] - self.bounds.mean(axis=0), 1, 0)
        volumes = np.bincount(part, (np.cross(a, b) * c).sum(axis=1))
        return bool((volumes[np.unique(part)] > 0).all())

    @cached_property
    def local_maxima(self) -> tuple[np.ndarray, np.ndarray]:
        """Points (n, 3) of local space, higher than their neighbours along one of `local_maxima.AXES`, and which."""
        return local_maxima(*self.welded)

    @staticmethod
    def _refuse_nonfinite(array: np.ndarray, what: str) -> None:
        wrong = np.flatnonzero(~np.isfinite(array).all(axis=1))
        if len(wrong):
            raise SceneError(
                f"{what} {wrong[0]} is {array[wrong[0]].tolist()}; {len(wrong)} of {len(array)} are not finite"
            )

    def _warn_of_rounding(self, vertices: np.ndarray, what: str) -> None:
        given = np.asarray(self.vertices)
        if given.dtype != np.float64:
            return
        moved, extent = np.abs(vertices - given).max(), np.ptp(vertices, axis=0).max()
        if moved > 1e-4 * extent:
            notice(
                f"{what}: float32 moves its vertices by up to {moved:.2g} units, so far are they from the origin; "
                "subtract their centre, and give it to the Instance as a translation"
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
            notice(f"{what}: dropped {dropped} of {len(faces)} triangles, degenerate (no area)")
        return faces[keep]


def _numbers(edges: np.ndarray, count: int) -> np.ndarray:
    """(E,): a number for each of the `edges` (E, 2) between `count` points; equal edges have equal numbers."""
    return edges[:, 0].astype(np.int64) * count + edges[:, 1]
