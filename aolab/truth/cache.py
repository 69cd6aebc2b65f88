"""Arrays kept on disk by the content that they were computed from."""

import hashlib
import json
import os
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import platformdirs

from .. import paths
from ..errors import FileError, notice
from ..output import replacing
from ..scene.mesh import Mesh
from ..scene.scene import Scene

BUDGET = 2_000_000_000  # bytes; the entries used longest ago go first
PACKAGE = Path(__file__).parents[1]
DAMAGED = (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile)  # the errors of an unreadable entry


def folder() -> Path:
    """The folder of the references: in `AOLAB_CACHE`, else in the platform's cache folder. It may always be deleted."""
    root = os.environ.get("AOLAB_CACHE") or platformdirs.user_cache_dir("aolab")
    return Path(root) / "references"


def key(scene: Scene, **settings: object) -> str:
    """A name that changes with all that a result depends on: the scene's content, `settings`, and aolab's own code."""
    digest = hashlib.sha256()
    for part in _scene_parts(scene):
        digest.update(part if isinstance(part, bytes) else np.ascontiguousarray(part).tobytes())
        digest.update(b"|")
    digest.update(json.dumps(settings, sort_keys=True, default=str).encode())
    digest.update(code(PACKAGE).encode())
    for file in sorted((paths.glsl() / "pipeline").glob("gbuffer.*")):  # shaders are compiled anew when they change
        digest.update(file.read_bytes())
    return digest.hexdigest()


@cache
def code(package: Path) -> str:
    """A digest of all Python files of `package`, any of which a result may depend on.

    The files are read once a process: the code that runs was imported, and later edits do not change it.
    """
    digest = hashlib.sha256()
    for file in sorted(package.rglob("*.py")):
        digest.update(str(file.relative_to(package)).encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()


def load(name: str, wanted: Iterable[str]) -> dict[str, np.ndarray]:
    """Those of the `wanted` arrays that are stored under `name`. A damaged entry holds none, with a `Notice`."""
    path = _path(name)
    try:
        arrays = _read(path, wanted)
    except (FileNotFoundError, NotADirectoryError):
        return {}
    except DAMAGED as error:
        notice(f"the cached reference {path.name} is damaged and is made anew: {error}")
        return {}
    with suppress(OSError):
        os.utime(path)  # used just now
    return arrays


def store(name: str, arrays: Mapping[str, np.ndarray]) -> None:
    """Add `arrays` to those under `name`, replacing the file atomically. A failure is a `Notice`, no error."""
    path = _path(name)
    kept: dict[str, np.ndarray] = {}
    with suppress(*DAMAGED):
        kept = _read(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as file:
            np.savez(file, **{**kept, **arrays})  # type: ignore[arg-type]
        _trim(path.parent)
    except (OSError, FileError) as error:
        notice(f"the reference could not be cached: {error}; set AOLAB_CACHE")


def _read(path: Path, wanted: Iterable[str] | None = None) -> dict[str, np.ndarray]:
    """The arrays of an entry, or the `wanted` ones. Raises one of `DAMAGED`."""
    with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
        return {one: file[one] for one in (file.files if wanted is None else wanted) if one in file.files}


def _path(name: str) -> Path:
    return folder() / f"{name}.npz"


def _trim(root: Path) -> None:
    """Delete the files used longest ago, unfinished ones included, until the rest fits the budget."""
    entries = sorted(((file.stat(), file) for file in root.iterdir()), key=lambda entry: -entry[0].st_mtime)
    total = 0
    for stat, file in entries:
        total += stat.st_size
        if total > BUDGET:
            with suppress(OSError):
                file.unlink()


def shape_parts(mesh: Mesh) -> Iterator[Any]:
    """The content of a mesh that decides where its surface is and how it is curved, as bytes and arrays."""
    yield from _arrays(mesh, ("vertices", "faces", "normals"))


def look_parts(mesh: Mesh) -> Iterator[Any]:
    """The rest of a mesh's content: its material, and the arrays that place the material on it."""
    yield from _arrays(mesh, ("uv", "colors", "tangents"))
    material = mesh.material
    yield repr(
        replace(material, texture=None, emission_texture=None, normal_texture=None, height=None, name="")
    ).encode()
    if material.height is not None:
        yield repr((material.height.heights.shape, material.height.wrap)).encode()
        yield material.height.heights
    for texture in (material.texture, material.emission_texture, material.normal_texture):
        if texture is not None:
            yield repr((texture.pixels.shape, texture.wrap, texture.nearest)).encode()
            yield texture.pixels


def _arrays(mesh: Mesh, names: Iterable[str]) -> Iterator[Any]:
    for name in names:
        array = getattr(mesh, name)
        yield f"{name} {None if array is None else array.shape}".encode()
        if array is not None:
            yield array


def _scene_parts(scene: Scene) -> Iterator[Any]:
    meshes = {instance.mesh: None for instance in scene.instances}
    numbers = {mesh: i for i, mesh in enumerate(meshes)}
    for mesh in meshes:
        yield from shape_parts(mesh)
        yield from look_parts(mesh)
    for instance in scene.instances:
        yield repr(numbers[instance.mesh]).encode()
        yield instance.world_from_local
    for light in scene.lights:
        values = {name: np.asarray(value).tolist() for name, value in asdict(light).items()}
        yield f"{type(light).__name__} {values}".encode()
    assert scene.environment is not None  # Scene fills it in
    yield repr(scene.environment.radiance.shape).encode()
    yield scene.environment.radiance
