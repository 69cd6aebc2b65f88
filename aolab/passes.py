"""What a pass is: one shader over the whole screen, and the textures it fills."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from .gl.source import Constant


@dataclass(frozen=True)
class Estimate:
    """Passes that come to noisy buffers, `outputs` (name: format), which are then filtered and brought to full size."""

    passes: Sequence["Pass"]
    outputs: Mapping[str, str]


@dataclass(frozen=True)
class Pass:
    """`shader` (a file under glsl/, or GLSL text) reads textures by the names of its samplers and fills `outputs`.

    `name` is what timings call it; `outputs` maps each `out` variable's buffer to its format, in order of location;
    `constants` are compile-time values beyond the module's own parameters.
    """

    name: str
    shader: str
    outputs: Mapping[str, str]
    constants: Mapping[str, Constant] = field(default_factory=dict)
