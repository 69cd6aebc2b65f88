"""The cases of a sweep: a grid over lists, lists that go together, and random draws."""

import itertools
import tomllib
import warnings
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import Error, FileError, ParameterError, notice, suggestion
from ...gl.texture import Size, check_size
from ...input import read_text
from ...modules import MODULES, Module, find
from ...modules.parameters import Choice
from ...progress import progress_bar
from ...scene.camera import Camera
from .case import Case, Settings, case_module, loaded, module_name, question, scene_name
from .measured import Measure, default, needs_truth, parse

DISTRIBUTIONS = ("uniform", "loguniform", "integers", "choice")
KEYS = ("scene", "module", "size", "seed", "camera", "measures", "accumulate", "reference", "rays", "images", "buffers")
TABLES = ("parameters", "zip", "random", "fixed")


@dataclass(frozen=True)
class Draw:
    """A random parameter: `uniform` or `loguniform` between two numbers, `integers` from low to high, or a `choice`."""

    kind: str
    values: tuple[Any, ...]

    def at(self, u: float) -> Any:
        """The value for `u` in [0, 1)."""
        if self.kind == "choice":
            return self.values[int(u * len(self.values))]
        low, high = self.values
        if self.kind == "uniform":
            return float(low + u * (high - low))
        if self.kind == "loguniform":
            return float(low * (high / low) ** u)
        return int(low + u * (high + 1 - low))


