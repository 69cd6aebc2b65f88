"""The lab: keeps programs, textures and geometry between frames, and runs the passes of each."""

import operator
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields, replace
from functools import partial
from numbers import Real
from time import perf_counter
from typing import Any
from weakref import WeakSet

import moderngl

from ..errors import ParameterError, notice
from ..gl import context
from ..gl.bindings import Bindings
from ..gl.program import Programs
from ..gl.texture import DEPTH, Pool, Size, check_size, refuse_exhaustion
from ..gl.thread import handed
from ..modules import MODULES, Module, ModuleName, find
from ..modules.buffers import BUFFERS, REFLECTIVE
from ..modules.occluders.base import Occluders
from ..modules.virtual_lights import VirtualLights
from ..scene import clipping
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..scene.lights import Light
from ..scene.scene import Scene
from ..scene.view import View
from ..version import __version__
from . import lighting, palettes, surfaces
from .doubts import doubts, is_own
from .environments import EnvironmentMaps
from .estimate import estimate
from .frame import Frame, Later, lend, noting
from .geometry import Geometry
from .last_frame import NO_LAST, last_frame
from .lighting import Display, Lights, Lit, ToneMap
from .palettes import Palettes
from .pass_runner import Buffers, PassRunner, Where
from .plan import Plan
from .rasterizer import DepthTargets, Rasterizer
from .reflective import DEFAULT_SIZE as MAP_SIZE
from .reflective import ReflectiveMaps, draw_reflective
from .senders import senders
from .shadows import ShadowSettings, draw_shadows
from .state import FrameContext, SurfaceState
from .virtual_lights import VirtualLightMaps, draw_virtual_lights

DEFAULT_SIZE = (1280, 720)
MOST_ACCUMULATED = 16384  # frames: the noise is 1/128 of that of one frame


