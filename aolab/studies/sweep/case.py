"""One case of a sweep: scene, module, parameters, camera, size and seed; and the record of its result."""

import hashlib
import inspect
import json
import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from ... import paths
from ...errors import Error, Notice
from ...gl.source import declared
from ...gl.texture import Size
from ...loading import load
from ...modules import MODULES, Module, find
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.scene import Scene
from ...truth import cache as disk
from ...truth import reference
from ...version import __version__
from .measured import Measure, buffers_of, measure

PACKAGE = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Settings:
    """The part of a sweep that all its cases share.

    `measures` are names as in `measured.measure`, or functions of the frame and the truth. With `reference`, a truth of
    `rays` rays a pixel is computed for each question. `images` and `buffers` name what is written beside the records.
    """

    measures: tuple[Measure, ...] = ()
    reference: bool = True
    rays: int = 256
    images: bool = False
    buffers: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Case:
    """One point of the sweep. `scene` is anything that `aolab.load` takes; `parameters` are the module's, as given.

    The labels stand in the table where several scenes or modules of the sweep have one name.
    """

    scene: Any
    module: str | Module | type[Module]
    parameters: Mapping[str, Any] = field(default_factory=dict)
    size: Size = (480, 270)
    seed: int = 0
    accumulate: int = 1
    camera: Camera | None = None
    camera_name: str = ""
    scene_label: str = ""
    module_label: str = ""

    @property
    def columns(self) -> dict[str, Any]:
        """The inputs as plain values, a column each."""
        named = {"camera": self.camera_name} if self.camera_name else {}
        return {
            "scene": self.scene_label or scene_name(self.scene),
            "module": self.module_label or module_name(self.module),
            "width": self.size[0],
            "height": self.size[1],
            "seed": self.seed,
            **({"accumulate": self.accumulate} if self.accumulate != 1 else {}),
            **named,
            **self.parameters,
        }

    @property
    def title(self) -> str:
        """'boxes ssao 480x270 seed=0 radius=0.5': how messages name the case."""
        parameters = " ".join(f"{name}={value}" for name, value in self.parameters.items())
        camera = f" camera={self.camera_name}" if self.camera_name else ""
        width, height = self.size
        names = f"{self.columns['scene']} {self.columns['module']}"
        return f"{names} {width}x{height} seed={self.seed}{camera} {parameters}".strip()


def scene_name(scene: Any) -> str:
    """The scene as the table shows it: its name, its file, or the type of the object."""
    if isinstance(scene, Scene):
        return scene.source or scene.name
    return str(scene) if isinstance(scene, (str, Path)) else type(scene).__name__


def module_name(module: str | Module | type[Module]) -> str:
    """The name by which users call the module."""
    if isinstance(module, str):
        return module
    kind = module if isinstance(module, type) else type(module)
    return kind.name or kind.__name__


def case_module(case: Case) -> Module:
    """The module with the case's parameters. Raises `ParameterError` for a value outside its range."""
    return find(case.module, MODULES, **case.parameters)


_loaded: dict[str, Scene] = {}


def loaded(scene: Any) -> Scene:
    """The scene; a scene that a name stands for is loaded once a process."""
    if not isinstance(scene, (str, Path)):
        return load(scene)
    name = str(scene)
    if name not in _loaded:
        _loaded[name] = load(scene)
    return _loaded[name]


_digests: dict[int, tuple[Scene, str]] = {}


def _scene_digest(scene: Scene) -> str:
    if id(scene) not in _digests:
        _digests[id(scene)] = scene, disk.key(scene)
    return _digests[id(scene)][1]


@cache
def code_digest() -> str:
    """A hash of the package's sources and shaders: another version computes its cases anew."""
    digest = hashlib.sha256()
    for root in (PACKAGE, paths.glsl()):
        for file in sorted(file for file in root.rglob("*") if file.suffix in (".py", ".frag", ".vert", ".glsl")):
            digest.update(file.read_bytes())
    return digest.hexdigest()


def identity(case: Case, settings: Settings) -> str:
    """A hash of all that the case's result depends on: scene content, parameters, camera, measures, and the code.

    A case that cannot be resolved, say for a wrong value, is identified by its inputs alone.
    """
    try:
        chosen = case_module(case)
        module: Any = repr(chosen.values())
        source = _own_sources(chosen) if module_name(case.module) not in MODULES else []
        scene = _scene_digest(loaded(case.scene))
    except Exception:  # the case itself will raise it, and record it
        module, source, scene = repr(dict(case.parameters)), [], scene_name(case.scene)
    asked = [name if isinstance(name, str) else _source(name) for name in settings.measures]
    parts = {
        "scene": scene,
        "module": [module_name(case.module), module, source],
        "size": list(case.size),
        "seed": case.seed,
        "accumulate": case.accumulate,
        "camera": asdict(case.camera) if case.camera else None,
        "measures": asked,
        "rays": settings.rays if settings.reference else 0,
        "code": code_digest(),
    }
    return hashlib.sha256(json.dumps(parts, sort_keys=True, default=str).encode()).hexdigest()[:24]


def _own_sources(module: Module) -> list[str]:
    """The sources of a module's classes and shaders that are not the package's: `code_digest` has the others."""
    kinds = [one for one in type(module).__mro__ if issubclass(one, Module) and not one.__module__.startswith("aolab.")]
    shaders = [module.shader, *(getattr(step, "shader", "") for step in module.passes())]
    files = {file for shader in shaders if shader for file in declared(shader).files}
    own = sorted(file for file in files if not file.is_relative_to(paths.glsl()))
    texts = [shader for shader in shaders if isinstance(shader, str)]
    return [*map(_source, kinds), *texts, *(file.read_text(encoding="utf-8-sig") for file in own)]


