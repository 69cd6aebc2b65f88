"""Ambient transfer: obscurances whose occluders have a colour, and so reflect the ambient light."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from ..maths.poisson import poisson_cube
from .base import Bias, Directions, Module, Radius, Steps, Thickness, by_name
from .buffers import Buffer
from .estimate import Estimate
from .measures import MEASURES, Measure
from .parameters import parameter
from .passes import Pass, term
from .question import Question
from .readable import Readable

if TYPE_CHECKING:
    MeasureByName = str | Measure
else:
    MeasureByName = by_name(MEASURES, Measure)

TERMS = {"transfer_terms": "RGBA16F"}


def _obscurance(frame: Readable, raw: str) -> np.ndarray:
    """(H, W): the numerator of equation 9; 0 in the background."""
    return frame.channels(f"transfer_terms{raw}")[..., 3]


def _transfer(frame: Readable, raw: str) -> np.ndarray:
    """(H, W, 3): equation 9; 0/0 is 0. Twin of glsl/ambient_transfer.light.glsl."""
    terms = frame.channels(f"transfer_terms{raw}")
    open, rest = terms[..., 3:], terms[..., :3]
    return np.divide(open, rest, out=np.zeros_like(rest), where=open > 0)


class AmbientTransfer(Module):
    """The share of the ambient light that arrives at a point and its surroundings, all reflections included.

    A fuzzy `measure` decides how open a direction is, by the distance of its occluder (`obscurance`). The occluders
    reflect by their albedo, by the assumption that they are lit as much as the point itself (`transfer`, for each
    colour). White creases stay white, and coloured creases take on the colour. The `visibility` is the obscurance; with
    the measure `classical`, that is the open share of the hemisphere.
    """

    name = "ambient_transfer"
    claims = "ambient"
    title = "Ambient transfer"
    paper = "Umenhoffer, Tóth and Szirmay-Kalos 2009, Efficient Methods for Ambient Lighting"
    shader = "ambient_transfer.frag"
    outputs: ClassVar = TERMS
    derived: ClassVar = {"obscurance": _obscurance, "transfer": _transfer, "visibility": _obscurance}
    buffers: ClassVar = (
        Buffer(
            "transfer_terms", 4, "RGBA16F", "", 0, "numbers",
            "The denominator of the transfer (rgb) and its numerator (a), as means over the samples.",
        ),
        Buffer("reflected_share", 3, "RGBA16F", "", 0, "numbers", "Reflected radiance over the ambient light."),
    )  # fmt: skip
    choices: ClassVar = {**Module.choices, "measure": MEASURES}

    radius: Radius = "auto"
    directions: Directions = 8
    steps: Steps = 2
    bias: Bias = 0.01
    thickness: Thickness = 1.0
    measure: MeasureByName = parameter("sqrt", "How open a direction is, by the distance of its first occluder.")
    albedo_source: Literal["albedo", "radiance"] = parameter(
        "albedo", "The colour of an occluder: its albedo, or the `radiance` that it reflects, so that lamps take part."
    )
    silhouette_elimination: bool = parameter(
        True, "Points farther than `thickness` behind the visible surface are open: a far foreground throws no halo."
    )

    def samples(self, seed: int) -> dict[str, bytes]:
        """Directions with the density cosθ/π from two coordinates of the cube; the third one is for the distance."""
        turn, squared, share = poisson_cube(self.directions, seed).T
        across = np.sqrt(squared)
        ways = [np.cos(2 * np.pi * turn) * across, np.sin(2 * np.pi * turn) * across, np.sqrt(1 - squared), share]
        return {"kernel": np.stack(ways, axis=1).astype(np.float32).tobytes()}

    def passes(self) -> list[Pass]:
        return [Pass("ambient_transfer", self.shader, TERMS, reads={"sender": self._source})]

    @property
    def _source(self) -> str:
        return "albedo" if self.albedo_source == "albedo" else "reflected_share"

    def estimate(self) -> Estimate:
        if self.albedo_source == "albedo":
            return super().estimate()
        return Estimate([], {})  # the light has to be there before: see `lighting`

    def openness(self) -> str:
        return """
        uniform sampler2D transfer_terms;
        float opennessAt(ivec2 pixel) { return texelFetch(transfer_terms, pixel, 0).a; }
        """

    def lighting(self) -> Sequence[Pass | Estimate]:
        steps: list[Pass | Estimate] = [*self.direct()]
        if self.albedo_source == "radiance":
            share = Pass("reflected share", "ambient_transfer.share.frag", {"reflected_share": "RGBA16F"})
            steps += [share, Estimate(self.passes(), TERMS)]
        return [*steps, *(term(name, "ambient_transfer.light.glsl") for name in ("ambient", "indirect"))]

    def sends(self) -> bool:
        return True

    def question(self) -> Question:
        values = self.values()
        measure = self.chosen("measure")
        assert isinstance(measure, Measure)
        sigma = {"sigma": values["sigma"]} if "sigma" in values else {}
        return super().question().replace(falloff=measure.fading, measure=measure.fading, **sigma)
