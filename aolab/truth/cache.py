"""Arrays kept on disk by the content that they were computed from."""

import hashlib
import io
import json
import os
import warnings
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import platformdirs

from .. import paths
from ..errors import FileError, Notice
from ..output import replacing
from ..scene.scene import Scene

BUDGET = 2_000_000_000  # bytes; the entries used longest ago go first


def folder() -> Path:
    """Where references are kept: `AOLAB_CACHE`, else the platform's cache folder. May be deleted at any time."""
    root = os.environ.get("AOLAB_CACHE") or platformdirs.user_cache_dir("aolab")
    return Path(root) / "references"


def key(scene: Scene, **settings: object) -> str:
    """A name that changes with anything the result depends on: the scene's content, `settings`, and our own code."""
    digest = hashlib.sha256()
    for part in _scene_parts(scene):
        digest.update(part if isinstance(part, bytes) else np.ascontiguousarray(part).tobytes())
        digest.update(b"|")
    digest.update(json.dumps(settings, sort_keys=True, default=str).encode())
    for file in sorted([*Path(__file__).parent.glob("*.py"), *(paths.glsl() / "pipeline").glob("gbuffer.*")]):
        digest.update(file.read_bytes())
    return digest.hexdigest()


def load(name: str) -> dict[str, np.ndarray] | None:
    """The arrays stored under `name`, or None. A damaged entry counts as none, and a `Notice` says so."""
    path = _path(name)
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
            arrays = {key: file[key] for key in file.files}
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile) as error:
        warnings.warn(f"the cached reference {path.name} is damaged and is made anew: {error}", Notice, stacklevel=3)
        return None
    with suppress(OSError):
        os.utime(path)  # used just now
    return arrays


def store(name: str, arrays: dict[str, np.ndarray]) -> None:
    """Keep `arrays` under `name`, replacing atomically. Failing, it only says so, in a `Notice`."""
    path = _path(name)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as file:
            np.savez(file, **arrays)  # type: ignore[arg-type]
        _trim(path.parent)
    except (OSError, FileError) as error:
        warnings.warn(f"the reference could not be cached: {error}; set AOLAB_CACHE", Notice, stacklevel=3)


def _path(name: str) -> Path:
    return folder() / f"{name}.npz"


def _trim(root: Path) -> None:
    """Delete what was used longest ago beyond the budget, halves of files left by a killed process among it."""
    entries = sorted(((file.stat(), file) for file in root.iterdir()), key=lambda entry: -entry[0].st_mtime)
    total = 0
    for stat, file in entries:
        total += stat.st_size
        if total > BUDGET:
            with suppress(OSError):
                file.unlink()


def _scene_parts(scene: Scene) -> Iterator[Any]:
    meshes = {instance.mesh: None for instance in scene.instances}
    numbers = {mesh: i for i, mesh in enumerate(meshes)}
    for mesh in meshes:
        for name in ("vertices", "faces", "normals", "uv", "colors"):
            array = getattr(mesh, name)
            yield f"{name} {None if array is None else array.shape}".encode()
            if array is not None:
                yield array
        material = mesh.material
        yield repr(replace(material, texture=None, emission_texture=None)).encode()
        for texture in (material.texture, material.emission_texture):
            if texture is not None:
                yield repr((texture.pixels.shape, texture.wrap, texture.nearest)).encode()
                yield texture.pixels
    for instance in scene.instances:
        yield repr(numbers[instance.mesh]).encode()
        yield instance.world_from_local
    for light in scene.lights:
        values = {name: np.asarray(value).tolist() for name, value in asdict(light).items()}
        yield f"{type(light).__name__} {values}".encode()
    assert scene.environment is not None  # Scene fills it in
    yield repr(scene.environment.radiance.shape).encode()
    yield scene.environment.radiance
