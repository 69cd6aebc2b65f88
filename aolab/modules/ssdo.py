"""Screen-space directional occlusion: light from the open directions, and one bounce from the blocked ones."""

from collections.abc import Sequence
from math import pi
from typing import ClassVar, Literal

from ..maths.sampling import ways
from ..scene.irradiance import OpenIrradiance
from ..scene.prefiltered import Blurred, Table
from ..scene.scene import Scene
from .base import Bleeding, DistanceClamp, Estimate, Senders, with_distance_clamp
from .buffers import CONTRACT, Buffer
from .marched import Marched
from .parameters import parameter
from .passes import SHARED_DIRECT, Pass, term


class SSDO(Marched):
    """Occlusion by direction: a shadow has the colour of the light that still arrives.

    With `bounces=1`, each occluder also reflects the light that falls on it (`indirect`). With `light_steps`, lights
    are tested on the screen too, by samples on the segment of length `radius` towards each light.
    """

    name = "ssdo"
    claims = "ambient"
    title = "Screen-space directional occlusion"
    paper = "Ritschel, Grosch and Seidel 2009, Approximating Dynamic Global Illumination in Image Space"
    shader = "ssdo.frag"
    outputs: ClassVar = {"open_light": "RGBA16F", "all_light": "RGBA16F"}
    derived: ClassVar = {"visibility": lambda frame, raw: frame.channels(f"open_light{raw}")[..., 3]}
    buffers: ClassVar = (
        Buffer("open_light", 3, "RGBA16F", "radiance", 0, "radiance", "The mean light of the open directions."),
        Buffer("all_light", 3, "RGBA16F", "radiance", 0, "radiance", "The mean light of all directions, open or not."),
    )
    lit: ClassVar = True

    estimator: Literal["blocked", "plain"] = parameter(
        "blocked", "An open surface's light less that of the blocked directions, or the `plain` sum over open ones."
    )
    bounces: Literal[0, 1] = parameter(0, "Bounces of indirect light: none, or one from the occluders on the screen.")
    bleeding: Bleeding = 1.0
    distance_clamp: DistanceClamp = "auto"
    senders: Senders = "rays"
    light_steps: int = parameter(
        0, "Samples towards each light, on the screen; with 0, shadow maps alone decide.", ge=0, le=64
    )
    environment_lod: float = parameter(
        1.0, "Blur of the environment, in solid angles of a sample; with 0 there is no blur but noise.", ge=0, le=16
    )

    def tables(self) -> dict[str, Table]:
        solid_angle = 2 * pi / self.directions  # Δω
        tables: dict[str, Table] = {"prefiltered_environment": Blurred(self.environment_lod * solid_angle)}
        if self.estimator == "blocked":
            tables["open_irradiance"] = OpenIrradiance()
        return tables

    def estimate(self) -> Estimate:
        outputs = dict(self.outputs)
        if self.estimator == "plain":
            del outputs["all_light"]  # which the pass fills, but nothing reads
        return Estimate(self.passes(), outputs)

    def samples(self, seed: int) -> dict[str, bytes]:
        of_lights = {"light_samples": ways(16, seed, self.falloff).tobytes()} if self.light_steps else {}
        return super().samples(seed) | of_lights

    def openness(self) -> str:
        return """
        uniform sampler2D open_light;
        float opennessAt(ivec2 pixel) { return texelFetch(open_light, pixel, 0).a; }
        """

    def lighting(self) -> Sequence[Pass | Estimate]:
        blocked = {"blocked": self.estimator == "blocked"}
        ambient = term("ambient", "ssdo.ambient.glsl", blocked)
        if not self.light_steps:
            return [*self.direct(), ambient]
        share = {"light_share": "RGBA16F"}
        return [Estimate([Pass("ssdo lights", "ssdo.lights.frag", share)], share), SHARED_DIRECT, ambient]

    def bounce(self) -> Estimate | None:
        if not self.bounces:
            return None
        outputs, constants = {"bounce": CONTRACT["bounce"].format}, {"patches": self.senders == "patches"}
        return Estimate([Pass("ssdo bounce", "ssdo.bounce.frag", outputs, constants)], outputs)

    def resolved(self, scene: Scene) -> "SSDO":
        return with_distance_clamp(super().resolved(scene))
