"""No occlusion: the baseline for every method."""

from .base import Module


class Unoccluded(Module):
    """Every direction is open: the visibility is 1, and ambient light reaches every corner."""

    name = "none"
    title = "No occlusion"
    paper = "The environment's irradiance alone: Ramamoorthi and Hanrahan 2001"
    shader = "none.frag"
