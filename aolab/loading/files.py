"""Model files: checked before they are read, and every failure told in terms of the file."""

import io
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import Error, FileError, Notice, SceneError, suggestion
from ..pictures.images import read_image
from ..scene.mesh import Texture
from ..scene.scene import Scene
from .folder import Folder, decoded
from .reading import read_trimesh

if TYPE_CHECKING:
    pass

FORMATS = {".glb": "glTF", ".gltf": "glTF", ".obj": "Wavefront OBJ", ".ply": "PLY", ".stl": "STL"}


def load_file(source: str | PathLike[str]) -> Scene:
    """The scene in a model file. Raises `FileError` and `SceneError`, both naming the file."""
    path = _existing_file(source)
    file_format = FORMATS[path.suffix.lower()]
    folder = Folder(path)
    with _named_errors(path, file_format):
        if file_format == "glTF":
            from .gltf import scene_from_gltf

            scene = scene_from_gltf(path, folder)
        else:
            scene = _scene_from_other(path, folder)
        return scene.replace(name=path.stem, source=str(source))


def _existing_file(source: str | PathLike[str]) -> Path:
    path = Path(source)
    known = ", ".join(FORMATS)
    if "://" in str(source):
        raise FileError(f"'{source}' is a URL; download the file and load that")
    try:
        exists, is_directory = path.exists(), path.is_dir()
    except (OSError, ValueError) as error:
        raise FileError(f"'{source}' is no file name: {error}") from error
    if is_directory:
        models = sorted(child.name for child in path.iterdir() if child.suffix.lower() in FORMATS)
        raise FileError(f"{path} is a directory; give a file in it ({', '.join(models) or 'it holds no model'})")
    if not exists:
        if not path.parent.is_dir():
            raise FileError(f"no file {path}: there is no folder {path.parent}")
        models = [child.name for child in path.parent.iterdir() if child.suffix.lower() in FORMATS]
        raise FileError(f"no file {path}{suggestion(path.name, models)}")
    if path.suffix.lower() not in FORMATS:
        raise FileError(f"{path}: unknown extension '{path.suffix}'; known: {known}")
    if path.is_file() and path.stat().st_size == 0:
        raise FileError(f"{path} is empty (0 bytes)")
    return path


@contextmanager
def _named_errors(path: Path, file_format: str) -> Iterator[None]:
    """Our errors get the file's name; everything else that a reader raises becomes a `FileError` with its reason."""
    try:
        yield
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from error
    except Error as error:
        if str(path) in str(error):
            raise
        raise FileError(f"{path}: {error}") from error
    except Exception as error:
        reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        raise FileError(f"cannot read {path} as {file_format}: {reason}") from error


def _scene_from_other(path: Path, folder: Folder) -> Scene:
    import trimesh

    from .trimeshes import scene_from_trimesh

    data, suffix = path.read_bytes(), path.suffix.lower()
    if suffix == ".stl":
        _refuse_truncated_stl(data)
    file = io.StringIO(decoded(data)) if suffix == ".obj" else io.BytesIO(data)
    loaded = read_trimesh(file, suffix[1:], folder)
    if folder.refused:
        raise folder.refused[0]
    for name in dict.fromkeys(folder.missing):
        kind = "material file" if name.lower().endswith(".mtl") else "texture"
        warnings.warn(f"{path}: its {kind} '{name}' is missing; drawn without", Notice, stacklevel=4)
    images = {name: data for name, data in folder.read.items() if not name.lower().endswith(".mtl")}
    textures = {name: Texture(read_image(data, name), name) for name, data in images.items()}
    names = list(loaded.geometry)
    if len(names) == 1 and names[0].startswith("geometry_"):  # PLY and STL name nothing; the file's name says more
        loaded = trimesh.Scene({path.stem: loaded.geometry[names[0]]})
    return scene_from_trimesh(loaded, textures)


def _refuse_truncated_stl(data: bytes) -> None:
    """A binary STL is 84 bytes and 50 a triangle; of a shorter one trimesh tries to make text."""
    if data[:5].lower() == b"solid":  # text
        return
    expected = 84 + 50 * int.from_bytes(data[80:84], "little")
    if len(data) < expected:
        raise FileError(f"is truncated or no STL file: {len(data)} of {expected} bytes")
