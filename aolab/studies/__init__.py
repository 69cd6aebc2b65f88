"""Results of many renders: rankings, benchmarks, curves, tuning."""

from .ranking import Entry, compare_modules, sheet

__all__ = ["Entry", "compare_modules", "sheet"]
