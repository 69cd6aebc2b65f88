"""No occlusion: what every method is compared with first."""

from typing import ClassVar

from .base import Module


class Unoccluded(Module):
    """Everything is open: visibility is 1, and ambient light reaches every corner."""

    name: ClassVar[str] = "none"
    title: ClassVar[str] = "No occlusion"
    paper: ClassVar[str] = "The environment's irradiance alone: Ramamoorthi and Hanrahan 2001"
    shader: ClassVar[str] = "none.frag"
