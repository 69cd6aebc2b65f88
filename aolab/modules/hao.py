"""Hybrid ambient occlusion: rays through a grid of voxels, for a small map that joint bilateral filtering brings up."""

from typing import ClassVar, Literal

from ..maths.sampling import uniform_cone
from .base import Directions, FilterByName, Module, OccludersByName, Radius, Steps
from .occluders.region import WHOLE
from .parameters import parameter
from .passes import Pass
from .question import Question


class HAO(Module):
    """The share of a cone of directions that a grid of voxels leaves open, with occluders fading by Wendland's kernel.

    The grid holds surfaces behind others and outside the picture, so they darken too. Noise depends on the place in the
    world, so that a moving camera leaves it where it is.
    """

    name = "hao"
    title = "Hybrid ambient occlusion"
    paper = "Reinbothe, Boubekeur and Alexa 2009, Hybrid Ambient Occlusion"
    shader = "hao.frag"
    outputs: ClassVar = {"visibility": "R16F"}

    radius: Radius = "auto"
    directions: Directions = 32
    steps: Steps = 8
    spread: float = parameter(
        1.0, "Half-angle of the cone of directions around the normal, in right angles; 1 is the hemisphere.", gt=0, le=1
    )
    occluders: OccludersByName = parameter("voxels", "The occluders: a grid of `voxels`, or another kind.")
    filter: FilterByName = parameter("wendland", "Noise removal: the paper's separable bilateral filter, or another.")
    scale: float = parameter(0.5, "Resolution of the estimate as a share of the image's.", ge=0.125, le=1)

    outside: Literal["open", "baked"] = parameter(
        "open",
        "Visibility outside the region of the voxels: open, or that which `aolab.bake` has baked into the vertices.",
    )

    def question(self) -> Question:
        return super().question().replace(falloff="wendland", spread=self.spread)

    def passes(self) -> list[Pass]:
        constants = {"lifted": self.occluders != "voxels"}
        if self.occluders != "voxels" or self.values()["voxel_region"] == WHOLE:
            return [Pass("hao", self.shader, self.outputs, constants)]
        inside = Pass("hao", self.shader, {"inside": "R16F"}, constants, writes={"visibility": "inside"})
        return [
            inside,
            Pass("hao outside", "hao.outside.frag", self.outputs, {"from_vertices": self.outside == "baked"}),
        ]

    def samples(self, seed: int) -> dict[str, bytes]:
        return {"kernel": uniform_cone(self.directions, seed, self.spread).tobytes()}