def _source(function: Callable[..., Any]) -> str:
    try:
        return inspect.getsource(function)
    except (OSError, TypeError):  # typed at a prompt
        return getattr(function, "__qualname__", repr(function))


_last_truth: list[tuple[Any, Frame]] = []  # its question, and the truth: cases that share a truth are neighbours


def truth_of(case: Case, settings: Settings) -> Frame | None:
    """The reference that answers the module's question: the same radius and falloff; None if no measure needs it.

    It is kept on disk, so computed once; several buffers of one case come from one reference.
    """
    if not settings.reference or not buffers_of(settings.measures):
        return None
    key = _scene_digest(loaded(case.scene)), *question(case, settings), settings.rays, buffers_of(settings.measures)
    if not _last_truth or _last_truth[0][0] != key:
        _last_truth[:] = [(key, traced(case, settings))]
    return _last_truth[0][1]


def traced(case: Case, settings: Settings, cache: bool = True) -> Frame:
    """The truth of the case, from the disk if `cache` allows it."""
    return reference(
        loaded(case.scene),
        size=case.size,
        camera=case.camera,
        rays=settings.rays,
        like=case_module(case),
        buffers=buffers_of(settings.measures),
        cache=cache,
        progress=False,
    )


def question(case: Case, settings: Settings) -> tuple[Any, ...]:
    """The cases that agree in this share a truth; cases that agree in its beginning share a G-buffer."""
    surfaces = case.columns["scene"], case.camera_name, repr(case.camera), case.size
    if not settings.reference:
        return surfaces
    try:
        return (*surfaces, case_module(case).resolved(loaded(case.scene)).question())
    except Exception:  # the case itself will raise it, and record it
        return (*surfaces, None)


def render(case: Case) -> Frame:
    """The frame of a case."""
    chosen = {"camera": case.camera, "size": case.size, "seed": case.seed, "accumulate": case.accumulate}
    return shared_lab().render(loaded(case.scene), case_module(case), **chosen)


KEPT = {"shadows", "reflective shadow maps", "voxels"}  # passes whose result the next frames of a still scene share
_computed: set[tuple[Any, ...]] = set()


def _is_first(frame: Frame, case: Case) -> bool:
    """Is the case this process's first of its scene, module and words? `frame` is the case's.

    A driver may compile a program again in such a case: for another format of a texture, say.
    """
    words = [value for value in frame.info["parameters"].values() if isinstance(value, str)]
    kind = (case.columns["scene"], frame.info["module"], *words)
    first = kind not in _computed
    _computed.add(kind)
    return first


def _warm(frame: Frame, case: Case) -> Frame:
    """The same frame again, with the same buffers computed: without compilation of shaders and maps drawn once."""
    again = render(case)
    return again.complete(*frame.made)


def run(case: Case, settings: Settings, name: str = "") -> tuple[dict[str, Any], dict[str, bytes]]:
    """Compute one case. Returns its record, and {file: content} of the pictures and buffers that were asked for.

    The record holds inputs, measures, times, renderer, version, status and error. An error of the case becomes part of
    the record; `KeyboardInterrupt` passes.
    """
    start = time.perf_counter()
    record: dict[str, Any] = {"case": name, **case.columns}
    files: dict[str, bytes] = {}
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", Notice)
            truth = truth_of(case, settings)
            begun, programs = time.perf_counter(), shared_lab().programs_compiled
            frame = render(case)
            record |= measure(frame, truth, settings.measures)
            files = _files(frame, settings, name)
            compiled = shared_lab().programs_compiled > programs
            if _is_first(frame, case) or compiled or not KEPT.isdisjoint(frame.timings):
                frame = _warm(frame, case)
        outcome = {
            "ms": sum(frame.timings.values()),
            "frame_ms": frame.frame_ms,
            "seconds": time.perf_counter() - begun,
            "renderer": frame.info["renderer"],
            "status": "ok",
            "error": "",
            "notes": "; ".join(sorted({str(note.message) for note in caught})),
            "timings": frame.timings,
            "values": frame.info["parameters"],
        }
    except Exception as error:
        kind = "" if isinstance(error, Error) else f"{type(error).__name__}: "
        outcome = failure(f"{kind}{error}", time.perf_counter() - start)
    return plain({**record, **outcome, "aolab": __version__}), files


def failure(error: str, seconds: float = 0.0) -> dict[str, Any]:
    """The outcome of a case that has no result."""
    return {"seconds": seconds, "renderer": "", "status": "failed", "error": error}


def _files(frame: Frame, settings: Settings, name: str) -> dict[str, bytes]:
    files = {}
    if settings.images:
        files[f"images/{name}.png"] = frame._repr_png_()
    if settings.buffers:
        data = BytesIO()
        np.savez_compressed(data, **{buffer: frame[buffer] for buffer in settings.buffers})  # type: ignore[arg-type]
        files[f"buffers/{name}.npz"] = data.getvalue()
    return files


def plain(value: Any) -> Any:
    """The value as JSON holds it: numbers, text, lists and mappings."""
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    if isinstance(value, np.generic):
        return value.item()
    return value if isinstance(value, (str, int, float, bool)) or value is None else str(value)