class Lab:
    """Renders scenes with modules. One lab for a session is enough; `aolab.render` keeps one of its own.

    `size` is (width, height) in pixels. Edits of the shader files of your own modules are seen by the next frame. With
    `watch`, all shader files that changed are compiled before each frame; a file that does not compile raises once,
    and the last good program is used until the next edit.
    """

    @handed
    def __init__(self, size: Size = DEFAULT_SIZE, *, watch: bool = False) -> None:
        self.size = check_size(size)
        self.watch = watch
        self._programs, self._pool, self._geometry = Programs(), Pool(), Geometry()
        self._environments, self._palettes, self._depth = EnvironmentMaps(), Palettes(), DepthTargets()
        self._shadows: tuple[tuple[object, ...], Bindings] | None = None
        self._seen: tuple[tuple[object, ...], View, str | None] | None = None
        self._plan: tuple[tuple[object, ...], Plan, list[str]] | None = None
        self._virtual: dict[str, tuple[tuple[object, ...], VirtualLightMaps]] = {}
        self._sky: tuple[object, ...] | None = None  # all that the background of the last picture depended on
        self._sizes: set[Size] = set()
        self._waiting: WeakSet[Frame] = WeakSet()  # for their light

    @property
    def programs_compiled(self) -> int:
        """The number of shader programs that this lab has compiled and keeps."""
        return len(self._programs)

    @handed
    def __repr__(self) -> str:
        width, height = self.size
        return f"<Lab {width}x{height} on {context.renderer()}>"

    @handed
    def reload(self) -> list[str]:
        """Compile the shaders whose files changed; returns their names.

        Raises `ShaderError` for one that does not compile: then the last good programs stay in use.
        """
        return self._reload()

    @handed
    def render(
        self,
        scene: Any,
        module: ModuleName | str | Module | type[Module] = "ssao",
        *,
        camera: Camera | None = None,
        size: Size | None = None,
        seed: int = 0,
        accumulate: int = 1,
        exposure: float = 1.0,
        tone_map: ToneMap = "filmic",
        last: Frame | None = None,
        **parameters: object,
    ) -> Frame:
        """Render one frame.

        `scene` is anything that `aolab.load` takes; `module` a name, class or instance; `parameters` are the module's.
        `camera` defaults to the scene's. `seed` chooses the sample set; `accumulate` averages that many frames with
        different sets, at most 16384. `last` is the frame before this one, for modules that read it.
        Raises `ParameterError`, `SceneError`, `ShaderError`, `GpuMemoryError`, `ContextError`.
        """
        start, notes = perf_counter(), list[str]()
        with noting(notes):
            frame = self._render(
                _as_scene(scene),
                find(module, MODULES, **parameters),
                camera,
                check_size(self.size if size is None else size),
                _whole("seed", seed, 0),
                _whole("accumulate", accumulate, 1, MOST_ACCUMULATED),
                _display(exposure, tone_map),
                last,
            )
            frame.frame_ms = (perf_counter() - start) * 1e3
        frame.notes = notes
        return frame.complete() if last is not None else frame  # it may read the last frame, which need not live on

    @handed
    def relight(
        self,
        frame: Frame,
        *,
        environment: Environment | None = None,
        lights: Sequence[Light] | None = None,
        exposure: float | None = None,
        tone_map: ToneMap | None = None,
    ) -> Frame:
        """The same view under another light: only the lighting is computed again.

        Arguments that are not given stay as they are in `frame`, a frame of `render` or `relight`. Modules whose
        estimate does not depend on light (`ssao`, `ssbn`, `s3ho`) keep it; SSDO reads the environment in each
        direction, so that its estimate is computed again.
        Raises `ParameterError` for a frame that no lab rendered, and the errors of `render`.
        """
        start = perf_counter()
        if not isinstance(frame, Frame) or not isinstance(frame.kept, SurfaceState):
            what = f"this frame, of {frame.info.get('module')}," if isinstance(frame, Frame) else repr(frame)
            raise ParameterError(f"relight: {what} was not rendered by a lab; there is no estimate to light")
        changes: dict[str, Any] = {"environment": environment, "lights": lights}
        assert frame.scene is not None  # it was rendered
        scene = frame.scene.replace(**{name: value for name, value in changes.items() if value is not None})
        display = _display(
            frame.info["exposure"] if exposure is None else exposure,
            frame.info["tone_map"] if tone_map is None else tone_map,
        )
        self._begin(frame.kept.frame.module)
        lit = self._frame(frame.kept, self._rasterizer(scene, NO_LAST), display)
        lit.notes = list(frame.notes)
        lit.frame_ms = (perf_counter() - start) * 1e3
        return lit.complete()

    def _render(
        self,
        scene: Scene,
        module: Module,
        camera: Camera | None,
        size: Size,
        seed: int,
        frames: int,
        display: Display,
        last: Frame | None,
    ) -> Frame:
        self._begin(module)
        camera = scene.camera if camera is None else camera
        if not isinstance(camera, Camera):
            raise ParameterError(f"camera = {camera!r:.80} is not an aolab.Camera")
        plan = self._planned(module, scene)
        view, reason_of_cut = self._view(camera, scene, size)
        self._make_room({view.size, view.scaled(module.scale).size})
        rasterizer = self._rasterizer(scene, last_frame(last, view))
        frame = FrameContext(rasterizer, plan, view, range(seed, seed + frames))
        drawn = context.get().query(samples=True)
        result = self._frame(self._state(frame, drawn), frame.rasterizer, display)
        if not drawn.samples:
            notice(f"nothing is drawn: {clipping.reason_of_nothing(scene, view)}")
        elif reason_of_cut:
            notice(reason_of_cut)
        if is_own(module) or self._programs.generation:  # a module of the user's own, or a shader that was edited
            for doubt in doubts(result, module.outputs):
                notice(doubt)
        return result

    def _planned(self, module: Module, scene: Scene) -> Plan:
        """The plan of the module's frames, kept while module and scene stay the same, and the shaders' texts.

        That of a user's own module, or choice, is made for each frame: its class may change between two of them.
        """
        key = module, scene, self._programs.readings
        if self._plan is not None and self._plan[0] == key:
            for note in self._plan[2]:
                notice(note)
            return self._plan[1]
        notes: list[str] = []
        with noting(notes):
            plan = Plan(module.resolved(scene), self._programs.declared)
        self._plan = None if plan.is_own else (key, plan, notes)
        return plan

    def _view(self, camera: Camera, scene: Scene, size: Size) -> tuple[View, str | None]:
        """The camera's view, and the reason why its clip planes cut the scene, if they do.

        A view keeps its uniforms, and the lab keeps the view while the camera and the scene's parts stay the same.
        """
        key = (camera, size, scene.instances)
        if self._seen is None or self._seen[0] != key:
            view = View(clipping.unclipped(camera, scene, size), size, scene.bounds)
            self._seen = key, view, clipping.reason_of_cut(scene, view)
        return self._seen[1:]

    def _rasterizer(self, scene: Scene, last: Bindings) -> Rasterizer:
        """The means to draw one frame of the scene."""
        return Rasterizer(PassRunner(self._programs, self._pool), self._geometry, self._depth, scene, last)

    def _begin(self, module: Module) -> None:
        context.collect()
        if self.watch:
            self._reload(tell_again=False)
        elif is_own(module) and self._programs.changed():  # its file may be open in an editor
            self._finish_waiting()
            self._programs.forget_changed()

    def _reload(self, **how: bool) -> list[str]:
        """Compile the files that changed."""
        if self._programs.changed():
            self._finish_waiting()
        return self._programs.reload(only_changed=True, **how)

    def _finish_waiting(self) -> None:
        """Frames that wait for their picture get it from the programs before a change."""
        for frame in [*self._waiting]:
            frame.complete("image")

    def _make_room(self, sizes: set[Size]) -> None:
        """After a change of resolution, free the textures of the old one that no frame holds."""
        if sizes != self._sizes:
            self._pool.trim(sizes)
            self._sizes = sizes

    def _state(self, frame: FrameContext, drawn: moderngl.Query) -> SurfaceState:
        """The surfaces, whose pixels `drawn` counts, and the estimate of a module that does not depend on light."""
        module, view, runner = frame.module, frame.view, frame.runner
        with self._lending(runner):
            depth = runner.take(view.size, DEPTH)
            with drawn:
                large = self._surfaces(frame, depth)
            small_view = view.scaled(module.scale) if module.scale < 1 else view
            small = surfaces.shrink(runner, large, view, small_view) if module.scale < 1 else large
            hiding = occluders(frame, large)
            state = SurfaceState(frame, large, small, small_view, hiding, {}, Where(depth))
            if not module.lit:
                state = replace(state, estimate=estimate(state, frame.plan.estimate))
            refuse_exhaustion(f"the surfaces of a frame of {view.size[0]}x{view.size[1]}")
        lent, runner.lent = runner.lent, []
        return lend(state, self._pool, lent)

    def _surfaces(self, frame: FrameContext, depth: moderngl.Texture) -> Buffers:
        """The surface buffers at full size. Where a palette is enough, `palette` stands in the place of `albedo`."""
        formats = surface_formats(frame)
        if palettes.is_enough(frame) and not self._programs.generation:  # an edited shader may read more
            buffers = self._palettes.surfaces(frame, formats, depth)
        else:
            buffers = frame.rasterizer.surfaces([frame.view], formats=formats, depth=depth)
        if frame.plan.asked.buffers & {"facetNormal", "last_facetNormal"}:
            buffers |= surfaces.facet_normals(frame.runner, buffers, frame.view)
        return buffers

    def _frame(self, kept: SurfaceState, rasterizer: Rasterizer, display: Display) -> Frame:
        """A frame from kept surfaces. Its light, that of the rasterizer's scene, is computed when it is first read."""
        state = kept.under(rasterizer)
        frame, runner, scene = state.frame, rasterizer.runner, rasterizer.scene
        plan, module, view = frame.plan, frame.module, frame.view
        with self._lending(runner):
            reflective = REFLECTIVE if plan.asked.reflective else ()
            lights = self._lights(state) if module.lit or reflective else None
            if module.lit and lights is not None:
                state = replace(state, estimate=estimate(state, plan.estimate, lights.seen_from(view)))
            refuse_exhaustion(f"a frame of {view.size[0]}x{view.size[1]}")
        info = {
            "aolab": __version__,
            "renderer": context.renderer(),
            "scene": scene.source,
            "module": module.name or type(module).__name__,
            "parameters": dict(plan.values),
            "question": _fields(plan.question),
            "camera": _fields(view.camera),
            "size": list(view.size),
            "seed": frame.seeds.start,
            "accumulate": len(frame.seeds),
            **_fields(display),
            "triangles": scene.triangles,
        }
        shown = {**surfaces.shown(state.large), **state.estimate}
        result = Frame(
            shown,
            runner.timer.result(),
            info,
            derived={f"{name}{raw}": (make, raw) for name, make in module.derived.items() for raw in ("", "_raw")},
            table=BUFFERS | {row.name: row for row in module.buffers},
            scene=scene,
            kept=kept,
            later=self._later(state, lights, display, reflective),
        )
        self._waiting.add(result)
        return lend(result, self._pool, runner.lent)

    def _later(
        self, state: SurfaceState, lights: Lights | None, display: Display, reflective: Iterable[str]
    ) -> list[Later]:
        """The light: the picture alone, if a single pass draws it, and all buffers of light. And stored surfaces."""
        plan = state.frame.plan
        names = [*lighting.names(plan), *reflective]
        later = [Later(names, partial(self._made, state, partial(self._lit, lights, display), "the light of a frame"))]
        if lighting.in_one_pass(plan):
            picture = partial(self._picture, lights, display)
            later.insert(0, Later(["image"], partial(self._made, state, picture, "a picture")))
        for name, make in _stored(state).items():
            later.append(Later([name], partial(self._made, state, make, f"the buffer '{name}' of a frame")))
        return later

    def _lights(self, state: SurfaceState) -> Lights:
        """All that shines on the frame's scene, as its module reads it."""
        frame, scene, module = state.frame, state.frame.scene, state.frame.module
        assert scene.environment is not None  # Scene fills it in
        tables = self._environments.tables(scene.environment, module.tables())
        lamps = self._lamps(frame.rasterizer, ShadowSettings.of(module))
        reflective = None
        if frame.plan.asked.reflective:
            reflective = draw_reflective(frame.rasterizer, lamps, int(module.numbers().get("rsm_resolution", MAP_SIZE)))
        steps = [step for step in frame.plan.lighting if isinstance(step, VirtualLights)]
        virtual = {step.name: self._virtual_lights(frame, step, reflective) for step in steps}
        return Lights(lamps, scene.environment, tables, reflective, virtual)

    def _virtual_lights(
        self, frame: FrameContext, step: VirtualLights, reflective: ReflectiveMaps | None
    ) -> VirtualLightMaps:
        """Kept while the scene's parts are the same objects, as the shadow maps are."""
        scene, module = frame.scene, frame.module
        source = scene.environment if step.source == "environment" else (scene.lights, module.numbers())
        key = (scene.instances, source, step, frame.seeds.start, self._programs.generation)
        if step.name not in self._virtual or self._virtual[step.name][0] != key:
            maps = draw_virtual_lights(frame.rasterizer, step, reflective, frame.seeds.start)
            self._virtual[step.name] = key, maps
        return self._virtual[step.name][1]

    def _made(
        self, state: SurfaceState, make: Callable[[SurfaceState, Frame], Buffers], what: str, result: Frame
    ) -> tuple[Buffers, dict[str, float]]:
        """The buffers that `make` draws for a frame that waits for them, and the milliseconds of the passes.

        `what` they are is for errors. The textures live as long as the frame.
        """
        rasterizer = self._rasterizer(state.frame.scene, state.frame.last)
        runner = rasterizer.runner
        with self._lending(runner):
            buffers = make(state.under(rasterizer), result)
            refuse_exhaustion("{} of {}x{}".format(what, *state.frame.view.size))
        if result.lit is not None:
            self._waiting.discard(result)
        lend(result, self._pool, runner.lent)
        return buffers, runner.timer.result()

    def _picture(self, lights: Lights | None, display: Display, state: SurfaceState, _: Frame) -> Buffers:
        """The picture of a frame. The sky of a still camera is drawn once."""
        lights = lights or self._lights(state)
        last, self._sky = self._sky, (state.frame.view.camera, state.frame.view.size, lights.sky, display)
        still = self._sky if last == self._sky else None
        return lighting.image(state, lights, self._environments.of(lights.sky), display, still)

    def _lit(self, lights: Lights | None, display: Display, state: SurfaceState, result: Frame) -> Buffers:
        """The light of a frame, and all else that waits."""
        runner, view = state.frame.runner, state.frame.view
        lights = lights or self._lights(state)
        buffers, sending = lighting.light(state, lights), state
        if bounce := state.frame.plan.bounce:
            sender, sending = senders(state, buffers, lights)
            known = [Bindings("the lighting", {**buffers, **sender}), Bindings("the estimate", state.estimate)]
            gathered = estimate(sending, bounce, [*known, *lights.seen_from(view)])
            buffers |= {**sender, **gathered, **lighting.bounced(runner, state.large, buffers, gathered, view)}
        if lights.reflective:
            buffers |= lights.reflective.buffers
        sky = self._environments.of(lights.sky)
        buffers |= lighting.compose(runner, {**state.large, **state.estimate, **buffers}, sky, view, display)
        result.lit = Lit(lights, sending)
        return buffers

    @contextmanager
    def _lending(self, runner: PassRunner) -> Iterator[None]:
        """If this fails, the textures that the runner holds go back: no frame will give them back."""
        try:
            yield
        except BaseException:
            self._pool.give_back(runner.lent)
            raise

    def _lamps(self, rasterizer: Rasterizer, settings: ShadowSettings) -> Bindings:
        """The lamps with their shadow maps, kept while instances and lights are the same objects.

        The shadows of a still scene are drawn once.
        """
        key = (rasterizer.scene.instances, rasterizer.scene.lights, settings, self._programs.generation)
        if self._shadows is None or self._shadows[0] != key:
            self._shadows = key, lighting.lamps(rasterizer.scene, draw_shadows(rasterizer, settings))
        return self._shadows[1]


