"""The G-buffer: the surfaces that the camera sees, before any light; and its smaller copy."""

from collections.abc import Mapping
from dataclasses import replace

from ..gl.bindings import Bindings
from ..modules.buffers import BACKGROUND_Z, ON_DEMAND, SURFACES
from ..modules.filters.base import MOST_SOURCES, over_sources
from ..modules.passes import GeometryPass, Pass
from ..scene.view import View, ray_scale_offset
from .pass_runner import Buffers, PassRunner

G_BUFFER = {name: buffer.format for name, buffer in SURFACES.items()}
# drawn besides, where they are needed; `facetNormal` is made of the facets
BESIDES = {**{name: buffer.format for name, buffer in ON_DEMAND.items() if name != "facetNormal"}, "facets": "RG16"}
STORED = "palette", "patterns", "facets"  # in the place of `albedo` (see palettes.py) and of `facetNormal`
# off the screen, where nothing is known, the depth is the background's: nothing blocks
_OUTSIDE = {"viewZ": BACKGROUND_Z}

_SHRINK = Pass(
    "shrink",
    "pipeline/shrink.frag",
    G_BUFFER,
    writes={"smallViewZ": "viewZ", "smallNormal": "viewNormal", "smallAlbedo": "albedo"},
    outside=_OUTSIDE,
)
_FACETS = Pass("facets", "pipeline/facets.frag", {"facetNormal": ON_DEMAND["facetNormal"].format})


def g_buffer(name: str, formats: Mapping[str, str] = G_BUFFER, peel: bool = False, atlas: bool = False) -> GeometryPass:
    """The pass that draws the scene's viewZ (background -inf), viewNormal and albedo, or the surface buffers `formats`.

    `name` is for the timings. With `peel`, the pass draws what lies behind the layer `nearerZ`. Of an `atlas`, shaders
    know the tiles' edges themselves.
    """
    return GeometryPass(
        name,
        "pipeline/gbuffer.frag",
        formats,
        constants={"peel": peel, **{f"with_{name}": name in formats for name in BESIDES}},
        writes={
            "surfaceViewZ": "viewZ",
            "surfaceNormal": "viewNormal",
            "surfaceAlbedo": "albedo",
            **{f"surface{name[0].upper()}{name[1:]}": name for name in BESIDES},
        },
        outside={} if atlas else _OUTSIDE,
        clear=_OUTSIDE,
    )


def as_bindings(buffers: Buffers) -> Bindings:
    """The surface buffers, for the passes that read them; see glsl/lib/surface.glsl."""
    return Bindings("the surfaces", buffers, constants={f"has_{name}": name in buffers for name in STORED})


def shown(buffers: Buffers) -> Buffers:
    """The buffers that a frame shows: those that are stored in another form wait until they are read."""
    return {name: texture for name, texture in buffers.items() if name not in STORED}


def facing(surfaces: Buffers, normals: str) -> Buffers:
    """The surfaces with the vertices' own normals as `viewNormal`, where `normals` is geometric and they differ."""
    if normals == "geometric" and "geometricNormal" in surfaces:
        return {**surfaces, "viewNormal": surfaces["geometricNormal"]}
    return surfaces


def facet_normals(runner: PassRunner, buffers: Buffers, view: View) -> Buffers:
    """`facetNormal`, the normals of the triangles: the surfaces' own where the scene has no others."""
    if "facets" not in buffers:
        return {"facetNormal": buffers["viewNormal"]}
    given = [as_bindings(buffers), Bindings("the view", uniforms=view.uniforms, constants=view.constants)]
    return runner.run(_FACETS, given, view.size)


def shrink(runner: PassRunner, buffers: Buffers, view: View, small: View) -> Buffers:
    """The surface buffers at the size of `small`, from those at the size of `view`."""
    rays = {"small_ray_from_pixel": ray_scale_offset(small.camera, small.size)}
    bindings = [
        as_bindings(buffers),
        Bindings("the view", uniforms=view.uniforms, constants=view.constants),
        Bindings("the small view", uniforms=rays),
    ]
    drawn = {name: format for name, format in G_BUFFER.items() if name in buffers}  # a palette may stand for the albedo
    step = replace(_SHRINK, outputs=drawn, constants={"with_albedo": "albedo" in drawn})
    result = runner.run(step, bindings, small.size)
    formats = {**BESIDES, **_FACETS.outputs}
    others = {name: formats[name] for name in buffers if name in formats}
    names = list(others)
    for start in range(0, len(names), MOST_SOURCES):
        some = {name: others[name] for name in names[start : start + MOST_SOURCES]}
        step = over_sources("shrink", "pipeline/shrink_sources.frag", some)
        sources = {f"source{number}": buffers[name] for number, name in enumerate(some)}
        result |= runner.run(step, [*bindings[1:], Bindings("the sources", sources)], small.size)
    return result
