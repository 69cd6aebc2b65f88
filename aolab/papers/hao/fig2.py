"""HAO, figure 2: the grid at three resolutions."""

from itertools import pairwise

from ...gl.texture import Size
from ...loading import load
from ...modules import VoxelView
from ...pipeline.api import shared_lab
from ..figure import Figure, Need, figure

VOXELS = (64, 128, 256)


def fig2(size: Size = (480, 270)) -> Figure:
    """The voxels of a colonnade, for grids of 64³, 128³ and 256³.

    Numbers, of the camera's pixels: the share of the surface that the voxels cover, and the share of the surface that
    they add around its silhouettes.
    """
    scene, lab = load("colonnade"), shared_lab()
    frames = {count: lab.render(scene, VoxelView(voxels=count), size=size) for count in VOXELS}
    covered, excess = {}, {}
    for count, frame in frames.items():
        drawn, surface = frame["voxel_grid"].min(axis=-1) < 1, frame.mask
        covered[count] = float(drawn[surface].mean())
        excess[count] = float((drawn & ~surface).sum() / surface.sum())
    ratios = [excess[fine] / excess[coarse] for coarse, fine in pairwise(VOXELS)]
    needs = [
        Need("the share of the surface that voxels cover, the least", min(covered.values()), above=0.999),
        Need("the excess at silhouettes over that of half as many voxels, the least", min(ratios), above=0.3),
        Need("the excess at silhouettes over that of half as many voxels, the most", max(ratios), below=0.75),
    ]
    claim = "The grid covers the surface at every resolution, and a grid twice as fine has half the excess"
    numbers = {"covered": covered, "excess": excess}
    pictures = [(f"{count}³ voxels", frame["voxel_grid"]) for count, frame in frames.items()]
    shown = [(name, (picture * 255).astype("uint8")) for name, picture in pictures]
    return figure("HAO, Fig. 2", claim, needs, numbers, shown, 3)
