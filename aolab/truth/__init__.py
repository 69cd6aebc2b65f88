"""The ray-traced truth: what every method is measured against, pixel by pixel."""

from .reference import reference

__all__ = ["reference"]
