"""Occluders: a grid of voxels, a bit each, made in one pass over the triangles."""

from dataclasses import dataclass
from typing import Literal

import moderngl
import numpy as np

from ...errors import ParameterError
from ...gl import context
from ...gl.bindings import Bindings
from ...maths.transforms import orthographic
from ...scene.scene import Scene
from ...scene.view import Projection, View, matrix_bytes, moved
from ..parameters import parameter
from ..passes import GeometryPass, Pass
from .base import Drawing, OccluderKind, Occluders, Textures
from .region import Box, region_of

SLICES = 128  # bits of an RGBA32UI target
MARGIN = 1.001  # of the region: no vertex lies on the grid's border
# the three views of a grid, as permutations of its axes: along z, along x, along y
ALONG = (np.eye(3), np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]), np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]))


class Voxels(OccluderKind):
    """A grid of `voxels`³ bits over a region (Eisemann and Décoret 2006; HAO, Reinbothe et al. 2009, section 5).

    An orthographic camera draws all triangles once, without a depth test, and each fragment sets the bits of the slices
    that its triangle spans. Every voxel is set that a triangle touches. With `voxel_exact=False`, as in the paper,
    triangles that the camera sees edge-on leave no voxels, so the grid is turned by a random rotation. With
    `voxel_axes=3`, each triangle is drawn along the axis that its normal is nearest to, which closes those holes too.
    The grid of a still scene is kept between frames.
    """

    name = "voxels"
    shader = "occluders/voxels.glsl"
    uniforms = ("voxel_from_view", "view_from_voxel", "region_from_view")

    voxels: int = parameter(256, "Voxels along each side of the grid; a multiple of 32.", ge=32, le=1024)
    voxel_axes: Literal[1, 3] = parameter(
        1, "Axes that triangles are drawn along: one, as in the paper, or three; an exact grid needs one."
    )
    voxel_exact: bool = parameter(
        True,
        "Set every voxel that a triangle touches; else, as in the paper, the slices that it spans in the pixels whose "
        "centre it covers.",
    )
    voxel_turn: int = parameter(1, "Seed of the grid's rotation; 0 leaves it along the world's axes.", ge=0, le=1 << 30)
    voxel_region: str | Box = parameter(
        "scene",
        "Region of the grid: the `scene`, a box of two corners in world space, or the name of an object to follow.",
    )

    def draw(self, drawing: Drawing, view: View, surfaces: Textures, sends: bool) -> Occluders:
        check_size(self.voxels, context.get().info["GL_MAX_DRAW_BUFFERS"])
        scene = drawing.scene
        box = region_of(scene, self.voxel_region)
        grid = Grid(box, rotation(self.voxel_turn), self.voxels)
        key = (scene.instances, box.tobytes(), self.voxels, self.voxel_axes, self.voxel_exact, self.voxel_turn)
        textures = drawing.kept(self.name, key, lambda: self._drawn(drawing, view, grid))
        world_from_view = np.linalg.inv(view.camera.view_from_world)
        voxel_from_view = grid.voxel_from_world @ world_from_view
        uniforms = {
            "voxel_from_view": matrix_bytes(voxel_from_view),
            "view_from_voxel": matrix_bytes(np.linalg.inv(voxel_from_view)),
            "region_from_view": matrix_bytes(_cube_from(box) @ world_from_view),
        }
        return Occluders(self.bindings(textures, uniforms))

    def _drawn(self, drawing: Drawing, view: View, grid: "Grid") -> Textures:
        """`voxelWords`, R32UI: tiles of N × N texels, 32 slices each, eight tiles in a row."""
        axes = range(self._axes)
        words = {f"words{axis}": self._words(drawing, view, grid, axis) for axis in axes}
        if len(words) == 1:
            return {"voxelWords": words["words0"]}
        return drawing.run(self._packing("merge_voxels"), [Bindings("the voxels' views", words)], self._packed_size)

    def _words(self, drawing: Drawing, view: View, grid: "Grid", axis: int) -> moderngl.Texture:
        """The packed words of the grid as it is drawn along one axis."""
        outputs = {f"bits{number}": "RGBA32UI" for number in range(self._targets)}
        step = GeometryPass(
            "voxels",
            "pipeline/voxelize.frag",
            outputs,
            constants={
                "targets": self._targets,
                "slices": self.voxels,
                "dominant": self._axes == 3,
                "voxel_exact": self.voxel_exact,
            },
            vertex="pipeline/voxelize.vert",
            geometry="pipeline/voxelize.geom",
            writes={f"bits[{number}]": name for number, name in enumerate(outputs)},
            seen_from=lambda scene, _: grid.seen_along(axis, scene),
            combine="or",
        )
        bits = drawing.draw(step, view)
        given = {f"bits{number}": bits[f"bits{min(number, self._targets - 1)}"] for number in range(8)}
        packed = drawing.run(self._packing("pack_voxels"), [Bindings("the voxels' view", given)], self._packed_size)
        return packed["voxelWords"]

    def _packing(self, shader: str) -> Pass:
        return Pass(
            shader.replace("_", " "),
            f"pipeline/{shader}.frag",
            {"voxelWords": "R32UI"},
            {"slices": self.voxels, "targets": self._targets, "columns": self._columns},
            writes={"word": "voxelWords"},
        )

    @property
    def _axes(self) -> int:
        return 1 if self.voxel_exact else self.voxel_axes

    @property
    def _targets(self) -> int:
        return -(-self.voxels // SLICES)

    @property
    def _columns(self) -> int:
        return min(8, self.voxels // 32)

    @property
    def _packed_size(self) -> tuple[int, int]:
        return self._columns * self.voxels, -(-self.voxels // 32 // self._columns) * self.voxels


def check_size(voxels: int, targets: int) -> None:
    """Raise `ParameterError` for a grid that needs more than `targets` targets, or that is no multiple of 32."""
    if voxels % 32:
        raise ParameterError(f"voxels = {voxels} is not a multiple of 32: a texel holds 32 slices")
    if voxels > targets * SLICES:
        raise ParameterError(
            f"voxels = {voxels} needs {-(-voxels // SLICES)} targets of {SLICES} slices; this driver has {targets}: "
            f"the largest grid is {min(1024, targets * SLICES)}"
        )


def rotation(seed: int) -> np.ndarray:
    """(3, 3): the grid's axes, as rows, in world space; the identity for seed 0, else uniformly random."""
    if seed == 0:
        return np.eye(3)
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


@dataclass(frozen=True, eq=False)
class Grid:
    """A grid of `voxels`³ around a world-space `box` (2, 3), with the rows of `axes` (3, 3) as its axes.

    Voxels are boxes: each side of the grid is as long as the region is along it. The third index grows against the
    third axis, away from the camera that draws the grid.
    """

    box: np.ndarray
    axes: np.ndarray
    voxels: int

    @property
    def half(self) -> np.ndarray:
        """(3,): half the length of the grid's sides, in scene units; of a flat region, at least two voxels' width."""
        half = MARGIN * np.abs(self.axes) @ np.ptp(self.box, axis=0) / 2
        return np.maximum(half, half.max() * 2 / self.voxels)

    @property
    def voxel_from_world(self) -> np.ndarray:
        """(4, 4): the integer part of a coordinate is the index of a voxel."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.voxels / 2 * np.diag([1, 1, -1] / self.half) @ self.axes
        matrix[:3, 3] = self.voxels / 2 - matrix[:3, :3] @ self.box.mean(axis=0)
        return matrix

    def seen_along(self, axis: int, scene: Scene) -> Projection:
        """The orthographic camera that draws the grid along one of its axes."""
        axes, half = ALONG[axis] @ self.axes, ALONG[axis] @ self.half
        matrix = np.eye(4)
        matrix[:3, :3] = axes
        matrix[:3, 3] = -axes @ self.box.mean(axis=0) - (0, 0, half[2])
        clip_from_view = orthographic(half[0], half[1], 0.0, 2 * half[2])
        return Projection(matrix @ moved(scene.shader_origin), clip_from_view, (self.voxels, self.voxels))


def _cube_from(box: np.ndarray) -> np.ndarray:
    """(4, 4): world space to coordinates in which the box is the cube -1 to 1."""
    half = np.maximum(np.ptp(box, axis=0) / 2, 1e-30)
    matrix = np.diag([*1 / half, 1.0])
    matrix[:3, 3] = -box.mean(axis=0) / half
    return matrix
