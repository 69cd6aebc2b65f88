"""Model files: checked before they are read, and every failure told in terms of the file."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from os import PathLike
from pathlib import Path

import numpy as np

from .. import paths
from ..errors import Error, FileError, ParameterError, SceneError, shorten, suggestion
from ..input import Budget, kind, read_file
from ..scene.scene import Scene
from .folder import Folder
from .options import FileOptions, options_from, query_of, turned_up
from .parts import Content, scene_of

# by the end of the file's name: the format, and the module of this package whose `read` reads it
FORMATS = {
    ".glb": ("glTF", "gltf.reader"),
    ".gltf": ("glTF", "gltf.reader"),
    ".obj": ("Wavefront OBJ", "obj"),
    ".ply": ("PLY", "ply"),
    ".stl": ("STL", "stl"),
    ".off": ("OFF", "off"),
    ".3mf": ("3MF", "threemf"),
}
LFS_POINTER = b"version https://git-lfs.github.com/spec/"
ANIMATED = "glTF"
Z_UP = "3MF"
# formats that people try, and the way to one that is read
OTHERS = {
    ".gz": "decompress it first",
    ".zip": "extract it first",
    ".7z": "extract it first",
    ".dae": "export it as .glb",
    ".fbx": "export it as .glb",
    ".blend": "export it as .glb from Blender",
    ".usd": "export it as .glb",
    ".usda": "export it as .glb",
    ".usdc": "export it as .glb",
    ".usdz": "export it as .glb",
    ".vrm": "rename it to .glb: it is glTF",
    ".3ds": "export it as .glb",
    ".x3d": "export it as .glb",
    ".wrl": "export it as .glb",
    ".step": "export it as .glb or .stl",
    ".stp": "export it as .glb or .stl",
    ".ifc": "export it as .glb",
}


def load_file(source: str | PathLike[str], keywords: Mapping[str, object]) -> Scene:
    """The scene in a model file. Raises `FileError`, `SceneError` and `ParameterError`, all naming the file."""
    path, query = _path_and_query(source)
    options = options_from(str(path), query, keywords)
    file_format, module = FORMATS[path.suffix.lower()]
    if file_format != ANIMATED and (options.time is not None or options.animation is not None):
        raise ParameterError(f"{path}: time and animation are for {ANIMATED}; {file_format} has no animations")
    # numbers of a file may be of any size: `Mesh` and others refuse what is not finite
    with _named_errors(path, file_format), np.errstate(all="ignore"):
        content = _content(path, file_format, module, options)
        source = path.name if path.parent == paths.scenes() else path  # so that a picture's metadata serve anywhere
        return scene_of(content, shorten(path.stem), f"{source}{query_of(options)}", options.shadows)


def _content(path: Path, file_format: str, module: str, options: FileOptions) -> Content:
    budget = Budget(options.memory)
    data = read_file(path, "the file", budget)
    if not data:
        raise FileError("is empty (0 bytes)")
    if data.startswith(LFS_POINTER):
        raise FileError("is a pointer of Git LFS in place of the file; 'git lfs pull' fetches the file")
    root = turned_up(options.up_axis or ("z" if file_format == Z_UP else "y"))
    read: Callable[..., Content] = import_module(f".{module}", __package__).read
    return read(data, path, Folder(path, budget), options, root)


def _path_and_query(source: str | PathLike[str]) -> tuple[Path, str]:
    """The existing file that `source` names, and the parameters behind its name."""
    text = str(source)
    if "://" in text:
        raise FileError(f"'{shorten(text, 200)}' is a URL; download the file and load that")
    name, separator, query = text.rpartition("?")
    if separator and not _exists(text):
        return _existing_file(_found(name)), query
    return _existing_file(_found(text)), ""


def _found(name: str) -> str:
    """The path of the model of that name that comes with aolab, in scenes/, unless a file of that name is here."""
    shipped = paths.scenes() / name
    if Path(name).name == name and Path(name).suffix.lower() in FORMATS and not _exists(name) and _exists(str(shipped)):
        return str(shipped)
    return name


def _exists(text: str) -> bool:
    try:
        return Path(text).exists()
    except (OSError, ValueError):
        return False


def _existing_file(source: str) -> Path:
    path = Path(source)
    known = ", ".join(FORMATS)
    try:
        exists, is_directory = path.exists(), path.is_dir()
        mode = path.stat().st_mode if exists else 0
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it holds a zero character"
        raise FileError(f"'{shorten(source, 200)}' is no file name: {reason}") from error
    if is_directory:
        models = ", ".join(_models(path)) or "it holds no model"
        raise FileError(f"{path} is a directory; give a file in it ({models})")
    if not exists:
        if not path.parent.is_dir():
            raise FileError(f"no file {path}: there is no folder {path.parent}")
        here, shipped = _models(path.parent), _models(paths.scenes())
        told = suggestion(path.name, here) if here else f"; the folder {path.parent.resolve()} holds no model"
        raise FileError(f"no file {path}{told}; models that come with aolab: {', '.join(shipped)}")
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        way = f"; {OTHERS[suffix]}" if suffix in OTHERS else ""
        raise FileError(f"{path}: unknown extension '{path.suffix}'{way}; known: {known}")
    if not path.is_file():
        raise FileError(f"{path} is {kind(mode)}; give a regular file")
    return path


def _models(folder: Path) -> list[str]:
    return sorted(child.name for child in folder.iterdir() if child.suffix.lower() in FORMATS)


@contextmanager
def _named_errors(path: Path, file_format: str) -> Iterator[None]:
    """Our errors get the file's name; an error that no reader foresaw becomes a `FileError`."""
    try:
        yield
    except Error as error:
        if str(path) in str(error):
            raise
        named = (
            SceneError
            if isinstance(error, SceneError)
            else ParameterError
            if isinstance(error, ParameterError)
            else FileError
        )
        text = str(error)
        joined = f"{path} {text}" if text.startswith(("is ", "ends ", "holds ")) else f"{path}: {text}"
        raise named(joined) from error
    except Warning:  # a notice, where the caller turns notices into errors
        raise
    except MemoryError as error:
        raise FileError(f"{path}: there is not enough memory to read it") from error
    except Exception as error:
        raise FileError(
            f"cannot read {path} as {file_format}: it is corrupt in a way that the reader did not foresee"
        ) from error
