"""How far a result is from the truth: measures, the regions that they are taken in, and pictures of the error."""

from .comparison import Comparison, compare
from .turning_light import Relighting, relight, relighting_error

__all__ = ["Comparison", "Relighting", "compare", "relight", "relighting_error"]
