"""The ray-traced truth, with which every method is compared, pixel by pixel."""

from .reference import reference

__all__ = ["reference"]
