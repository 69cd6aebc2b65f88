"""Reflective shadow maps: one bounce of the lights, gathered from the surfaces that they see."""

from collections.abc import Sequence
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ..maths.sampling import disc, line_start
from ..scene.scene import Scene
from .base import AUTO, Module
from .buffers import REFLECTED
from .estimate import Estimate
from .filters import Unfiltered
from .filters.base import Filter
from .none import Unoccluded
from .parameters import parameter
from .passes import Pass
from .reflected import bounce_of, note_emission

LOW_SCALE = 0.25  # of the bounce with `gather="low"`: a pixel in 16 gathers
MOST_SAMPLES = 512  # vectors in a uniform array, beside the other uniforms, of the 1024 that drivers have
AUTO_SAMPLES = {"rotated": 24, "full": 400, "low": 400}  # Chow 2014: 20 to 30; Dachsbacher and Stamminger 2005: 400
PAPER = "Dachsbacher and Stamminger 2005, Reflective Shadow Maps; rotated kernel: Chow 2014"


Samples = Annotated[
    Annotated[int, Field(ge=1, le=MOST_SAMPLES)] | Literal["auto"],
    Field(description="Pixel lights for a pixel and a map; auto is 24 on a line, and 400 on a disc."),
]


class Interpolated(Filter):
    """Bilinear interpolation where normals and positions agree; the pixels without are marked."""

    name = "rsm_interpolated"
    upsampling = "rsm.interpolate.frag"


def with_rsm(base: type[Module]) -> type[Module]:
    """The class `base` with the bounce of reflective shadow maps, and the parameters of both."""

    class WithRSM(base):  # pyright: ignore[reportGeneralTypeIssues, reportUntypedBaseClass]
        buffers: ClassVar = (*base.buffers, *REFLECTED.values())
        parts: ClassVar = (*base.parts, "rsm")

        gather: Literal["rotated", "full", "low"] = parameter(
            "rotated",
            "Samples on a line turned by 16 angles and the mean of 4×4 pixels, a disc of samples at `full` resolution, "
            "or one at `low` resolution, interpolated.",
        )
        rsm_samples: Samples = AUTO
        rsm_radius: float = parameter(
            0.5,
            "Half the side of the square around a point's projection that it gathers from, as a share of the map's "
            "side; 0.5 is the whole map.",
            gt=0,
            le=0.5,
        )
        rsm_resolution: int = parameter(256, "Pixels a side of a reflective shadow map.", ge=8, le=2048, unit="pixels")
        shaded: bool = parameter(True, "The visibility of the module dims the bounce.")

        def samples(self, seed: int) -> dict[str, bytes]:
            count = self.rsm_samples if isinstance(self.rsm_samples, int) else AUTO_SAMPLES[self.gather]
            own = {"rsm_kernel": disc(count, seed).tobytes(), "line_start": line_start(seed).tobytes()}
            return super().samples(seed) | own

        def lighting(self) -> Sequence[Pass | Estimate]:
            before = super().lighting()
            constants = {"rotated": self.gather == "rotated"}
            format = REFLECTED["rsm_irradiance"].format
            gather = Pass("rsm gather", "rsm.gather.frag", {"rsm_irradiance": format}, constants)
            if self.gather == "rotated":
                steps = [Estimate([gather], gather.outputs)]
            elif self.gather == "full":
                steps = [Estimate([gather], gather.outputs, filter=Unfiltered())]
            else:
                low = Pass(
                    "rsm gather", gather.shader, {"rsm_interpolated": format}, constants,
                    writes={"rsm_irradiance": "rsm_interpolated"},
                )  # fmt: skip
                complete = Pass("rsm complete", "rsm.complete.frag", gather.outputs, constants)
                steps = [Estimate([low], low.outputs, filter=Interpolated(), scale=LOW_SCALE), complete]
            return [*before, *steps, bounce_of("rsm_irradiance", before, shaded=self.shaded)]

        def resolved(self, scene: Scene) -> Module:
            module = super().resolved(scene)
            if module.rsm_samples == AUTO:
                return module.replace(rsm_samples=AUTO_SAMPLES[module.gather])
            return module

    return WithRSM


class RSM(with_rsm(Unoccluded)):  # pyright: ignore[reportGeneralTypeIssues, reportUntypedBaseClass]
    """The light of lamps and suns that reaches a surface by one reflection, `indirect`; nothing blocks on that way.

    Each light has a map of the surfaces that it sees: their positions, normals and reflected flux. A pixel gathers from
    samples of the maps. The visibility of another module may shade the bounce: the module `ssao+rsm`,
    for example, has the parameters of both.
    """

    name = "rsm"
    claims = "indirect"
    title = "Reflective shadow maps"
    paper = PAPER

    def resolved(self, scene: Scene) -> Module:
        note_emission("rsm", "lights alone", scene)
        return super().resolved(scene)
