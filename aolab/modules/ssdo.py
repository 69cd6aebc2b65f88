"""Screen-space directional occlusion: light from the open directions, and one bounce from the blocked ones."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ..kernels import cosine_hemisphere
from ..parameters import AUTO, parameter
from ..passes import Pass
from ..scene import Scene
from .base import Bias, Directions, Estimate, Falloff, Module, Radius, Steps, Thickness


class SSDO(Module):
    """Occlusion that knows directions: shadows take the colour of the light that still arrives.

    With `bounces=1`, each occluder also sends the light that falls on it, as a small patch (`indirect`). With
    `light_steps`, the lights are tested on the screen too: samples on the segment of length `radius` towards each.
    """

    name = "ssdo"
    title = "Screen-space directional occlusion"
    paper = "Ritschel, Grosch and Seidel 2009, Approximating Dynamic Global Illumination in Image Space"
    shader = "ssdo.frag"
    outputs: ClassVar = {"irradiance": "RGBA16F"}
    parts: ClassVar = {"visibility": ("irradiance", 3)}

    radius: Radius = "auto"
    directions: Directions = 8
    steps: Steps = 4
    bias: Bias = 0.01
    falloff: Falloff = 0.3
    thickness: Thickness = 0.9
    bounces: Literal[0, 1] = parameter(0, "Bounces of indirect light: none, or one from the occluders on the screen.")
    bleeding: float = parameter(1.0, "Strength of the bounce: scales the area of a sender, π radius² / N.", ge=0, le=16)
    distance_clamp: Annotated[float, Field(gt=0)] | Literal["auto"] = parameter(
        AUTO, "Least distance of a sender; auto is the radius of its patch, radius / √N.", unit="scene units"
    )
    senders: Literal["patches", "rays"] = parameter(
        "patches", "What an occluder sends: a patch of area A_s at its distance, or the light of its direction's share."
    )
    light_steps: int = parameter(
        0, "Samples towards each light, on the screen; 0 leaves it to shadow maps.", ge=0, le=64
    )
    environment_lod: float = parameter(
        1.0, "Blur of the environment, in solid angles of a sample; 0 looks it up as it is, with noise.", ge=0, le=16
    )

    def samples(self, seed: int) -> dict[str, bytes]:
        return {"kernel": cosine_hemisphere(self.directions, seed, self.falloff).tobytes()}

    def environment_blur(self) -> float:
        return self.environment_lod * 2 * 3.141592653589793 / self.directions  # Δω = 2π / N

    def bounce(self) -> Estimate | None:
        if not self.bounces:
            return None
        outputs, constants = {"bounce": "RGBA16F"}, {"patches": self.senders == "patches"}
        return Estimate([Pass("ssdo bounce", "ssdo.bounce.frag", outputs, constants)], outputs)

    def resolved(self, scene: Scene) -> "SSDO":
        module = super().resolved(scene)
        if module.distance_clamp == AUTO:
            assert module.radius != AUTO  # resolved above
            module = module.replace(distance_clamp=module.radius / module.directions**0.5)
        return module
