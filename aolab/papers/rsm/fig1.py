"""RSM and SSAO, figures 1 to 4: the four buffers of a reflective shadow map."""

import numpy as np

from ...gl.texture import Size
from ...modules import RSM
from ...pictures.buffers import buffer_pixels, scale_of
from ...pipeline.api import shared_lab
from ..figure import Figure, Need, figure
from .stage import SPOT, stage

BUFFERS = {"rsm_position": "position", "rsm_normal": "normal", "rsm_flux": "flux", "rsm_depth": "depth"}


def fig1(size: Size = (256, 256)) -> Figure:
    """Position, normal, flux and depth of the room, seen from its lamp; the height of `size` is that of the map.

    Numbers: the greatest difference between the depth and the positions' distance along the axis, scene units; that
    between the normals' lengths and 1; and the map's flux as a share of the spot's, which is the mean albedo that the
    light meets.
    """
    frame = shared_lab().render(stage(), RSM(rsm_resolution=size[1]), size=(64, 48))
    seen = np.isfinite(frame["rsm_depth"])
    way = frame["rsm_position"][seen] - np.asarray(SPOT.position, np.float32)
    axis = np.asarray(SPOT.direction) / np.linalg.norm(SPOT.direction)
    depth = float(np.abs(way @ axis - frame["rsm_depth"][seen]).max())
    length = float(np.abs(np.linalg.norm(frame["rsm_normal"][seen], axis=1) - 1).max())
    # I over the cone: the solid angle of the inner part, and the falloff between the two angles
    low, high = np.cos(np.radians((SPOT.outer, SPOT.inner)))
    sent = np.asarray(SPOT.intensity) * 2 * np.pi * ((1 - high) + (high - low) / 3)
    share = float((frame["rsm_flux"].sum(axis=(0, 1)) / sent).mean())
    needs = [
        Need("depth less the distance of the position along the axis", depth, below=0.01),
        Need("the normals' length less 1", length, below=0.01),
        Need("flux over the spot's, the mean albedo that it meets", share, 0.3, 0.75),
    ]
    pictures = [(BUFFERS[name], buffer_pixels(name, frame[name], scale_of(name, frame[name]))) for name in BUFFERS]
    claim = "Position, normal, flux and depth, seen from the light, describe its bounce"
    numbers = {"depth_difference": depth, "normal_length": length, "flux_over_the_spots": share}
    return figure("RSM and SSAO, Fig. 1 to 4", claim, needs, numbers, pictures, 4)
