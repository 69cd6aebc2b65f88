"""No occlusion: what every method is compared with first."""

from .base import Module


class Unoccluded(Module):
    """Everything is open: visibility is 1, and ambient light reaches every corner."""

    name = "none"
    title = "No occlusion"
    paper = "The environment's irradiance alone: Ramamoorthi and Hanrahan 2001"
    shader = "none.frag"
