"""Screen-space directional occlusion: light from the open directions, and one bounce from the blocked ones."""

from collections.abc import Sequence
from math import pi
from typing import ClassVar, Literal

from ..maths.sampling import ways
from ..scene.prefiltered import Blurred
from ..scene.scene import Scene
from .base import Bleeding, DistanceClamp, Estimate, Senders, with_distance_clamp
from .marched import Marched
from .parameters import parameter
from .passes import SHARED_DIRECT, Pass


class SSDO(Marched):
    """Occlusion that knows directions: shadows take the colour of the light that still arrives.

    With `bounces=1`, each occluder also sends the light that falls on it, as a small patch (`indirect`). With
    `light_steps`, the lights are tested on the screen too: samples on the segment of length `radius` towards each.
    """

    name = "ssdo"
    title = "Screen-space directional occlusion"
    paper = "Ritschel, Grosch and Seidel 2009, Approximating Dynamic Global Illumination in Image Space"
    shader = "ssdo.frag"
    outputs: ClassVar = {"irradiance": "RGBA16F"}
    derived: ClassVar = {"visibility": lambda frame, raw: frame.channels(f"irradiance{raw}")[..., 3]}
    lit: ClassVar = True

    bounces: Literal[0, 1] = parameter(0, "Bounces of indirect light: none, or one from the occluders on the screen.")
    bleeding: Bleeding = 1.0
    distance_clamp: DistanceClamp = "auto"
    senders: Senders = "patches"
    light_steps: int = parameter(
        0, "Samples towards each light, on the screen; 0 leaves it to shadow maps.", ge=0, le=64
    )
    environment_lod: float = parameter(
        1.0, "Blur of the environment, in solid angles of a sample; 0 looks it up as it is, with noise.", ge=0, le=16
    )

    def tables(self) -> dict[str, Blurred]:
        return {"prefiltered_environment": Blurred(self.environment_lod * 2 * pi / self.directions)}  # Δω = 2π / N

    def samples(self, seed: int) -> dict[str, bytes]:
        of_lights = {"light_samples": ways(16, seed, self.falloff).tobytes()} if self.light_steps else {}
        return super().samples(seed) | of_lights

    def lighting(self) -> Sequence[Pass | Estimate]:
        direct, ambient = super().lighting()
        if not self.light_steps:
            return [direct, ambient]
        share = {"light_share": "RGBA16F"}
        return [Estimate([Pass("ssdo lights", "ssdo.lights.frag", share)], share), SHARED_DIRECT, ambient]

    def bounce(self) -> Estimate | None:
        if not self.bounces:
            return None
        outputs, constants = {"bounce": "RGBA16F"}, {"patches": self.senders == "patches"}
        return Estimate([Pass("ssdo bounce", "ssdo.bounce.frag", outputs, constants)], outputs)

    def resolved(self, scene: Scene) -> "SSDO":
        return with_distance_clamp(super().resolved(scene))
