"""The fuzzy measures. This table is all the registry there is."""

from .base import Measure
from .curves import Classical, Exponential, Linear, Sqrt

MEASURES: dict[str, type[Measure]] = {measure.name: measure for measure in (Classical, Linear, Sqrt, Exponential)}

__all__ = ["MEASURES", "Classical", "Exponential", "Linear", "Measure", "Sqrt"]
