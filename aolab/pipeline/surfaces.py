"""The G-buffer: the surfaces that the camera sees, before any light; and its smaller copy."""

from collections.abc import Mapping

from ..gl.bindings import Bindings
from ..modules.buffers import BACKGROUND_Z, ON_DEMAND, SURFACES
from ..modules.filters.base import MOST_SOURCES, over_sources
from ..modules.passes import GeometryPass, Pass
from ..scene.view import View, ray_scale_offset
from .pass_runner import Buffers, PassRunner

G_BUFFER = {name: buffer.format for name, buffer in SURFACES.items()}
PALETTE = "palette", "patterns"  # in the place of `albedo`: see palettes.py
# off the screen, where nothing is known, the depth is the background's: nothing blocks
_OUTSIDE = {"viewZ": BACKGROUND_Z}

_SHRINK = Pass(
    "shrink",
    "pipeline/shrink.frag",
    G_BUFFER,
    writes={"smallViewZ": "viewZ", "smallNormal": "viewNormal", "smallAlbedo": "albedo"},
    outside=_OUTSIDE,
)


def g_buffer(name: str, formats: Mapping[str, str] = G_BUFFER, peel: bool = False, atlas: bool = False) -> GeometryPass:
    """The pass that draws the scene's viewZ (background -inf), viewNormal and albedo, or the surface buffers `formats`.

    `name` is for the timings. With `peel`, the pass draws what lies behind the layer `nearerZ`. Of an `atlas`, shaders
    know the tiles' edges themselves.
    """
    return GeometryPass(
        name,
        "pipeline/gbuffer.frag",
        formats,
        constants={"peel": peel, **{f"with_{name}": name in formats for name in ON_DEMAND}},
        writes={
            "surfaceViewZ": "viewZ",
            "surfaceNormal": "viewNormal",
            "surfaceAlbedo": "albedo",
            **{f"surface{name[0].upper()}{name[1:]}": name for name in ON_DEMAND},
        },
        outside={} if atlas else _OUTSIDE,
        clear=_OUTSIDE,
    )


def as_bindings(buffers: Buffers) -> Bindings:
    """The surface buffers, for the passes that read them; see glsl/lib/surface.glsl."""
    return Bindings("the surfaces", buffers, constants={f"has_{name}": name in buffers for name in PALETTE})


def facing(surfaces: Buffers, normals: str) -> Buffers:
    """The surfaces with the vertices' own normals as `viewNormal`, where `normals` is geometric and they differ."""
    if normals == "geometric" and "geometricNormal" in surfaces:
        return {**surfaces, "viewNormal": surfaces["geometricNormal"]}
    return surfaces


def with_facets(buffers: Buffers) -> Buffers:
    """The surface buffers, with the normals of their triangles: the surfaces' own where the scene has no others."""
    if "viewNormal" in buffers:
        buffers.setdefault("facetNormal", buffers["viewNormal"])
    return buffers


def shrink(runner: PassRunner, buffers: Buffers, view: View, small: View) -> Buffers:
    """The surface buffers at the size of `small`, from those at the size of `view`."""
    rays = {"small_ray_from_pixel": ray_scale_offset(small.camera, small.size)}
    bindings = [
        Bindings("the surfaces", buffers),
        Bindings("the view", uniforms=view.uniforms, constants=view.constants),
        Bindings("the small view", uniforms=rays),
    ]
    result = runner.run(_SHRINK, bindings, small.size)
    drawn = [name for name in buffers if buffers[name] is not buffers["viewNormal"]]
    others = {name: ON_DEMAND[name].format for name in drawn if name in ON_DEMAND}
    names = list(others)
    for start in range(0, len(names), MOST_SOURCES):
        some = {name: others[name] for name in names[start : start + MOST_SOURCES]}
        step = over_sources("shrink", "pipeline/shrink_sources.frag", some)
        sources = {f"source{number}": buffers[name] for number, name in enumerate(some)}
        result |= runner.run(step, [*bindings[1:], Bindings("the sources", sources)], small.size)
    return with_facets(result)
