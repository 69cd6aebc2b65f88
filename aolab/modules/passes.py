"""What a pass is: one shader over the whole screen, and the textures it fills."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..gl.source import Constant


@dataclass(frozen=True)
class Estimate:
    """Passes that come to noisy buffers, `outputs` (name: format), which are then filtered and brought to full size."""

    passes: Sequence["Pass"]
    outputs: Mapping[str, str]


@dataclass(frozen=True)
class Pass:
    """`shader` (a file under glsl/, or GLSL text) reads textures by the names of its samplers and fills `outputs`.

    `name` is what timings call it; `outputs` maps each `out` variable's buffer to its format, in order of location;
    `constants` are compile-time values beyond the module's own parameters; `reads` (sampler: buffer) is for samplers
    that go by another name than the buffer that they read.
    """

    name: str
    shader: str
    outputs: Mapping[str, str]
    constants: Mapping[str, Constant] = field(default_factory=dict)
    reads: Mapping[str, str] = field(default_factory=dict)


# Lighting, as every method has it unless it says otherwise: lights through shadow maps, the environment by its SH
DIRECT = Pass("direct", "pipeline/direct.frag", {"direct": "RGBA16F"})
AMBIENT = Pass("ambient", "pipeline/ambient.frag", {"ambient": "RGBA16F"})


def reflect(irradiance: str, radiance: str) -> Pass:
    """The pass that reflects the buffer `irradiance` diffusely, as `radiance`."""
    return Pass(radiance, "pipeline/reflect.frag", {radiance: "RGBA16F"}, reads={"source": irradiance})
