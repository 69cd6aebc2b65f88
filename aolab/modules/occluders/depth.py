"""Occluders: the camera's one depth layer, which the G-buffer holds."""

from .base import OccluderKind


class Depth(OccluderKind):
    """The first surface along each ray of the camera: nothing to draw beyond the G-buffer."""

    name = "depth"
    shader = "occluders/depth.glsl"
