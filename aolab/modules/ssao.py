"""Screen-space ambient occlusion over the hemisphere."""

from dataclasses import replace

from .marched import Marched
from .parameters import parameter
from .passes import Pass


class SSAO(Marched):
    """The share of cosine-distributed directions in which the depth buffer blocks nothing within the radius.

    Each direction is tested at `steps` points with varying offsets. With many steps and `accumulate`, the result
    converges to rays of length `radius` against the depth layer that the camera sees.
    """

    name = "ssao"
    title = "Screen-space ambient occlusion"
    paper = "Mittring 2007, Finding Next Gen: CryEngine 2; hemisphere form: Filion and McNaughton 2008"
    shader = "ssao.frag"

    power: float = parameter(
        1.0, "Contrast: the visibility is raised to this power; 1 is the physical value.", gt=0, le=8
    )

    def passes(self) -> list[Pass]:
        return [replace(one, background=self._background(SSAO, 1.0)) for one in super().passes()]
