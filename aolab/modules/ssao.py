"""Screen-space ambient occlusion over the hemisphere."""

from ..kernels import cosine_hemisphere
from ..parameters import parameter
from .base import Bias, Directions, Falloff, Module, Radius, Steps, Thickness


class SSAO(Module):
    """The share of cosine-distributed directions in which the depth buffer blocks nothing within the radius.

    Directions are marched in `steps` points, jittered along the way; with many steps and `accumulate`, this converges
    to rays of length `radius` against the one layer that the camera sees.
    """

    name = "ssao"
    title = "Screen-space ambient occlusion"
    paper = "Mittring 2007, Finding Next Gen: CryEngine 2; hemisphere form: Filion and McNaughton 2008"
    shader = "ssao.frag"

    radius: Radius = "auto"
    directions: Directions = 8
    steps: Steps = 4
    bias: Bias = 0.01
    falloff: Falloff = 0.3
    thickness: Thickness = 0.9
    power: float = parameter(1.0, "Contrast: visibility is raised to it; 1 is the physical value.", gt=0, le=8)

    def samples(self, seed: int) -> dict[str, bytes]:
        return {"kernel": cosine_hemisphere(self.directions, seed, self.falloff).tobytes()}
