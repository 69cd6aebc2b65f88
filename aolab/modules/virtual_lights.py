"""Lighting by many small lights, with a shadow map each: of an environment, or of the surfaces that lamps light."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from ..scene.scene import Scene
from .base import AUTO, Module
from .buffers import REFLECTIVE, VIRTUAL
from .estimate import Estimate
from .marched import Marched
from .none import Unoccluded
from .parameters import parameter
from .passes import Pass, reflect
from .reflected import bounce_of, note_emission
from .ssao import SSAO

KELLER = "Keller 1997, Instant Radiosity"
SSDO_PAPER = "Ritschel, Grosch and Seidel 2009, Approximating Dynamic Global Illumination in Image Space"
DEBEVEC = "Debevec 2005, A Median Cut Algorithm for Light Probe Sampling"
MOST = 256


@dataclass(frozen=True, kw_only=True)
class VirtualLights(Pass):
    """A lighting step: the irradiance of `count` virtual lights through shadow maps of `resolution` pixels a side.

    `source`: the environment, in cells of equal energy, or the reflective shadow maps, whose pixels are drawn by their
    flux. `slope_bias` as of the shadow maps of lamps. `clamp`: the geometry term is at most 1/clamp²; None bounds
    each light by the radiosity of its surface. The lights are added up in batches.
    """

    source: Literal["environment", "reflective"]
    count: int
    resolution: int
    slope_bias: float
    clamp: float | None = None

    @property
    def samples(self) -> frozenset[str]:
        """The buffers that have to be there before the lights are chosen."""
        return frozenset(REFLECTIVE if self.source == "reflective" else ())


def _lights(
    module: Any, source: Literal["environment", "reflective"], count: int, clamp: float | None = None
) -> VirtualLights:
    return VirtualLights(
        f"{source} lights",
        "virtual_lights.frag",
        {f"{source}_irradiance": VIRTUAL[f"{source}_irradiance"].format},
        writes={"irradiance": f"{source}_irradiance"},
        source=source,
        count=count,
        resolution=module.vpl_resolution,
        slope_bias=0.0 if module.shadow_bias == "none" else module.shadow_bias / 2,
        clamp=clamp,
    )


Clamp = Annotated[
    Annotated[float, Field(gt=0)] | Literal["auto"],
    Field(
        description="A virtual light's geometry term is at most 1/clamp²; auto: its irradiance is at most 1/4 of its "
        "surface's radiosity.",
        json_schema_extra={"unit": "scene units"},
    ),
]
_RESOLUTION = {"ge": 16, "le": 512, "unit": "pixels"}
_ABOUT_RESOLUTION = "Pixels a side of a virtual light's shadow map."


def with_environment_vpl(base: type[Module]) -> type[Module]:
    """The class `base` with ambient light from virtual lights, and the parameters of both."""

    class WithEnvironmentVpl(base):  # pyright: ignore[reportGeneralTypeIssues, reportUntypedBaseClass]
        buffers: ClassVar = tuple(dict.fromkeys((*base.buffers, *VIRTUAL.values())))
        parts: ClassVar = (*base.parts, "environment_vpl")

        environment_lights: int = parameter(64, "Virtual lights of the environment.", ge=1, le=MOST)
        vpl_resolution: int = parameter(128, _ABOUT_RESOLUTION, **_RESOLUTION)

        def lighting(self) -> Sequence[Pass | Estimate]:
            before = [step for step in super().lighting() if "ambient" not in step.outputs]
            lights = _lights(self, "environment", self.environment_lights)
            return [*before, lights, reflect("environment_irradiance", "ambient")]

    return WithEnvironmentVpl


def with_instant_radiosity(base: type[Module]) -> type[Module]:
    """The class `base` with the bounce of virtual lights, and the parameters of both."""

    class WithInstantRadiosity(base):  # pyright: ignore[reportGeneralTypeIssues, reportUntypedBaseClass]
        buffers: ClassVar = tuple(dict.fromkeys((*base.buffers, *VIRTUAL.values())))
        parts: ClassVar = (*base.parts, "instant_radiosity")

        bounce_lights: int = parameter(64, "Virtual lights, drawn from the reflective shadow maps.", ge=1, le=MOST)
        vpl_resolution: int = parameter(128, _ABOUT_RESOLUTION, **_RESOLUTION)
        vpl_clamp: Clamp = AUTO
        near_field: bool = parameter(
            False, "The light that the clamp takes away is bounced on the screen, from occluders; in place of a bounce."
        )
        rsm_resolution: int = parameter(256, "Pixels a side of a reflective shadow map.", ge=8, le=2048, unit="pixels")

        def lighting(self) -> Sequence[Pass | Estimate]:
            before = super().lighting()
            clamp = None if self.vpl_clamp == AUTO else self.vpl_clamp
            lights = _lights(self, "reflective", self.bounce_lights, clamp)
            return [*before, lights, bounce_of("reflective_irradiance", before, shaded=False)]

        def bounce(self) -> Estimate | None:
            if not (self.near_field and issubclass(base, Marched)):
                return super().bounce()
            bounce = {"bounce": "RGBA32F"}
            # of the lamps' light alone: the virtual lights carry no other
            return Estimate([Pass("near field", "near_field.frag", bounce, reads={"sender": "direct"})], bounce)

    return WithInstantRadiosity


class EnvironmentVPL(with_environment_vpl(Unoccluded)):  # pyright: ignore[reportGeneralTypeIssues, reportUntypedBaseClass]
    """The environment as many lights from far away, with a shadow map each: ambient light with all of its shadows.

    The environment is cut into cells of equal energy. Each cell is a light with the cell's whole light.
    """

    name = "environment_vpl"
    claims = "ambient"
    title = "Virtual point lights of the environment"
    paper = f"{SSDO_PAPER}, section 5; {DEBEVEC}"


class InstantRadiosity(with_instant_radiosity(SSAO)):  # pyright: ignore[reportGeneralTypeIssues, reportUntypedBaseClass]
    """One bounce of the lamps from virtual point lights, with a shadow map each; ambient light is SSAO's.

    The virtual lights are drawn from the reflective shadow maps, by the flux of their pixels. Near a virtual light, its
    light is clamped. With `near_field`, occluders on the screen send the light that the clamp takes away.
    """

    name = "instant_radiosity"
    claims = "indirect"
    title = "Instant radiosity"
    paper = f"{KELLER}; {SSDO_PAPER}, section 5"

    def resolved(self, scene: Scene) -> Module:
        note_emission("instant_radiosity", "lights alone", scene)
        return super().resolved(scene)
