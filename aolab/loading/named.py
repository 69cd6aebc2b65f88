"""The scenes of `scenes/`: `NAME.py` defines `NAME(**parameters) -> Scene`."""

import importlib.util
import inspect
import math
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from numbers import Integral, Real
from pathlib import Path
from types import FunctionType
from urllib.parse import quote

from .. import paths
from ..errors import Error, FileError, ParameterError, SceneError, suggestion
from ..pictures.html import Listing
from ..queries import query
from ..scene.scene import Scene

TRUTHS = {"true": True, "1": True, "yes": True, "on": True, "false": False, "0": False, "no": False, "off": False}


@dataclass(frozen=True)
class SceneDescription:
    """`summary` is the first line of the file's docstring, or else the function's; `parameters` maps to defaults."""

    name: str
    summary: str
    parameters: dict[str, object]


def scene_names() -> list[str]:
    """The names of the scenes in `scenes/`, sorted."""
    return sorted(path.stem for path in paths.scenes().glob("[!_]*.py") if path.stem.isidentifier())


def scenes() -> Listing:
    """The names of the scenes in `scenes/` and their summaries; a notebook shows a table."""
    return Listing("scene", {name: describe_scene(name).summary for name in scene_names()})


def describe_scene(name: str) -> SceneDescription:
    """The description that `aolab scenes` prints. Raises `FileError` for an unknown scene."""
    function = _function(name)
    document = str(function.__globals__["__doc__"] or inspect.getdoc(function) or "")
    defaults = {key: parameter.default for key, parameter in _signature(function).items()}
    return SceneDescription(name, document.strip().partition("\n")[0], defaults)


def load_scene(source: str, parameters: Mapping[str, object]) -> Scene | None:
    """The scene that `source` (`NAME` or `NAME?key=value&...`) names; None if it is no such name but a path.

    Raises `FileError` for an unknown scene, `ParameterError` for an unknown, repeated or ill-typed parameter.
    """
    name = source.partition("?")[0]
    if not name.isidentifier():
        return None
    function = _function(name)
    known = _signature(function)
    values: dict[str, object] = {}
    for key, value in [*query(source)[1].items(), *parameters.items()]:
        if key not in known:
            raise ParameterError(f"scene '{name}' has no parameter '{key}'{suggestion(key, known)}{_defaults(known)}")
        if key in values:
            raise ParameterError(f"scene '{name}': parameter '{key}' is given twice")
        try:
            values[key] = _convert(value, _type(known[key]))
        except (TypeError, ValueError, KeyError):
            kind = getattr(_type(known[key]), "__name__", str(_type(known[key])))
            raise ParameterError(f"scene '{name}': {key} = {value!r} is not a {kind}{_defaults(known)}") from None
    try:
        scene = function(**values)
    except Error:
        raise
    except Exception as error:
        raise SceneError(f"scene '{name}' failed: {type(error).__name__}: {error}") from error
    if not isinstance(scene, Scene):
        raise SceneError(f"scene '{name}' returned a {type(scene).__name__}, not an aolab.Scene")
    changed = [
        f"{key}={quote(_text(values[key]), safe=',+-.')}"
        for key in known
        if key in values and values[key] != known[key].default
    ]
    return scene.replace(name=name, source="?".join([name, *(["&".join(changed)] if changed else [])]))


def _function(name: str) -> FunctionType:
    path = paths.scenes() / f"{name}.py"
    if name not in scene_names():
        kind = "; a directory of that name exists, but a model is a file" if Path(name).is_dir() else ""
        raise FileError(f"no scene '{name}' in {path.parent}{suggestion(name, scene_names())}{kind}")
    return _import(path, path.stat().st_mtime_ns)


@lru_cache(maxsize=64)
def _import(path: Path, changed_ns: int) -> FunctionType:
    """The scene function; imported once per change of its file, so that meshes the scene keeps stay on the GPU."""
    specification = importlib.util.spec_from_file_location(f"aolab_scenes_{path.stem}_{changed_ns}", path)
    assert specification is not None
    module = importlib.util.module_from_spec(specification)
    try:
        # not from a .pyc, which an edit of the same length in the same second would leave valid
        exec(compile(path.read_bytes(), str(path), "exec"), module.__dict__)
    except Exception as error:
        raise FileError(f"scene '{path.stem}' ({path}) cannot be imported: {type(error).__name__}: {error}") from error
    function = getattr(module, path.stem, None)
    if not inspect.isfunction(function):
        raise FileError(f"scene '{path.stem}' ({path}) defines no function {path.stem}()")
    return function


def _signature(function: Callable[..., object]) -> dict[str, inspect.Parameter]:
    return dict(inspect.signature(function, eval_str=True).parameters)


def _defaults(known: Mapping[str, inspect.Parameter]) -> str:
    if not known:
        return " (it takes no parameters)"
    return " (parameters: " + ", ".join(f"{key}={_text(known[key].default)}" for key in known) + ")"


def _type(parameter: inspect.Parameter) -> object:
    """The type a value is converted to: the annotation's, without None, or the default's."""
    annotation = parameter.annotation
    if annotation is inspect.Parameter.empty:
        return type(parameter.default)
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        annotation = next(choice for choice in typing.get_args(annotation) if choice is not type(None))
    return typing.get_origin(annotation) or annotation


def _convert(value: object, kind: object) -> object:
    """`value` as a `kind`; strings are parsed. Raises `ValueError`, `TypeError` or `KeyError` where it is none."""
    if kind is bool:
        return TRUTHS[value.lower()] if isinstance(value, str) else _instance(value, bool)
    if kind is int:
        return int(value) if isinstance(value, str) else int(_instance(value, Integral))  # type: ignore[call-overload]
    if kind is float:
        number = float(value) if isinstance(value, str) else float(_instance(value, Real))  # type: ignore[arg-type]
        if not math.isfinite(number):
            raise ValueError
        return number
    if kind is tuple:
        items = value.split(",") if isinstance(value, str) else value
        return tuple(_convert(item, float) for item in typing.cast(Sequence[object], items))
    return _instance(value, str) if kind is str else value


def _instance(value: object, kind: type) -> object:
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise TypeError
    return value


def _text(value: object) -> str:
    """`value` as it is written in a query."""
    if isinstance(value, bool):
        return str(value).lower()
    return ",".join(_text(item) for item in value) if isinstance(value, tuple) else str(value)
