"""Occluders: a grid of voxels over the scene, a bit each, made in one pass over the triangles."""

from typing import Literal

import numpy as np

from ...errors import ParameterError, SceneError
from ...gl.bindings import Bindings
from ...maths.transforms import orthographic
from ...scene.scene import Scene
from ...scene.view import Projection, View, matrix_bytes
from ..parameters import parameter
from ..passes import GeometryPass, Pass
from .base import Drawing, OccluderKind, Occluders, Textures

SLICES = 128  # bits of an RGBA32UI target
MARGIN = 1.001  # of the scene's radius: no vertex on the grid's border
# the two further views along x and along y, as rotations of the grid's axes
ALONG = (np.eye(3), np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]), np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]))


class Voxels(OccluderKind):
    """A grid of `voxels`³ bits around the scene (Eisemann and Décoret 2006; HAO, Reinbothe et al. 2009, section 5).

    An orthographic camera draws all triangles once, without a depth test. Each fragment sets the bits of the slices
    that it spans. Triangles that this camera sees edge-on leave no fragment, so the grid is turned by a random rotation.
    With `voxel_axes` 3, each triangle is drawn along the axis that its normal is nearest to: no hole is left.
    """

    name = "voxels"
    shader = "occluders/voxels.glsl"
    uniforms = ("voxel_from_view", "view_from_voxel")

    voxels: int = parameter(256, "Voxels along each side of the grid; a multiple of 32.", ge=32, le=1024)
    voxel_axes: Literal[1, 3] = parameter(1, "Axes that triangles are drawn along: one, as in the paper, or three.")
    voxel_turn: int = parameter(1, "Seed of the grid's rotation; 0 leaves it along the world's axes.", ge=0, le=1 << 30)

    def draw(self, drawing: Drawing, view: View, surfaces: Textures, sends: bool) -> Occluders:
        if self.voxels % 32:
            raise ParameterError(f"voxels = {self.voxels} is not a multiple of 32: each texel holds 32 slices")
        if self.voxel_axes == 3 and self.voxels > 2 * SLICES:
            raise ParameterError(f"voxels = {self.voxels}: with voxel_axes = 3 the largest grid is {2 * SLICES}")
        scene = drawing.scene
        if not scene.radius > 0:
            raise SceneError(f"scene '{scene.name}' has no extent; a grid of voxels needs a volume")
        grids = [self._drawn(drawing, view, axis) for axis in range(self.voxel_axes)]
        clip_from_world = _clip_from_world(scene, self._rotation())
        voxel_from_clip = np.diag([0.5, 0.5, 0.5, 1.0]) @ _shift(1.0)
        voxel_from_world = np.diag([self.voxels] * 3 + [1.0]) @ voxel_from_clip @ clip_from_world
        voxel_from_view = voxel_from_world @ np.linalg.inv(view.camera.view_from_world)
        uniforms = {
            "voxel_from_view": matrix_bytes(voxel_from_view),
            "view_from_voxel": matrix_bytes(np.linalg.inv(voxel_from_view)),
        }
        return Occluders(self.bindings(self._packed(drawing, grids), uniforms))

    def _rotation(self) -> np.ndarray:
        """(3, 3): the grid's axes, as rows, in world space."""
        if self.voxel_turn == 0:
            return np.eye(3)
        q, r = np.linalg.qr(np.random.default_rng(self.voxel_turn).normal(size=(3, 3)))
        q = q * np.sign(np.diag(r))
        return q * np.sign(np.linalg.det(q))

    @property
    def _targets(self) -> int:
        return -(-self.voxels // SLICES)

    def _drawn(self, drawing: Drawing, view: View, axis: int) -> Textures:
        """The bits seen along one axis of the grid: texel (x, y), bit z."""
        outputs = {f"voxels{axis}_{number}": "RGBA32UI" for number in range(self._targets)}
        size = self.voxels, self.voxels
        rotation = ALONG[axis] @ self._rotation()

        def seen_from(scene: Scene, view: View) -> Projection:
            far = 2 * MARGIN * scene.radius
            matrix = np.eye(4)
            matrix[:3, :3] = rotation
            matrix[:3, 3] = -rotation @ scene.bounds.mean(axis=0) - (0, 0, far / 2)
            return Projection(matrix, orthographic(far / 2, far), size)

        step = GeometryPass(
            "voxels",
            "pipeline/voxelize.frag",
            outputs,
            constants={"targets": self._targets, "slices": self.voxels, "dominant": self.voxel_axes == 3},
            vertex="pipeline/voxelize.vert",
            geometry="pipeline/voxelize.geom",
            writes={f"bits[{number}]": name for number, name in enumerate(outputs)},
            seen_from=seen_from,
            combine="or",
        )
        return drawing.draw(step, view)

    def _packed(self, drawing: Drawing, grids: list[Textures]) -> Textures:
        """`voxelWords` (R32UI): tiles of N × N texels, 32 slices each, eight tiles in a row."""
        columns = min(8, self.voxels // 32)
        rows = -(-self.voxels // 32 // columns)
        textures = {}
        for axis, grid in enumerate(grids):
            names = list(grid)
            for number in range(8 if axis == 0 else 2):  # samplers must be bound
                textures[f"bits{axis}_{number}"] = grid[names[min(number, len(names) - 1)]]
        step = Pass(
            "pack voxels",
            "pipeline/pack_voxels.frag" if len(grids) == 1 else "pipeline/merge_voxels.frag",
            {"voxelWords": "R32UI"},
            {"slices": self.voxels, "targets": self._targets, "columns": columns},
            writes={"word": "voxelWords"},
        )
        size = columns * self.voxels, rows * self.voxels
        return drawing.run(step, [Bindings("the voxels' views", textures)], size)


def _clip_from_world(scene: Scene, rotation: np.ndarray) -> np.ndarray:
    """World space to the cube -1 to 1 around the scene, with the slices' order: z grows away from the camera."""
    matrix = np.eye(4)
    matrix[:3, :3] = np.diag([1, 1, -1]) @ rotation / (MARGIN * scene.radius)
    matrix[:3, 3] = -matrix[:3, :3] @ scene.bounds.mean(axis=0)
    return matrix


def _shift(by: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = by
    return matrix
