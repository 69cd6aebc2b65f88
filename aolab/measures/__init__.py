"""How far a result is from the truth: measures, where in the image they are taken, and pictures of the error."""

from .comparison import Comparison, compare
from .turning_light import Relighting, relight, relighting_error

__all__ = ["Comparison", "Relighting", "compare", "relight", "relighting_error"]
