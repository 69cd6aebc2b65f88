"""The mean of 4×4 pixels of one surface: every set of the interleaved pattern once."""

from collections.abc import Mapping

from ..passes import Pass
from .base import Filter, over_sources


class Box4(Filter):
    """The mean over 4 pixels of a row, then of a column, that lie on the same surface (Umenhoffer et al. 2009)."""

    name = "box4"

    def reach(self) -> int:
        return 2

    def passes(self, formats: Mapping[str, str]) -> list[Pass]:
        shader = "pipeline/box4.frag"
        return [over_sources("filter", shader, formats, vertical=vertical) for vertical in (False, True)]
