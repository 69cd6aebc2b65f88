"""The lab: keeps programs, textures and geometry between frames, and runs the passes of each."""

import operator
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from time import perf_counter
from typing import Any

from ..errors import Notice, ParameterError
from ..gl import context
from ..gl.program import Programs
from ..gl.texture import Pool, Size, check_size, refuse_exhaustion
from ..modules import MODULES, Module, find
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..scene.lights import Light
from ..scene.scene import Scene
from ..scene.view import View
from ..version import __version__
from . import lighting, surfaces
from .estimate import Run, estimate
from .frame import Frame, lend
from .geometry import Geometry
from .lighting import Display, EnvironmentMaps, ToneMap
from .occluders import KINDS, Stage
from .pass_runner import Buffers, Painter
from .shadows import ShadowMaps, draw_shadows

DEFAULT_SIZE = (1280, 720)


@dataclass(eq=False)
class Unlit:
    """All of a frame that light has no part in, so that it can be lit again: `run` with its painter's work done, the
    surfaces and, unless the module's is `lit`, the estimate."""  # fmt: skip

    run: Run
    buffers: Buffers


class Lab:
    """Renders scenes with modules. One lab for a session is enough; `aolab.render` keeps one of its own.

    `size` is (width, height) in pixels. With `watch`, shader files that changed are compiled before each frame;
    one that does not compile raises once, and then the last good program is used until the next edit.
    """

    def __init__(self, size: Size = DEFAULT_SIZE, *, watch: bool = False) -> None:
        self.size = size
        self.watch = watch
        context.get()
        self._programs, self._pool, self._geometry = Programs(), Pool(), Geometry()
        self._environments, self._depth = EnvironmentMaps(), surfaces.DepthTargets()
        self._samplers = surfaces.border_samplers()
        self._shadows: tuple[tuple[object, ...], ShadowMaps] | None = None
        self._sizes: set[Size] = set()

    def reload(self) -> list[str]:
        """Compile the shaders whose files changed; returns their names.

        Raises `ShaderError` for one that does not compile: then the last good programs stay in use.
        """
        return self._programs.reload(only_changed=True)

    def render(
        self,
        scene: Any,
        module: str | Module | type[Module] = "ssao",
        *,
        camera: Camera | None = None,
        size: Size | None = None,
        seed: int = 0,
        accumulate: int = 1,
        exposure: float = 1.0,
        tone_map: ToneMap = "filmic",
        **parameters: object,
    ) -> Frame:
        """Render one frame.

        `scene` is anything that `aolab.load` takes; `module` a name, class or instance; `parameters` are the module's.
        `camera` defaults to the scene's. `seed` chooses the sample set; `accumulate` averages that many frames with
        different sets. Raises `ParameterError`, `SceneError`, `ShaderError`, `GpuMemoryError`, `ContextError`.
        """
        start = perf_counter()
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", Notice)
            frame = self._render(
                _as_scene(scene),
                find(module, MODULES, **parameters),
                camera,
                check_size(size or self.size),
                _whole("seed", seed, 0),
                _whole("accumulate", accumulate, 1),
                _display(exposure, tone_map),
            )
        frame.notes = [str(note.message) for note in caught]
        frame.frame_ms = (perf_counter() - start) * 1e3
        for note in caught:
            warnings.warn_explicit(note.message, note.category, note.filename, note.lineno)
        return frame

    def relight(
        self,
        frame: Frame,
        *,
        environment: Environment | None = None,
        lights: Sequence[Light] | None = None,
        exposure: float | None = None,
        tone_map: ToneMap | None = None,
    ) -> Frame:
        """The same view under another light: only what light has a part in is computed again.

        What is not given stays as it was in `frame`, a frame of `render` or `relight`. Where occlusion is apart from
        light (`ssao`, `ssbn`, `s3ho`) its estimate stays; SSDO looks the environment up for each direction and has to
        look again. Raises `ParameterError` for a frame that no lab rendered, and what `render` raises.
        """
        start = perf_counter()
        if not isinstance(frame, Frame) or not isinstance(frame.kept, Unlit):
            what = f"this frame, of {frame.info.get('module')}," if isinstance(frame, Frame) else repr(frame)
            raise ParameterError(f"relight: {what} was not rendered by a lab; there is no estimate to light")
        unlit = frame.kept
        changes: dict[str, Any] = {"environment": environment, "lights": lights}
        assert frame.scene is not None  # it was rendered
        scene = frame.scene.replace(**{name: value for name, value in changes.items() if value is not None})
        display = _display(
            frame.info["exposure"] if exposure is None else exposure,
            frame.info["tone_map"] if tone_map is None else tone_map,
        )
        self._begin()
        lit = self._lit(Painter(self._programs, self._pool, self._samplers), unlit, scene, display)
        lit.notes = list(frame.notes)
        lit.frame_ms = (perf_counter() - start) * 1e3
        return lit

    def _render(
        self, scene: Scene, module: Module, camera: Camera | None, size: Size, seed: int, frames: int, display: Display
    ) -> Frame:
        self._begin()
        camera = camera or scene.camera
        assert camera is not None  # Scene frames itself
        module = module.resolved(scene)
        view = View(camera, size, scene.bounds)
        self._make_room({view.size, view.scaled(module.scale).size})
        painter = Painter(self._programs, self._pool, self._samplers)
        unlit = self._unlit(painter, scene, module, view, range(seed, seed + frames))
        return self._lit(painter, unlit, scene, display)

    def _begin(self) -> None:
        context.collect()
        if self.watch:
            self._programs.reload(only_changed=True, tell_again=False)

    def _make_room(self, sizes: set[Size]) -> None:
        """After a change of resolution, free the textures of the old one that no frame holds."""
        if sizes != self._sizes:
            self._pool.trim(sizes)
            self._sizes = sizes

    def _unlit(self, painter: Painter, scene: Scene, module: Module, view: View, seeds: range) -> Unlit:
        """The surfaces, and the module's estimate if no light takes part in it."""
        with self._lending(painter):
            buffers = surfaces.g_buffer(painter, self._geometry, self._depth, scene, view)
            stage = Stage(painter, self._geometry, self._depth, scene, view)
            occluders = KINDS[module.occluders](stage, module, buffers)
            small = surfaces.shrink(painter, buffers, view, view.scaled(module.scale)) if module.scale < 1 else {}
            run = Run(painter, module, occluders, {}, view, seeds, small)
            if not module.lit:
                buffers |= estimate(run, module.estimate(), buffers)
            refuse_exhaustion(f"the surfaces of a frame of {view.size[0]}x{view.size[1]}")
        lent, painter.lent = painter.lent, []
        return lend(Unlit(run, buffers), self._pool, lent)

    def _lit(self, painter: Painter, unlit: Unlit, scene: Scene, display: Display) -> Frame:
        """A frame from what is known of the surfaces, under the light of `scene`."""
        module, view, occluders = unlit.run.module, unlit.run.view, unlit.run.occluders
        assert scene.environment is not None  # Scene fills it in
        with self._lending(painter):
            tables = self._environments.tables(scene.environment, module.tables())
            lit_by = lighting.Illumination(scene, self._shadow_maps(painter, scene), tables)
            run = replace(unlit.run, painter=painter, inputs=tables)
            buffers = dict(unlit.buffers)
            if module.lit:
                buffers |= estimate(run, module.estimate(), buffers)
            buffers |= lighting.light(painter, buffers, lit_by, view, module, occluders)
            if bounce := module.bounce():
                sent = lighting.senders(painter, buffers, lit_by, view, occluders)
                buffers["sender"] = sent["sender"]
                run = replace(run, occluders=replace(occluders, inputs=occluders.inputs | sent))
                buffers |= estimate(run, bounce, buffers)
                buffers |= lighting.bounced(painter, buffers, view)
            buffers |= lighting.compose(painter, buffers, self._environments.of(scene.environment), view, display)
            refuse_exhaustion(f"a frame of {view.size[0]}x{view.size[1]}")
        info = {
            "aolab": __version__,
            "renderer": context.renderer(),
            "scene": scene.source,
            "module": module.name or type(module).__name__,
            "parameters": module.model_dump(),
            "question": asdict(module.question()),
            "camera": asdict(view.camera),
            "size": list(view.size),
            "seed": run.seeds.start,
            "accumulate": len(run.seeds),
            **asdict(display),
            "triangles": scene.triangles,
        }
        derived = {f"{name}{raw}": (make, raw) for name, make in module.derived.items() for raw in ("", "_raw")}
        frame = Frame(buffers, painter.timer.result(), info, derived=derived, scene=scene, kept=unlit)
        return lend(frame, self._pool, painter.lent)

    @contextmanager
    def _lending(self, painter: Painter) -> Iterator[None]:
        """If this fails, what the painter holds goes back: no frame will give it back."""
        try:
            yield
        except BaseException:
            self._pool.give_back(painter.lent)
            raise

    def _shadow_maps(self, painter: Painter, scene: Scene) -> ShadowMaps:
        """Kept while instances and lights are the same objects: a still scene's shadows are drawn once."""
        key = (scene.instances, scene.lights, painter.programs.generation)
        if self._shadows is None or self._shadows[0] != key:
            self._shadows = key, draw_shadows(painter, self._geometry, scene)
        return self._shadows[1]


def _as_scene(scene: Any) -> Scene:
    if isinstance(scene, Scene):
        return scene
    from ..loading import load

    return load(scene)


def _whole(name: str, value: int, least: int) -> int:
    try:
        number = operator.index(value)  # NumPy's whole numbers too
    except TypeError:
        number = least - 1
    if number < least:
        raise ParameterError(f"{name} = {value!r} is not a whole number from {least} on")
    return number


def _display(exposure: float, tone_map: ToneMap) -> Display:
    if not 0 < exposure < float("inf"):
        raise ParameterError(f"exposure = {exposure!r} is not a number above 0")
    if tone_map not in ("filmic", "linear"):
        raise ParameterError(f"tone_map = {tone_map!r} is not one of: filmic, linear")
    return Display(exposure, tone_map)
