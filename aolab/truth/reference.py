"""`aolab.reference`: the same buffers as a render's, by rays against all triangles."""

from collections.abc import Iterable
from dataclasses import asdict
from time import perf_counter
from typing import Any, Literal, get_args

import numpy as np

from ..errors import ParameterError, suggestion
from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..modules import MODULES, Module, find
from ..pipeline.api import shared_lab
from ..pipeline.frame import Frame
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..scene.view import View
from ..version import __version__
from . import cache as disk
from .buffers import BUFFERS
from .casters import Engine
from .hemisphere import strata
from .integrals import Measure, Setting
from .picture import over_environment, shown, spread
from .points import Surface
from .tracing import trace
from .world import World

DEFAULT_SIZE = (640, 360)
DEFAULT_BUFFERS = ("visibility", "ambient", "bent_normal", "indirect", "standard_error")


def reference(
    scene: Any,
    *,
    size: Size = DEFAULT_SIZE,
    camera: Camera | None = None,
    rays: int = 256,
    radius: float | None = None,
    falloff: float = 0.0,
    like: str | Module | type[Module] | None = None,
    buffers: Iterable[str] | None = None,
    measure: Measure = "sqrt",
    bounces: int = 8,
    seed: int = 0,
    engine: Engine | Literal["mitsuba"] = "auto",
    cache: bool = True,
    progress: bool | None = None,
) -> Frame:
    """Ray-traced truth for `scene`, at the surface points of aolab's own G-buffer: pixels correspond one to one.

    `rays`, even, are cast from each pixel's centre, stratified, with density cosθ/π around the G-buffer's normal. They
    start off the surface (`World.lift`, `points.Surface`); one that dips below its triangle, as shading normals allow,
    meets that triangle and is blocked. All triangles block, from both sides; holes of cut-out textures do not.

    `radius` (scene units; None is unlimited) and `falloff` mean what they mean for the modules: a hit at distance d
    blocks by 1 - smoothstep(1 - falloff, 1, d/radius). `like` takes both from a module instead.

    `buffers` chooses what is computed, and what it costs. Besides viewZ, viewNormal and albedo, which are the render's:

    - `visibility`: mean of the openness 1 - blocked; `standard_error`: its standard deviation, from pairs of
      independent rays in each stratum (`strata`);
    - `ambient`: albedo/π × the environment's radiance in the open directions, times their openness;
    - `indirect`: albedo/π × the light that blockers reflect, as far as they block: one diffuse bounce of the lights
      and of the environment, with their shadows;
    - `bent_normal`: Σ V ω / Σ V over the same rays, world space; its length is 2/3 where all is open;
    - `sh0` .. `sh3`: c_i = ∫ V y_i cosθ dω, four a buffer, the basis of `aolab.maths.harmonics`, world space;
    - `obscurance`: O = (1/π) ∫ μ(d) cosθ dω with the `measure` μ (classical, linear, sqrt, exponential with
      σ = 1/radius); `transfer`: W = O / (1 - (1/π) ∫ (1 - μ) a cosθ dω), a the blockers' albedo (Umenhoffer, Tóth and
      Szirmay-Kalos 2009, eq. 6); `transfer_multibounce`: the same by path tracing under a sky of 1, at most `bounces`
      reflections (what is still enclosed then is black), where a segment longer than the radius sees the sky;
    - `direct`: the lights, with hard shadows; `radiance` and `image`: direct + ambient + indirect, as rendered.

    `engine`: embree, numpy (tiny scenes), or auto. `mitsuba`, the second opinion, traces whole paths in a process of
    its own: it has no radius, and gives direct, ambient, indirect, radiance and image.
    Results are kept on disk (`AOLAB_CACHE`, else the platform's cache folder) by their content, unless `cache` is
    False. `progress` shows a bar; None shows it on a terminal.
    Raises `ParameterError`, and what `aolab.load` and `aolab.render` raise.
    """
    start = perf_counter()
    scene = load(scene)
    if engine == "mitsuba":
        if radius is not None or falloff or like is not None:
            raise ParameterError("engine = 'mitsuba' has no radius, falloff or like: it traces whole paths")
        from .mitsuba import path_traced

        wanted = ("direct", "ambient", "indirect", "radiance", "image") if buffers is None else buffers
        return path_traced(scene, size=size, camera=camera, samples=rays, seed=seed, buffers=wanted, cache=cache)
    buffers = DEFAULT_BUFFERS if buffers is None else buffers
    radius, falloff = _reach(scene, radius, falloff, like)
    wanted = _checked(buffers, rays, seed, measure, bounces, radius)
    surfaces = shared_lab().render(scene, "none", size=size, camera=camera)
    camera = camera or scene.camera
    assert camera is not None  # Scene frames itself
    view = View(camera, surfaces.size, scene.bounds)

    settings = {
        "rays": rays,
        "radius": None if np.isinf(radius) else radius,
        "falloff": falloff,
        "measure": measure,
        "bounces": bounces,
        "engine": engine,
    }
    info = {
        "aolab": __version__,
        "renderer": context.renderer(),
        "scene": scene.source,
        "module": "reference",
        "parameters": settings,
        "camera": asdict(camera),
        "size": list(view.size),
        "seed": seed,
        "triangles": scene.triangles,
    }
    made_of = {name: info[name] for name in ("aolab", "renderer", "camera", "size", "seed")}
    name = disk.key(scene, buffers=wanted, **settings, **made_of) if cache else ""
    arrays = disk.load(name) if cache else None
    info["cached"] = arrays is not None
    if arrays is None:
        assert scene.environment is not None  # Scene fills it in
        world = World(scene, engine)
        setting = Setting(world, scene.environment, scene.lights, radius, falloff, measure, bounces)
        needed = {"radiance" if name == "image" else name for name in wanted}
        surface = Surface(surfaces, scene, view, world)
        traced = trace(setting, surface, rays, seed, [name for name in BUFFERS if name in needed], progress)
        arrays = _pictures(traced, surface.pixel, surfaces.mask, setting, view, wanted)
        if cache:
            disk.store(name, arrays)
    milliseconds = (perf_counter() - start) * 1e3
    own = {name: surfaces[name] for name in ("viewZ", "viewNormal", "albedo")}
    return Frame({**own, **arrays}, {"reference": milliseconds}, info, milliseconds, scene=scene)


