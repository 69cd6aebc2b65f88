"""HAO's filter: a separable bilateral filter at full size, weighted by Wendland's kernel."""

from collections.abc import Mapping

from ..parameters import parameter
from ..passes import Pass
from .base import Filter, over_sources


class Wendland(Filter):
    """Weights over a row, then over a column: by distance on the screen and in space, normal, and value (HAO 2009,
    section 7). It runs on the values at full size."""

    name = "wendland"
    at_full_size = True

    filter_size: int = parameter(16, "Window of the filter, in pixels of the image.", ge=2, le=64)
    filter_distance: float = parameter(
        0.05,
        "Distance in space beyond which a neighbour has no weight, as a share of its viewing distance.",
        gt=0,
        le=1,
    )

    def reach(self) -> int:
        return self.filter_size // 2

    def passes(self, formats: Mapping[str, str]) -> list[Pass]:
        shader = "pipeline/wendland.frag"
        return [over_sources("filter", shader, formats, vertical=vertical) for vertical in (False, True)]
