"""A picture of the grid of voxels, as the camera sees it."""

from typing import ClassVar, Literal

from .base import Module
from .buffers import Buffer
from .filters import Unfiltered
from .occluders import Voxels
from .parameters import parameter


class VoxelView(Module):
    """The buffer `voxel_grid` is a picture of the grid that `occluders="voxels"` tests against (HAO 2009, Fig. 2).

    `aolab.render(scene, aolab.VoxelView(voxels=64))["voxel_grid"]` is (H, W, 3) float32, a grey in [0, 1] for each
    face of a voxel, by its angle to the eye. It is no method: it is not in the list of modules, and nothing is shaded.
    """

    name = "voxel_view"
    title = "The grid of voxels"
    paper = "Reinbothe, Boubekeur and Alexa 2009, Hybrid Ambient Occlusion, Fig. 2"
    shader = "voxel_view.frag"
    outputs: ClassVar = {"voxel_grid": "RGBA16F"}
    buffers: ClassVar = (
        Buffer(
            "voxel_grid", 3, "RGBA16F", "", None, "share", "The faces of the voxels that the camera sees, in greys."
        ),
    )
    choices: ClassVar = {"occluders": {"voxels": Voxels}, "filter": {"none": Unfiltered}}

    occluders: Literal["voxels"] = parameter(  # pyright: ignore[reportIncompatibleVariableOverride]
        "voxels", "The occluders that are drawn: the voxels."
    )
    filter: Literal["none"] = parameter("none", "No filter.")  # pyright: ignore[reportIncompatibleVariableOverride]
