"""`aolab.reference`: the same buffers as a render's, by rays against all triangles."""

from collections.abc import Iterable
from dataclasses import asdict
from numbers import Real
from typing import Any, Literal

import numpy as np

from ..errors import ParameterError, notice, suggestion
from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..modules import MODULES, Module, find
from ..modules.marched import Marched
from ..modules.question import Question
from ..pipeline.frame import Frame
from ..scene.camera import Camera
from ..scene.scene import Scene
from .adaptive import MOST_BATCHES, root_mean_square
from .buffers import BUFFERS, base_of, standard_error, with_errors
from .casters import Engine
from .hemisphere import strata
from .picture import over_environment, shown, spread
from .points import Surface
from .sample import Setting
from .shot import Shot
from .sky import Sky
from .tracing import trace
from .world import World

DEFAULT_SIZE = (640, 360)
DEFAULT_BUFFERS = ("visibility", "ambient", "bent_normal", "indirect")
Like = str | Module | type[Module] | Question | Frame


def reference(
    scene: Any,
    *,
    like: Like | None = None,
    size: Size | None = None,
    camera: Camera | None = None,
    buffers: Iterable[str] | None = None,
    rays: int = 256,
    error: float | None = None,
    seed: int = 0,
    engine: Engine | Literal["mitsuba"] = "auto",
    cache: bool = True,
    progress: bool | None = None,
    **question: Any,
) -> Frame:
    """Ray-traced truth for `scene`, at the surface points of aolab's own G-buffer: pixels correspond one to one.

    `question` holds fields of `aolab.Question`: `radius` (scene units; None, the default, is unlimited), `falloff` (0,
    a hard edge, by default; the modules' own default is softer), `measure`, ... `like` takes the question from a
    module, by name, class or instance, from a `Question`, or from a frame, with the frame's size and camera.

    `rays`, even, are cast from each pixel's centre, stratified, with density cosθ/π around the G-buffer's normal. They
    start off the surface (`World.lift`, `points.Surface`); a ray that leads under its triangle, as shading normals
    allow, is mirrored at the triangle's plane (`points.Points.ways`). All triangles block, from both
    sides; holes of cut-out textures do not.
    `error` is a target for the standard error, as a share of the buffer's root mean square over the image: pixels get
    up to 16 times `rays` where the error around them is greater. A `Notice` names a buffer that misses the target.

    `buffers` chooses what is computed, and what it costs. Each comes with its standard error, as `NAME_standard_error`;
    that of `visibility` is `standard_error`. Besides viewZ, viewNormal and albedo, which are the render's:

    - `visibility`: mean of the openness 1 - blocked;
    - `ambient`: albedo/π × the environment's radiance in the open directions, times their openness;
    - `indirect`: albedo/π × the light that blockers reflect, as far as they block: one diffuse bounce of the lights
      and of the environment, with their shadows. Blockers receive the environment's light as far as their own radius
      lets them under `like` a module (`Question.limited_senders`), and physically otherwise;
    - `bent_normal`: Σ V ω / Σ V over the same rays, world space; its length is 2/3 where all is open;
    - `sh0` .. `sh3`: c_i = ∫ V y_i cosθ dω, four a buffer, the basis of `aolab.maths.harmonics`, world space;
    - `obscurance`: O = (1/π) ∫ μ(d) cosθ dω with the `measure` μ; `transfer`: W = O / (1 - (1/π) ∫ (1 - μ) a cosθ dω),
      a the blockers' albedo (Umenhoffer, Tóth and Szirmay-Kalos 2009, eq. 6); `transfer_multibounce`: the same by path
      tracing under a sky of 1, at most `bounces` reflections (what is still enclosed then is black), where a segment
      longer than the radius sees the sky;
    - `direct`: the lights, with hard shadows; `radiance` and `image`: direct + ambient + indirect, as rendered.
    - `rays`, with `error` alone: the rays that each pixel got.

    `engine`: embree, numpy (tiny scenes), or auto. `mitsuba`, the second opinion, traces whole paths in a process of
    its own: it has no question, and gives direct, ambient, indirect, radiance and image.
    Results are kept on disk (`AOLAB_CACHE`, else the platform's cache folder) by their content, unless `cache` is
    False. `progress` shows a bar; None shows it on a terminal.
    Raises `ParameterError`, and what `aolab.load` and `aolab.render` raise. A `Notice` names the falloff where
    `radius` is given alone.
    """
    scene = load(scene)
    if isinstance(like, Frame):
        size, camera = like.size if size is None else size, camera or like.camera
    size = DEFAULT_SIZE if size is None else size
    if engine == "mitsuba":
        if question or error is not None or not (like is None or isinstance(like, Frame)):
            raise ParameterError("engine = 'mitsuba' has no radius, falloff, like or error: it traces whole paths")
        from .mitsuba import path_traced

        wanted = ("direct", "ambient", "indirect", "radiance", "image") if buffers is None else buffers
        return path_traced(scene, size=size, camera=camera, samples=rays, seed=seed, buffers=wanted, cache=cache)
    asked = _asked(scene, like, question)
    wanted = _checked(DEFAULT_BUFFERS if buffers is None else buffers, rays, seed, error, asked)
    shot = Shot.take(scene, size, camera)

    def make(missing: list[str]) -> dict[str, np.ndarray]:
        assert scene.environment is not None  # Scene fills it in
        world = World(scene, engine)  # type: ignore[arg-type]  # not mitsuba
        setting = Setting(world, Sky(scene.environment), scene.lights, asked, rays)
        needed = {"radiance" if base_of(name) == "image" else base_of(name) for name in missing} - {"rays"}
        surface = Surface(shot.surfaces, scene, shot.view, world, asked.normals)
        traced = trace(setting, surface, [name for name in BUFFERS if name in needed], seed, error, progress)
        return {name: values for name, values in _pictures(traced, surface, shot).items() if name in missing}

    settings: dict[str, Any] = {"rays": rays, **asdict(asked), "engine": engine, "error": error}
    if error is not None:
        settings["buffers"] = wanted  # they decide together where rays are needed
    names = with_errors(wanted) + (["rays"] if error is not None else [])
    frame = shot.frame(context.renderer(), settings, asked, seed, names, make, cache)
    if error is not None:
        _tell_missed(frame, error)
    return frame