@dataclass(frozen=True)
class Plan:
    """A sweep as it is asked for. `cases` lists its cases, those with a common truth beside each other."""

    scenes: Sequence[Any]
    modules: Sequence[str | Module | type[Module]] = ("ssao",)
    sizes: Sequence[Size] = ((480, 270),)
    seeds: Sequence[int] = (0,)
    cameras: Mapping[str, Camera | None] = field(default_factory=lambda: {"": None})
    accumulate: int = 1
    settings: Settings = field(default_factory=Settings)
    grid: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    zipped: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    random: Mapping[str, Draw] = field(default_factory=dict)
    samples: int = 16
    sampler: str = "sobol"

    def __post_init__(self) -> None:
        for name, values in (("scenes", self.scenes), ("modules", self.modules), ("size", self.sizes),
                             ("seed", self.seeds), ("camera", self.cameras)):  # fmt: skip
            if not len(values):
                raise ParameterError(f"sweep: {name} is empty; a sweep needs at least one")
        for size in self.sizes:
            check_size(size)
        lengths = {name: len(values) for name, values in self.zipped.items()}
        if len(set(lengths.values())) > 1:
            raise ParameterError(f"sweep: zipped lists differ in length: {lengths}")
        for name, values in {**self.grid, **self.zipped}.items():
            if not len(values):
                raise ParameterError(f"sweep: the list of '{name}' is empty")
        if self.samples < 1:
            raise ParameterError(f"sweep: samples = {self.samples} is not a whole number from 1 on")
        owners = [name for table in (self.grid, self.zipped, self.random) for name in table]
        if twice := sorted({name for name in owners if owners.count(name) > 1}):
            raise ParameterError(f"sweep: {', '.join(twice)} stands in two tables; one decides")
        for one in self.settings.measures:
            if isinstance(one, str):
                parse(one)
        if needs_truth(self.settings.measures) and not self.settings.reference:
            asked = [one for one in self.settings.measures if isinstance(one, str) and needs_truth([one])]
            raise ParameterError(f"sweep: {', '.join(asked)} compares with the truth, but reference is False")
        self._check_names()

    def _check_names(self) -> None:
        """A parameter that no module has is an error; a module that lacks a parameter gets a `Notice`."""
        names = [*self.grid, *self.zipped, *self.random]
        lacking: dict[str, list[str]] = {}
        known: dict[str, None] = {}
        for module in self.modules:
            has = parameter_names(module)
            known |= dict.fromkeys(has)
            for name in names:
                if name not in has:
                    lacking.setdefault(name, []).append(module_name(module))
        for name, modules in lacking.items():
            if len(modules) == len(self.modules):
                raise ParameterError(f"sweep: no module here has the parameter '{name}'{suggestion(name, known)}")
            notice(f"sweep: {', '.join(modules)} has no '{name}': left out there")

    @staticmethod
    def _check_values(cases: Sequence[Case]) -> None:
        """Values that some modules or cases take are rows of the table; if no case takes them, they are a mistake."""
        first = None
        for case in cases:
            try:
                case_module(case)
            except Error as error:
                first = first or error
            else:
                return
        raise ParameterError(f"sweep: no case can be rendered; the first: {first}")

    def points(self) -> list[dict[str, Any]]:
        """The parameter values of the sweep, before a module leaves out those that it lacks."""
        grid = [dict(zip(self.grid, values, strict=True)) for values in itertools.product(*self.grid.values())]
        count = len(next(iter(self.zipped.values()))) if self.zipped else 1
        together = [{name: values[i] for name, values in self.zipped.items()} for i in range(count)]
        return [{**a, **b, **c} for a in grid for b in together for c in self._drawn()]

    def _drawn(self) -> list[dict[str, Any]]:
        if not self.random:
            return [{}]
        names = list(self.random)
        if self.sampler == "sobol":
            from scipy.stats import qmc

            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # scipy prefers powers of two
                units = qmc.Sobol(len(names), rng=0).random(self.samples)
        elif self.sampler == "uniform":
            units = np.random.default_rng(0).random((self.samples, len(names)))
        else:
            raise ParameterError(f"sweep: sampler = '{self.sampler}'{suggestion(self.sampler, ('sobol', 'uniform'))}")
        return [{name: self.random[name].at(float(u)) for name, u in zip(names, row, strict=True)} for row in units]

    @property
    def scene_labels(self) -> list[str]:
        """The scenes as the table shows them: of several with one name, the second is `NAME (2)`."""
        labels: dict[Any, str] = {}
        count = Counter[str]()
        for scene in self.scenes:
            name, key = scene_name(scene), _key(scene)
            if key not in labels:
                count[name] += 1
                labels[key] = name if count[name] == 1 else f"{name} ({count[name]})"
        return [labels[_key(scene)] for scene in self.scenes]

    @property
    def module_labels(self) -> list[str]:
        """The modules as the table shows them: of several with one name, with the parameters that differ from the
        defaults, as in `ssao?steps=8`.
        """
        names = [module_name(module) for module in self.modules]
        return [
            name if names.count(name) == 1 or isinstance(module, (str, type)) else f"{name}{_changes(module)}"
            for name, module in zip(names, self.modules, strict=True)
        ]

    def cases(self, progress: bool | None = None) -> list[Case]:
        """All cases, without repeats. Cases that share a truth are neighbours; so are those that share a G-buffer.

        `progress` is that of `progress_bar`: 100,000 cases take seconds. Raises `ParameterError` for a parameter that
        no case takes, and for values with which no case can be rendered.
        """
        found: dict[str, Case] = {}
        points = self.points()
        scenes = zip(self.scenes, self.scene_labels, strict=True)
        modules = list(zip(self.modules, self.module_labels, strict=True))
        views = list(itertools.product(scenes, self.sizes, self.cameras.items(), modules))
        with progress_bar("plan", len(views) * len(points), "point", shown=progress) as bar:
            for (scene, scene_label), size, (camera_name, camera), (module, module_label) in views:
                labels = scene_label, module_label
                for values in (taken(module, point) for point in points):
                    for seed in self.seeds:
                        case = Case(scene, module, values, size, seed, self.accumulate, camera, camera_name, *labels)
                        key = repr((id(scene), id(module), size, camera_name, seed, sorted(values.items(), key=repr)))
                        found.setdefault(key, case)
                    bar.update()
        for name in points[0]:
            if not any(name in case.parameters for case in found.values()):
                raise ParameterError(f"sweep: no case takes '{name}', a parameter of {_owner(self.modules, name)}")
        self._check_values(list(found.values()))
        groups: dict[tuple[Any, ...], list[Case]] = {}
        for case in found.values():
            groups.setdefault(question(case, self.settings), []).append(case)
        return [case for group in groups.values() for case in group]