def _pictures(
    traced: dict[str, np.ndarray], pixel: np.ndarray, mask: np.ndarray, setting: Setting, view: View, wanted: list[str]
) -> dict[str, np.ndarray]:
    """(H, W[, channels]) from values at points; radiance over the environment, and the image of it."""
    full = {name: spread(values, pixel, view, BUFFERS[name].background) for name, values in traced.items()}
    if "radiance" in full:
        full["radiance"] = over_environment(full["radiance"], mask, setting.environment, view)
        full["image"] = shown(full["radiance"])
    return {name: full[name] for name in wanted}


def _reach(
    scene: Scene, radius: float | None, falloff: float, like: str | Module | type[Module] | None
) -> tuple[float, float]:
    """Radius (infinite for None) and falloff, from the arguments or from the module `like`."""
    if like is not None:
        if radius is not None or falloff:
            raise ParameterError("radius and falloff come from `like`; give either those or `like`")
        module = find(like, MODULES).resolved(scene)
        radius, falloff = getattr(module, "radius", None), getattr(module, "falloff", 0.0)
    if radius is not None and not radius > 0:
        raise ParameterError(f"radius = {radius!r} is not a length above 0 (None is unlimited)")
    if not 0 <= falloff <= 1:
        raise ParameterError(f"falloff = {falloff!r} is outside [0, 1]")
    return (np.inf if radius is None else float(radius)), float(falloff)


def _checked(buffers: Iterable[str], rays: int, seed: int, measure: str, bounces: int, radius: float) -> list[str]:
    """The wanted buffers in the table's order, after all arguments have been checked, before any work is done."""
    known = [*BUFFERS, "image"]
    wanted = [buffers] if isinstance(buffers, str) else list(buffers)
    for name in wanted:
        if name not in known:
            raise ParameterError(f"the reference has no buffer '{name}'{suggestion(name, known)}")
    next(strata(rays))
    if measure not in get_args(Measure):
        raise ParameterError(f"measure = {measure!r} is unknown{suggestion(str(measure), get_args(Measure))}")
    if not isinstance(seed, int) or seed < 0:
        raise ParameterError(f"seed = {seed!r} is not a whole number from 0 on")
    if not isinstance(bounces, int) or bounces < 0:
        raise ParameterError(f"bounces = {bounces!r} is not a whole number from 0 on")
    if np.isinf(radius) and measure != "classical" and {"obscurance", "transfer"} & set(wanted):
        raise ParameterError(f"measure = '{measure}' needs a radius; without one there is only 'classical'")
    return [name for name in known if name in wanted]
