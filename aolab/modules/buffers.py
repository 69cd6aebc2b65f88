"""The table of buffers: each name has one meaning in renders, references, comparisons and docs. Modules extend it."""

from dataclasses import dataclass
from math import inf, nan
from typing import Literal

Kind = Literal["share", "displayed", "radiance", "direction", "harmonics", "length", "numbers"]


@dataclass(frozen=True)
class Buffer:
    """A row of the table.

    `channels` count from the first; further channels of `format` are padding. `format` is "" where no pass of a render
    fills the buffer. `background` is the value of `frame[name]` where nothing was drawn; None is the environment's.
    `kind` decides how `aolab.compare` measures and shows the buffer. `about` is one sentence.
    """

    name: str
    channels: int
    format: str
    unit: str
    background: float | None
    kind: Kind
    about: str


def _table(*rows: Buffer) -> dict[str, Buffer]:
    return {row.name: row for row in rows}


_RADIANCE = "radiance"  # in the unit of the scene's lights and environment
_HARMONICS = "Coefficients {} to {} of the visibility times the cosine, in spherical harmonics, world space."

BACKGROUND_Z = -inf  # viewZ where nothing was drawn, and off the screen

# drawn from the scene's triangles before any module's pass
SURFACES = _table(
    Buffer("viewZ", 1, "R32F", "scene units", BACKGROUND_Z, "length", "The view-space z of the surface, negative."),
    Buffer("viewNormal", 3, "RGBA16F", "", 0, "direction", "The surface's unit normal in view space."),
    Buffer("albedo", 3, "RGBA16F", "", 0, "share", "The linear diffuse albedo of the surface."),
)

# drawn with them if a pass of the module samples them; emission also if a material of the scene has some, and the
# normals of triangles, and those without normal and height maps, where they are not the surfaces'
ON_DEMAND = _table(
    Buffer("facetNormal", 3, "RGBA16F", "", 0, "direction", "The unit normal of the surface's triangle, view space."),
    Buffer("uv", 2, "RG32F", "", 0, "numbers", "The texture coordinates of the surface."),
    Buffer("tangent", 3, "RGBA16F", "", 0, "direction", "The direction on the surface in which u grows, view space."),
    Buffer("emission", 3, "RGBA32F", _RADIANCE, 0, "radiance", "The radiance that the material sends by itself."),
    Buffer("geometricNormal", 3, "RGBA16F", "", 0, "direction", "The unit normal without normal and height maps."),
    Buffer(
        "reliefU", 4, "RGBA32F", "", 0, "numbers", "The gradient of u in view space; the height map's number from 1."
    ),
    Buffer("reliefV", 4, "RGBA32F", "", 0, "numbers", "The gradient of v in view space; the scale of the heights."),
    Buffer("baked", 1, "R16F", "", 1, "share", "The visibility that `aolab.bake` has baked into the vertices; else 1."),
    Buffer("motion", 2, "RG32F", "pixels", 0, "numbers", "The way of the surface on the screen since the last frame."),
)

# made from an estimate by the lighting and the composition. Radiance has single precision: half floats end at 65504,
# and a surface near a lamp may be brighter
LIT = _table(
    Buffer("direct", 3, "RGBA32F", _RADIANCE, 0, "radiance", "The light of the lamps that the surface reflects."),
    Buffer("ambient", 3, "RGBA32F", _RADIANCE, 0, "radiance", "The environment's light that the surface reflects."),
    Buffer("indirect", 3, "RGBA32F", _RADIANCE, 0, "radiance", "One bounce of light that the surface reflects."),
    Buffer("sender", 3, "RGBA32F", _RADIANCE, 0, "radiance", "The light that leaves each surface before any bounce."),
    Buffer("radiance", 3, "RGBA32F", _RADIANCE, None, "radiance", "The sum of all light, over the environment."),
    Buffer("image", 3, "RGBA8", "sRGB, 0 to 255", None, "displayed", "The radiance, tone mapped, for a screen."),
)

# the surfaces that the lights see, drawn if a pass of the module samples them; a map a light, side by side
REFLECTIVE = _table(
    Buffer(
        "rsm_position", 3, "RGBA32F", "scene units", 0, "numbers",
        "The point that a light sees, world space; the fourth channel is the area of its surface.",
    ),
    Buffer("rsm_normal", 3, "RGBA16F", "", 0, "direction", "The unit normal of that surface, world space."),
    Buffer("rsm_flux", 3, "RGBA32F", "flux", 0, "numbers", "The flux that this surface reflects."),
    Buffer("rsm_depth", 1, "R32F", "scene units", inf, "length", "The distance to the light, along the map's axis."),
)  # fmt: skip
REFLECTED = _table(
    Buffer(
        "rsm_irradiance", 3, "RGBA32F", "irradiance", 0, "numbers", "The irradiance from reflective shadow maps."
    ),
    Buffer(
        "rsm_interpolated", 4, "RGBA32F", "irradiance", 0, "numbers",
        "The same at low resolution, interpolated (rgb), and whether enough neighbours agree (a).",
    ),
)  # fmt: skip
VIRTUAL = _table(
    Buffer(
        "environment_irradiance", 3, "RGBA32F", "irradiance", 0, "numbers",
        "The irradiance of the environment's virtual lights, with their shadows.",
    ),
    Buffer(
        "reflective_irradiance", 3, "RGBA32F", "irradiance", 0, "numbers",
        "The irradiance of virtual lights on surfaces that lamps light, with their shadows.",
    ),
)  # fmt: skip

# read by the lighting: a module's output of one of these names has this meaning
CONTRACT = _table(
    Buffer("visibility", 1, "R16F", "", nan, "share", "The open share of the hemisphere, weighted by the cosine."),
    Buffer(
        "irradiance", 3, "RGBA16F", "irradiance", 0, "numbers",
        "The environment's irradiance with occlusion; the lighting reflects it as `ambient`.",
    ),
    Buffer(
        "bounce", 3, "RGBA32F", "irradiance", 0, "numbers",
        "The irradiance of one bounce; the lighting reflects it as `indirect`.",
    ),
    Buffer(
        "light_share", 3, "RGBA16F", "", 1, "share",
        "The share of the lights' irradiance that arrives; `direct` is multiplied by it.",
    ),
)  # fmt: skip

# further quantities that methods and the reference have in common
SHARED = _table(
    Buffer("bent_normal", 3, "", "", 0, "direction", "The mean open direction, weighted by the cosine, world space."),
    *(Buffer(f"sh{i}", 4, "", "", 0, "harmonics", _HARMONICS.format(4 * i, 4 * i + 3)) for i in range(4)),
    Buffer("standard_error", 1, "", "", nan, "numbers", "The standard error of the reference's visibility."),
    Buffer("obscurance", 1, "", "", 0, "share", "The mean of a distance measure over the hemisphere."),
    Buffer(
        "transfer", 3, "", "", 0, "share", "The share of a constant sky that arrives, by one formula for all bounces."
    ),
    Buffer(
        "transfer_multibounce", 3, "", "", 0, "share", "The share of a constant sky that arrives over many bounces."
    ),
)

BUFFERS: dict[str, Buffer] = SURFACES | ON_DEMAND | LIT | REFLECTIVE | CONTRACT | SHARED
