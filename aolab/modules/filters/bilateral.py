"""A separable bilateral filter over 8×8 pixels, by the distance to the tangent plane and by the normal."""

from collections.abc import Mapping

from ..passes import Pass
from .base import Filter, over_sources


class Bilateral(Filter):
    """Weights over 8 pixels of a row, then of a column, by geometry (Herholz et al. 2012)."""

    name = "bilateral"

    def reach(self) -> int:
        return 4

    def passes(self, formats: Mapping[str, str]) -> list[Pass]:
        shader = "pipeline/bilateral.frag"
        return [over_sources("filter", shader, formats, vertical=vertical) for vertical in (False, True)]
