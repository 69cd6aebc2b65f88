"""Studies of many renders: rankings, benchmarks, curves of error against time, fitted parameters."""

from .ranking import Entry, Ranking, compare_modules, sheet

__all__ = ["Entry", "Ranking", "compare_modules", "sheet"]