def _stored(state: SurfaceState) -> dict[str, Callable[[SurfaceState, Frame], Buffers]]:
    """{name: its pass} of the buffers that the G-buffer stores in another form, and that nobody has asked for."""
    passes: dict[str, Callable[[SurfaceState, Frame], Buffers]] = {}
    if "albedo" not in state.large:
        passes["albedo"] = lambda state, _: palettes.albedo(state)
    if "facets" in state.large and "facetNormal" not in state.large:
        passes["facetNormal"] = lambda state, _: surfaces.facet_normals(
            state.frame.runner, state.large, state.frame.view
        )
    return passes


def surface_formats(frame: FrameContext) -> dict[str, str]:
    """The buffers of surfaces to draw: those of every frame, and those that a pass of the module samples."""
    names = frame.plan.asked.buffers - {"facets"}
    names |= {"facets"} if frame.scene.is_smooth else set()
    names |= {"geometricNormal"} if frame.scene.bends_normals else set()
    names |= {"emission"} if frame.scene.emits else set()
    return surfaces.G_BUFFER | {name: format for name, format in surfaces.BESIDES.items() if name in names}


def occluders(frame: FrameContext, large: Buffers) -> Occluders:
    """The occluders of the module's choice; nothing is drawn where no pass of the module includes "occluders.glsl"."""
    if not frame.plan.asked.occluders:
        return Occluders(frame.plan.occluders.bindings())
    return frame.plan.occluders.draw(frame.rasterizer, frame.view, large, frame.module.sends())


def _fields(values: Any) -> dict[str, Any]:
    """{name: value} of a dataclass whose values are no dataclasses; `asdict` would look into each."""
    return {one.name: getattr(values, one.name) for one in fields(values)}


def _as_scene(scene: Any) -> Scene:
    if isinstance(scene, Scene):
        return scene
    from ..loading import load

    return load(scene)


def _whole(name: str, value: int, least: int, most: int | None = None) -> int:
    try:
        number = operator.index(value)  # NumPy's whole numbers too
    except TypeError:
        number = least - 1
    if number < least or (most is not None and number > most):
        range_of = f"from {least} on" if most is None else f"from {least} to {most}"
        raise ParameterError(f"{name} = {value!r:.80} is not a whole number {range_of}")
    return number


def _display(exposure: float, tone_map: ToneMap) -> Display:
    if not isinstance(exposure, Real) or not 0 < exposure < float("inf"):
        raise ParameterError(f"exposure = {exposure!r} is not a number above 0")
    if tone_map not in ("filmic", "linear"):
        raise ParameterError(f"tone_map = {tone_map!r} is not one of: filmic, linear")
    return Display(exposure, tone_map)
