"""Rays against triangles: Embree, and a plain caster in NumPy for tiny scenes, which also checks Embree.

Both have two functions of `origins` and unit `directions`, (n, 3) float32, and of a `limit` (distance in scene units,
which may be infinite). `occluded` tests for a nearer surface, `first_hit` returns the nearest. Triangles are two-sided.
"""

from typing import Literal, NamedTuple, Protocol, get_args

import numpy as np

from ..errors import ParameterError, suggestion
from ..extras import missing

Engine = Literal["auto", "embree", "numpy"]
NUMPY_LIMIT = 20_000  # triangles; at about 1e8 ray-triangle tests a second this is already 5000 rays a second


class Hits(NamedTuple):
    """The nearest triangle along each ray: the point is (1 - u - v) A + u B + v C."""

    distance: np.ndarray  # (n,) float32, inf where nothing is hit
    triangle: np.ndarray  # (n,) int32, -1 where nothing is hit
    u: np.ndarray  # (n,) float32
    v: np.ndarray  # (n,) float32


class Caster(Protocol):
    """The functions of both engines."""

    def occluded(self, origins: np.ndarray, directions: np.ndarray, limit: np.ndarray | float) -> np.ndarray:
        """(n,) bool."""
        ...

    def first_hit(self, origins: np.ndarray, directions: np.ndarray, limit: np.ndarray | float) -> Hits:
        """The nearest hits."""
        ...


class EmbreeCaster:
    """Embree (Wald et al. 2014) through embreex, one call for many rays, during which other threads run."""

    def __init__(self, triangles: np.ndarray) -> None:
        """`triangles` (t, 3, 3) float32."""
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self._scene = EmbreeScene(robust=True)  # no ray slips through between two triangles
        TriangleMesh(self._scene, np.ascontiguousarray(triangles, np.float32))
        nowhere = np.zeros((1, 3), np.float32)
        self._scene.run(nowhere, nowhere + 1, query="OCCLUDED")  # builds the hierarchy now, in one thread

    def occluded(self, origins: np.ndarray, directions: np.ndarray, limit: np.ndarray | float) -> np.ndarray:
        return self._scene.run(origins, directions, dists=_limits(limit, origins), query="OCCLUDED") >= 0

    def first_hit(self, origins: np.ndarray, directions: np.ndarray, limit: np.ndarray | float) -> Hits:
        found = self._scene.run(origins, directions, dists=_limits(limit, origins), output=True)
        distance = np.where(found["primID"] >= 0, found["tfar"], np.float32(np.inf))
        return Hits(distance, found["primID"], found["u"], found["v"])


class NumpyCaster:
    """Möller and Trumbore 1997 for every ray and every triangle, in float64; only for tiny scenes."""

    PAIRS = 1_000_000  # of rays and triangles at a time: bounds the memory to about 200 MB

    def __init__(self, triangles: np.ndarray) -> None:
        """`triangles` (t, 3, 3)."""
        if len(triangles) > NUMPY_LIMIT:
            raise ParameterError(
                f"engine = 'numpy' is for tiny scenes, up to {NUMPY_LIMIT} triangles; this one has {len(triangles)}. "
                "Install embreex and choose engine='embree'"
            )
        corner = np.asarray(triangles, np.float64)
        self._corner, self._edge1, self._edge2 = corner[:, 0], corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]

    def occluded(self, origins: np.ndarray, directions: np.ndarray, limit: np.ndarray | float) -> np.ndarray:
        return self.first_hit(origins, directions, limit).triangle >= 0

    def first_hit(self, origins: np.ndarray, directions: np.ndarray, limit: np.ndarray | float) -> Hits:
        limits = _limits(limit, origins)
        step = max(1, self.PAIRS // len(self._corner))
        parts = [
            self._nearest(*(array[i : i + step] for array in (origins, directions, limits)))
            for i in range(0, len(origins), step)
        ]
        if not parts:
            return Hits(*(np.zeros(0, dtype) for dtype in (np.float32, np.int32, np.float32, np.float32)))
        return Hits(*(np.concatenate(column) for column in zip(*parts, strict=True)))

    def _nearest(self, origins: np.ndarray, directions: np.ndarray, limits: np.ndarray) -> Hits:
        direction = directions.astype(np.float64)[:, None]
        p = np.cross(direction, self._edge2)
        determinant = (self._edge1 * p).sum(-1)
        with np.errstate(divide="ignore", invalid="ignore"):  # a ray in the triangle's plane misses it
            inverse = 1 / determinant
            from_corner = origins.astype(np.float64)[:, None] - self._corner
            u = (from_corner * p).sum(-1) * inverse
            q = np.cross(from_corner, self._edge1)
            v = (direction * q).sum(-1) * inverse
            t = (self._edge2 * q).sum(-1) * inverse
            inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= limits[:, None])
        t = np.where(inside, t, np.inf)
        nearest = t.argmin(axis=1)
        row = np.arange(len(t))
        hit = np.isfinite(t[row, nearest])
        u, v = (np.where(hit, a[row, nearest], 0).astype(np.float32) for a in (u, v))
        return Hits(t[row, nearest].astype(np.float32), np.where(hit, nearest, -1).astype(np.int32), u, v)


def caster(engine: Engine, triangles: np.ndarray) -> Caster:
    """The caster by name; `auto` is Embree. Raises `ParameterError`, also without Embree."""
    if engine not in get_args(Engine):
        raise ParameterError(f"engine = {engine!r} is unknown{suggestion(str(engine), get_args(Engine))}")
    if engine == "numpy":
        return NumpyCaster(triangles)
    try:
        return EmbreeCaster(triangles)
    except ImportError as error:
        raise missing("embree", error, ", or engine='numpy', which is slow and for tiny scenes") from error


def _limits(limit: np.ndarray | float, origins: np.ndarray) -> np.ndarray:
    """(n,) float32, a copy, since Embree writes the distance of the hit into it."""
    return np.array(np.broadcast_to(np.asarray(limit, np.float32), len(origins)))
