"""Modules by name, by file, as a class or as an instance."""

import importlib.util
import re
import sys
import traceback
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from ..errors import FileError, ParameterError, suggestion
from ..queries import query
from .base import Module
from .combined import combined

Kinds = Mapping[str, type[Module]]


def find(module: "str | Module | type[Module]", modules: Kinds, **parameters: object) -> Module:
    """The module with these parameters; `modules` maps the known names to classes.

    `module` is an instance, a class, or a text with optional parameters, as in `"ssao?steps=4"`:

    - a name of `modules`;
    - `NAME+rsm`, a module with a part of another one: see `combined.py`;
    - `FILE.py:CLASS`, a class in a Python file; without CLASS, the only module of the file;
    - `FILE.frag:MODULE`, the declaration of another module with this fragment shader in place of its own.

    Parameters may be texts ("0.5"). Raises `ParameterError`, and `FileError` for a file that cannot be read.
    """
    if isinstance(module, str):
        name, written = query(module)
        module, parameters = _named(name, modules), {**written, **parameters}
    if isinstance(module, type) and issubclass(module, Module):
        return module(**module.read(parameters))
    if not isinstance(module, Module):
        raise ParameterError(
            f"module = {module!r} is not a module: give a name ({', '.join(modules)}), "
            "a class derived from aolab.Module, or an instance of one"
        )
    return module.replace(**type(module).read(parameters)) if parameters else module


def _named(name: str, modules: Kinds) -> type[Module]:
    if name in modules:
        return modules[name]
    if "+" in name:
        first, *parts = name.split("+")
        return combined(name, _named(first, modules), parts)
    if match := re.fullmatch(r"(.+?\.(?:frag|glsl)):(.+)", name):
        return _with_shader(name, _existing(match[1]).resolve(), _named(match[2], modules))  # pyright: ignore[reportArgumentType]
    if match := re.fullmatch(r"(.+\.py)(?::(\w+))?", name):
        return _from_python(_existing(match[1]), match[2])
    if name.endswith((".frag", ".glsl")):
        raise ParameterError(f"'{name}' is a shader: write {name}:MODULE, with the module whose declaration it has")
    raise ParameterError(f"no module '{_short(name)}'{suggestion(_short(name), modules)}")


def _from_python(path: Path, wanted: str | None) -> type[Module]:
    found = _modules_in(path, path.stat().st_mtime_ns)
    if wanted is None and len(found) != 1:
        raise ParameterError(f"{path} defines {len(found)} modules; write {path}:CLASS ({', '.join(found) or 'none'})")
    wanted = wanted or next(iter(found))
    if wanted not in found:
        raise ParameterError(f"{path} has no module '{wanted}'{suggestion(wanted, found)}")
    found[wanted].name = f"{path}:{wanted}"  # so that a picture names the file that it can be rendered with again
    return found[wanted]


@lru_cache(maxsize=64)
def _modules_in(path: Path, changed_ns: int) -> dict[str, type[Module]]:
    """The modules that a Python file defines, by the names of their classes; imported again when the file changes."""
    name = f"aolab_file_{abs(hash(path.resolve()))}_{changed_ns}"
    specification = importlib.util.spec_from_file_location(name, path)
    assert specification is not None
    contents = importlib.util.module_from_spec(specification)
    sys.modules[name] = contents  # pydantic looks annotations up there
    try:
        # not from a .pyc, which an edit of the same length in the same second would leave valid
        exec(compile(path.read_bytes(), str(path), "exec"), contents.__dict__)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
        place = f"{path}:{lines[-1]}" if lines else str(path)
        raise FileError(f"{place}: {type(error).__name__}: {error}") from error
    own = {key: value for key, value in vars(contents).items() if isinstance(value, type)}
    return {key: value for key, value in own.items() if issubclass(value, Module) and value.__module__ == name}


@lru_cache(maxsize=64)
def _with_shader(name: str, path: Path, module: type[Module]) -> type[Module]:
    """A subclass of the class `module` whose shader is the file `path`."""
    facts = {"name": name, "shader": path, "title": f"{module.title}, with the shader {path.name}"}
    return type(module.__name__, (module,), {"__module__": module.__module__, "__doc__": module.__doc__, **facts})


def _existing(text: str) -> Path:
    path = Path(text)
    try:
        exists = path.is_file()
    except (OSError, ValueError) as error:
        raise FileError(f"'{_short(text)}' is no file name: {getattr(error, 'strerror', None) or error}") from error
    if not exists and path.exists():
        raise FileError(f"{path} is no file; name the shader or the Python file in it")
    if not exists:
        beside = [str(one) for one in path.parent.glob(f"*{path.suffix}")] if path.parent.is_dir() else []
        raise FileError(f"no file {path}{suggestion(text, beside)}")
    return path


def _short(text: str) -> str:
    return text if len(text) <= 80 else f"{text[:80]}..."
