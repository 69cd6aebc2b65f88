"""How far a result is from the truth: measures, where in the image they are taken, and pictures of the error."""

from .comparison import Comparison, compare
from .ranking import Entry, compare_modules, sheet
from .relighting import Relighting, relight, relighting_error

__all__ = ["Comparison", "Entry", "Relighting", "compare", "compare_modules", "relight", "relighting_error", "sheet"]
