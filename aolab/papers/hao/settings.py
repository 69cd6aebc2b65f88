"""The paper's settings, Table 1, and measures that figures share."""

from dataclasses import replace

import numpy as np

from ...modules import HAO
from ...pipeline.frame import Frame
from ...scene.scene import Scene
from ..timing import Cost

SIZE = (800, 600)
# Table 1: the map is half as large in each direction
TABLE_1 = HAO(directions=32, steps=8, voxels=256, filter_size=16, scale=0.5)
OWN = ("voxels", "pack voxels", "hao", "upsample", "filter")  # the method's passes


def own_cost(cost: Cost) -> float:
    """Milliseconds of the method's own passes."""
    return sum(cost.of(stem) for stem in OWN)


def occlusion(frame: Frame) -> np.ndarray:
    """(H, W): 1 - visibility; 0 in the background."""
    return np.where(frame.mask, 1 - frame["visibility"], 0)


def voxelised_anew(scene: Scene) -> Scene:
    """The same scene with other instances of the same meshes, so that its grid is not known yet."""
    return scene.replace(instances=tuple(replace(instance) for instance in scene.instances))
