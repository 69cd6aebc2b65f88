"""Passes: one shader, over the whole screen or over the scene's triangles, and the textures it fills."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Literal

from ..gl.source import Constant
from ..scene.scene import Scene
from ..scene.view import View, Viewpoint
from .buffers import CONTRACT, LIT


@dataclass(frozen=True)
class Pass:
    """`shader` reads textures by the names of its samplers and fills `outputs`.

    `shader` is a file under glsl/, the path of another file, or GLSL text.

    `name` is the pass's name in timings. `outputs` maps each buffer to its format; the shader's `out` variable of the
    same name fills it, whatever their order. `writes` (`out` variable: buffer) and `reads` (sampler: buffer) are for
    variables whose name differs from the buffer's. `constants` are compile-time values beyond the module's parameters.
    `outside` (buffer: value) is the value that samplers read beyond the edge of an output; without it, they read the
    nearest texel. `includes` maps the name of an include to the file, or to the GLSL text, that stands for it.
    `background` (buffer: value), where given, has for each output the value that the shader writes where no surface is.
    Then the pass may be drawn over surfaces alone.
    """

    name: str
    shader: str | Path
    outputs: Mapping[str, str]
    constants: Mapping[str, Constant] = field(default_factory=dict)
    reads: Mapping[str, str] = field(default_factory=dict)
    writes: Mapping[str, str] = field(default_factory=dict)
    outside: Mapping[str, float] = field(default_factory=dict)
    includes: Mapping[str, str] = field(default_factory=dict)
    background: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def outs(self) -> dict[str, str]:
        """{buffer: `out` variable} of the outputs."""
        variables = {buffer: variable for variable, buffer in self.writes.items()}
        return {buffer: variables.get(buffer, buffer) for buffer in self.outputs}


@dataclass(frozen=True, kw_only=True)
class GeometryPass(Pass):
    """A pass that draws the scene's triangles: `vertex` is its vertex shader, `shader` its fragment shader.

    `geometry` is a geometry shader between the two, for a pass whose fragments need the whole triangle.

    `seen_from` returns the viewpoint from the scene and the camera's view; None is the camera's view. The outputs have
    the viewpoint's size. `clear` (buffer: value) fills outputs before drawing; without it, they start as 0. `combine`
    decides between a fragment and its pixel: `nearest` tests the depth, `or` sets bits of unsigned integers.
    Vertex shaders may read `local_position`, `local_normal`, `texture_uv`, `vertex_color` and `world_from_local`;
    fragment shaders may include lib/base_color.glsl for the colour and the holes of each mesh.
    """

    vertex: str = "pipeline/gbuffer.vert"
    geometry: str = ""
    seen_from: Callable[[Scene, View], Viewpoint] | None = None
    clear: Mapping[str, float] = field(default_factory=dict)
    combine: Literal["nearest", "or"] = "nearest"


def term(name: str, function: str, constants: Mapping[str, Constant] | None = None) -> Pass:
    """The pass that fills the buffer `name`, `direct`, `ambient` or `indirect`, by a function of the surface.

    `function` is the file with that function: `vec3 directAt(Surface surface)` and so on (glsl/lib/surface.glsl). If
    all steps of a module's lighting are terms, one pass of these functions draws its picture (pipeline/image.frag).
    """
    return Pass(name, TERMS[name], {name: LIT[name].format}, constants or {}, includes={f"{name}.glsl": function})


TERMS = {name: f"pipeline/{name}.frag" for name in ("direct", "ambient", "indirect")}

# The lighting of methods without their own: lights through shadow maps, the environment by its spherical harmonics
DIRECT = term("direct", "lighting/direct.glsl", {"shared_light": False})
# the same, times the buffer `light_share`, the share of the lights' irradiance that arrives
SHARED_DIRECT = replace(DIRECT, constants={"shared_light": True})
# that share, where samples on the screen fill the gap that the bias of shadow maps leaves (SSDO 2009, section 5)
FILL = Pass("fill", "pipeline/fill.frag", {"light_share": CONTRACT["light_share"].format})
AMBIENT = term("ambient", "lighting/ambient.glsl")


def reflect(irradiance: str, radiance: str, more: str = "") -> Pass:
    """The pass that reflects the buffer `irradiance` diffusely, as `radiance`, and adds the radiance `more`."""
    return Pass(
        radiance,
        "pipeline/reflect.frag",
        {radiance: LIT["radiance"].format},
        {"adds": bool(more)},
        reads={"source": irradiance, "more": more or irradiance},
        writes={"reflected": radiance},
    )