def _pictures(traced: dict[str, np.ndarray], surface: Surface, shot: Shot) -> dict[str, np.ndarray]:
    """(H, W[, channels]) from values at points; radiance over the environment, and the image of it."""
    full = {
        name: spread(values, surface.pixel, shot.view, 0.0 if name in (*BUFFERS, "rays") else np.nan)
        for name, values in traced.items()
    }
    if "radiance" in full:
        assert shot.scene.environment is not None  # Scene fills it in
        if "emission" in shot.surfaces.buffers:
            full["radiance"] = full["radiance"] + shot.surfaces["emission"]
        full["radiance"] = over_environment(full["radiance"], shot.surfaces.mask, shot.scene.environment, shot.view)
        full["image"] = shown(full["radiance"])
    return full


def _tell_missed(frame: Frame, error: float) -> None:
    """A `Notice` about the buffers whose standard error, over the image, is above the target."""
    mask = frame.mask
    for name in BUFFERS:
        if name in frame.buffers and mask.any():
            reached = root_mean_square(frame[standard_error(name)][mask])
            scale = root_mean_square(frame[name][mask])
            if reached > error * scale:
                notice(
                    f"error = {error:g} is not met in '{name}', by {MOST_BATCHES} × rays a pixel at most: the standard "
                    f"error is {reached / scale:.2g} of the root mean square; raise `rays`"
                )


def _asked(scene: Scene, like: Like | None, changes: dict[str, Any]) -> Question:
    """The question of `like`, or the physical one, with `changes`."""
    if like is None:
        if changes.get("radius") is not None and not changes.keys() & {"falloff", "measure"}:
            notice(
                "the reference's falloff is 0, a hard edge at the radius; that of modules is "
                f"{Marched.model_fields['falloff'].default} by default: give `like` a module, or state `falloff`"
            )
        return Question().replace(**changes)
    if given := [name for name in ("radius", "falloff", "spread") if changes.get(name)]:
        raise ParameterError(f"{given[0]} comes from `like`; give either {given[0]} or `like`")
    if isinstance(like, Question):
        question = like
    elif isinstance(like, Frame):
        if "question" not in like.info:
            raise ParameterError(f"like: a frame of {like.info.get('module')} does not say its question; give radius")
        question = Question(**like.info["question"])
    else:
        question = find(like, MODULES).resolved(scene).question()
    return question.replace(**{name: value for name, value in changes.items() if value is not None})


def _checked(buffers: Iterable[str], rays: int, seed: int, error: float | None, question: Question) -> list[str]:
    """The wanted buffers in the table's order, without errors, after all arguments were checked, before any work."""
    known = [*BUFFERS, "image"]
    wanted = [base_of(name) for name in ([buffers] if isinstance(buffers, str) else list(buffers))]
    for name in wanted:
        if name not in known:
            raise ParameterError(f"the reference has no buffer '{name}'{suggestion(name, known)}")
    next(strata(rays))
    if not isinstance(seed, int) or seed < 0:
        raise ParameterError(f"seed = {seed!r} is not a whole number from 0 on")
    if error is not None and not (isinstance(error, Real) and 0 < error < 1):
        raise ParameterError(f"error = {error!r} is not a share in (0, 1) of the buffer's root mean square")
    measured = {"obscurance", "transfer"} & set(wanted) and question.measure != "classical"
    faded = isinstance(question.falloff, str) and question.falloff != "classical"
    for name, fading, used in (("measure", question.measure, measured), ("falloff", question.falloff, faded)):
        if question.radius is None and used:
            raise ParameterError(f"{name} = {fading!r} needs a radius; without one there is only 'classical'")
    return [name for name in known if name in wanted]