def taken(module: str | Module | type[Module], point: Mapping[str, Any]) -> dict[str, Any]:
    """The values that the module takes: those of its own parameters, and those of the kinds that are chosen."""
    kind = find(module, MODULES)
    stated = type(kind).stated()

    def is_taken(name: str) -> bool:
        owner = stated.get(name)
        if owner is None or not issubclass(owner, Choice):
            return owner is not None
        chosen = point.get(owner.axis, getattr(kind, owner.axis))
        return owner.name == (chosen if isinstance(chosen, str) else chosen.name)

    return {name: value for name, value in point.items() if is_taken(name)}


def _key(scene: Any) -> Any:
    """A name for itself, and the identity of any other object."""
    return str(scene) if isinstance(scene, (str, Path)) else id(scene)


def _changes(module: Module) -> str:
    """The parameters that differ from the defaults, as `aolab.render` takes them behind a name: `?steps=8&bias=0`."""
    defaults = type(module)().values()
    changed = [f"{name}={value}" for name, value in module.values().items() if value != defaults.get(name)]
    return f"?{'&'.join(changed)}" if changed else ""


def _owner(modules: Sequence[str | Module | type[Module]], name: str) -> str:
    owners = {type(find(module, MODULES)).stated().get(name) for module in modules}
    return ", ".join(sorted(owner.label() for owner in owners if owner))


def parameter_names(module: str | Module | type[Module]) -> list[str]:
    """The parameters that the module takes. Raises `ParameterError` for an unknown module."""
    return list(type(find(module, MODULES)).stated())


def as_list(value: Any) -> list[Any]:
    """A single value as a list of one; a list, tuple, range or array as a list."""
    if isinstance(value, (str, Path)) or not isinstance(value, (Sequence, range, np.ndarray, set, frozenset)):
        return [value]
    return list(value)


def sizes_of(size: Any) -> list[Size]:
    """(width, height), or several of them."""
    several = isinstance(size, Iterable) and not isinstance(size, str) and not all(np.isscalar(side) for side in size)
    sizes: list[Any] = list(size) if several else [size]
    return [check_size(one) for one in sizes]


def cameras_of(camera: Any) -> dict[str, Camera | None]:
    """{name: camera} of a camera, a list of cameras, a mapping of named ones, or None for the scene's."""
    if camera is None or isinstance(camera, Camera):
        return {"": camera}
    if isinstance(camera, Mapping):
        return {str(name): one for name, one in camera.items()}
    return {str(index): one for index, one in enumerate(camera)}


def draw_of(name: str, text: Any) -> Draw:
    """A draw from `{uniform = [0.1, 1]}` or ("uniform", 0.1, 1). Raises `ParameterError`."""
    if isinstance(text, Draw):
        return text
    if isinstance(text, Mapping) and len(text) == 1:
        kind, values = next(iter(text.items()))
    elif isinstance(text, Sequence) and text and not isinstance(text, str):
        kind, values = text[0], text[1:]
    else:
        raise ParameterError(f"sweep: random {name} = {text!r} is not a distribution such as {{uniform = [0.1, 1]}}")
    if kind not in DISTRIBUTIONS:
        raise ParameterError(f"sweep: random {name}: no distribution '{kind}'{suggestion(str(kind), DISTRIBUTIONS)}")
    values = tuple(values)
    numbers = all(isinstance(value, (int, float)) for value in values)
    if not values or (kind != "choice" and (len(values) != 2 or not numbers or not values[0] < values[1])):
        raise ParameterError(f"sweep: random {name} = {kind} {list(values)}: two numbers, low before high, are needed")
    if kind == "loguniform" and values[0] <= 0:
        raise ParameterError(f"sweep: random {name} = loguniform {list(values)}: the low end is not above 0")
    return Draw(kind, values)


def measures_of(measures: Any, with_reference: bool) -> tuple[Measure, ...]:
    """A name, a function, or several; the default for None."""
    return default(with_reference) if measures is None else tuple(as_list(measures))


