"""Screen-space ambient occlusion over the hemisphere."""

from .marched import Marched
from .parameters import parameter


class SSAO(Marched):
    """The share of cosine-distributed directions in which the depth buffer blocks nothing within the radius.

    Directions are marched in `steps` points, jittered along the way; with many steps and `accumulate`, this converges
    to rays of length `radius` against the one layer that the camera sees.
    """

    name = "ssao"
    title = "Screen-space ambient occlusion"
    paper = "Mittring 2007, Finding Next Gen: CryEngine 2; hemisphere form: Filion and McNaughton 2008"
    shader = "ssao.frag"

    power: float = parameter(1.0, "Contrast: visibility is raised to it; 1 is the physical value.", gt=0, le=8)