def read_spec(path: Path) -> Plan:
    """The plan in a TOML file. Raises `FileError` and `ParameterError`, which name the file and the key."""
    try:
        spec = tomllib.loads(read_text(path, str(path)))
    except (ValueError, RecursionError) as error:  # TOMLDecodeError too
        raise FileError(f"cannot read {path} as TOML: {error}") from error
    try:
        return plan_of(spec, path.parent)
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error


def plan_of(spec: Mapping[str, Any], folder: Path) -> Plan:
    """The plan of a specification: `KEYS` at the top, and the tables `TABLES`."""
    for name in spec:
        if name not in (*KEYS, *TABLES):
            raise ParameterError(f"unknown key '{name}'{suggestion(name, (*KEYS, *TABLES))}")
    if "scene" not in spec:
        raise ParameterError("the key 'scene' is missing: a name, a file, or a list of them")
    modules = as_list(spec.get("module", "ssao"))
    random = dict(spec.get("random", {}))
    samples, sampler = int(random.pop("samples", 16)), str(random.pop("sampler", "sobol"))
    fixed = {name: [value] for name, value in spec.get("fixed", {}).items()}
    with_reference = bool(spec.get("reference", True))
    return Plan(
        scenes=[_beside(scene, folder) for scene in as_list(spec["scene"])],
        modules=modules,
        sizes=[_size(size) for size in _sizes(spec.get("size", "480x270"))],
        seeds=[int(seed) for seed in as_list(spec.get("seed", 0))],
        cameras=_cameras(spec.get("camera")),
        accumulate=int(spec.get("accumulate", 1)),
        settings=Settings(
            measures_of(spec.get("measures"), with_reference),
            with_reference,
            int(spec.get("rays", 256)),
            bool(spec.get("images", False)),
            tuple(as_list(spec.get("buffers", []))),
        ),
        grid={**{name: as_list(value) for name, value in spec.get("parameters", {}).items()}, **fixed},
        zipped={name: as_list(value) for name, value in spec.get("zip", {}).items()},
        random={name: draw_of(name, value) for name, value in random.items()},
        samples=samples,
        sampler=sampler,
    )


def _beside(scene: Any, folder: Path) -> Any:
    """A file of the specification's folder, where there is one of this name."""
    file = folder / str(scene)
    return str(file) if file.is_file() else scene


def _sizes(value: Any) -> list[Any]:
    return [value] if isinstance(value, list) and all(isinstance(side, int) for side in value) else as_list(value)


def _size(value: Any) -> Size:
    """'640x360' or [640, 360]."""
    parts = value.lower().split("x") if isinstance(value, str) else value
    try:
        width, height = (int(part) for part in parts)
    except (TypeError, ValueError):
        raise ParameterError(f"size = {value!r} is not WIDTHxHEIGHT, as in '640x360'") from None
    return width, height


def _cameras(value: Any) -> dict[str, Camera | None]:
    """{name: camera} of a table of `eye`, `target`, `fov`, or of a table of such tables."""
    if value is None:
        return {"": None}
    if not isinstance(value, Mapping):
        raise ParameterError(f"camera = {value!r} is not a table of eye, target and fov")
    if "eye" in value:
        return {"": _camera("camera", value)}
    return {name: _camera(name, one) for name, one in value.items()}


def _camera(name: str, value: Mapping[str, Any]) -> Camera:
    known = Camera.__dataclass_fields__
    for key in value:
        if key not in known:
            raise ParameterError(f"camera '{name}' has no '{key}'{suggestion(key, known)}")
    try:
        values: dict[str, Any] = {key: tuple(one) if isinstance(one, list) else one for key, one in value.items()}
        return Camera(**values)
    except TypeError as error:
        raise ParameterError(f"camera '{name}': {error}") from None


def check_scenes(plan: Plan) -> None:
    """Load each scene once, so that a misspelt name is refused before the work."""
    for scene in plan.scenes:
        loaded(scene)
