"""`aolab.animate`: a film of a scene, by a turning camera, a path of cameras, or a parameter that changes."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from ..errors import FileError, ParameterError, suggestion
from ..extras import need
from ..gl.texture import Size
from ..input import as_path, read_text
from ..loading import load
from ..loading.named import describe_scene
from ..modules import MODULES, Module, find
from ..output import check_writable, replacing
from ..pictures.sheet import gray
from ..pipeline.api import shared_lab
from ..pipeline.frame import Frame
from ..progress import progress_bar
from ..scene.camera import Camera
from ..scene.scene import Scene
from .nearby_cameras import turned

FORMATS = (".mp4", ".webp", ".gif", "DIR/%04d.png")
Range = tuple[float, float]


@dataclass(frozen=True)
class Shot:
    """The scene and the camera of a frame, and its parameters of the module."""

    scene: Scene
    camera: Camera
    parameters: Mapping[str, Any]


def animate(
    scene: Any,
    module: str | Module | type[Module] = "ssao",
    *,
    out: str | Path,
    orbit: bool | float = False,
    path: Sequence[Camera] | None = None,
    vary: Mapping[str, Range] | None = None,
    beside: str | Module | type[Module] | None = None,
    buffer: str = "image",
    size: Size = (640, 360),
    seconds: float = 4.0,
    fps: int = 25,
    seed: int = 0,
    progress: bool | None = None,
    **parameters: Any,
) -> Path:
    """Render a film of `scene` and write it to `out`: .mp4 (extra `film`), .webp, .gif, or numbered .png files.

    `orbit` turns the camera around its target by 360 degrees, or by the number given. `path` is a list of cameras,
    evenly spaced in time, with smooth motion between them. `vary` maps a parameter of the scene or of the module to
    (first, last). They combine. With `beside`, a second module, the left half of the picture shows
    `module` and the right half shows `beside`. `buffer` is any buffer with one or three channels.
    A scene with parameters is given by its name, since it is made anew for each frame.
    Raises `ParameterError` for arguments without meaning and `FileError` for a file that cannot be written, before any
    work. Returns the path.
    """
    if not isinstance(seconds, Real) or not 0 < seconds <= 3600:
        raise ParameterError(f"seconds = {seconds!r} is not a number above 0, up to 3600")
    if not isinstance(fps, int) or not 1 <= fps <= 240:
        raise ParameterError(f"fps = {fps!r} is not a whole number from 1 to 240")
    if not isinstance(orbit, Real):
        raise ParameterError(f"orbit = {orbit!r:.80} is not True, False or a number of degrees")
    if path is not None and not (isinstance(path, Sequence) and all(isinstance(one, Camera) for one in path)):
        raise ParameterError(f"path = {path!r:.80} is not a list of cameras")
    if path is not None and len(path) < 2:
        raise ParameterError(f"path has {len(path)} cameras; a path needs at least two")
    if vary is not None and not (isinstance(vary, Mapping) and all(map(_is_range, vary.values()))):
        raise ParameterError(f"vary = {vary!r:.80} is not {{parameter: (first, last)}}, with two numbers")
    out = as_path(out, "out")
    writer = _writer(out)
    modules = [find(one, MODULES, **parameters) for one in (module, beside) if one is not None]
    count = max(1, round(seconds * fps))
    of_scene = _scene_parameters(scene)
    _check_names(vary or {}, of_scene, modules)
    shots = _shots(scene, of_scene, modules, count, orbit, path, vary or {})
    with progress_bar(out.name, count, "frame", shown=progress) as bar:
        writer(out, _pictures(shots, modules, buffer, size, seed, bar), fps)
    return out


def read_path(file: str | Path) -> list[Camera]:
    """The cameras of a JSON file: a list of objects with `eye`, `target` and, if need be, `up` and `fov`."""
    try:
        entries = json.loads(read_text(file, str(file)))
    except FileError as error:
        raise FileError(f"cannot read the camera path: {error}") from None
    except (ValueError, RecursionError) as error:
        raise FileError(f"cannot read the camera path {file}: {error}") from error
    known = [field.name for field in fields(Camera)]
    cameras = []
    for index, entry in enumerate(entries if isinstance(entries, list) else [entries]):
        if not isinstance(entry, dict) or not {"eye", "target"} <= set(entry):
            raise FileError(f"{file}: camera {index} is not an object with eye and target")
        if unknown := sorted(set(entry) - set(known)):
            raise FileError(f"{file}: camera {index} has no '{unknown[0]}'{suggestion(unknown[0], known)}")
        values: dict[str, Any] = {key: tuple(one) if isinstance(one, list) else one for key, one in entry.items()}
        cameras.append(Camera(**values))
    return cameras


def along(cameras: Sequence[Camera], t: float) -> Camera:
    """The camera at `t` in [0, 1] of a path: Catmull and Rom's spline through eyes, targets, ups and fields of view."""
    place = t * (len(cameras) - 1)
    start = min(int(place), len(cameras) - 2)
    u = place - start
    four = [cameras[min(max(start + k, 0), len(cameras) - 1)] for k in (-1, 0, 1, 2)]

    def spline(values: list[Any]) -> np.ndarray:
        a, b, c, d = (np.asarray(value, float) for value in values)
        return 0.5 * (2 * b + (c - a) * u + (2 * a - 5 * b + 4 * c - d) * u**2 + (3 * (b - c) + d - a) * u**3)

    def point(name: str) -> tuple[float, float, float]:
        x, y, z = spline([getattr(one, name) for one in four]).tolist()
        return x, y, z

    fov = float(np.clip(spline([one.fov for one in four]), 1, 179))
    return replace(four[1], eye=point("eye"), target=point("target"), up=point("up"), fov=fov)


def _is_range(ends: object) -> bool:
    return isinstance(ends, Sequence) and len(ends) == 2 and all(isinstance(end, Real) for end in ends)


def _check_names(vary: Mapping[str, Range], of_scene: Sequence[str], modules: Sequence[Module]) -> None:
    of_modules = set.intersection(*(set(type(one).stated()) for one in modules))
    for name in vary:
        if name not in of_scene and name not in of_modules:
            known = [*of_scene, *sorted(of_modules)]
            raise ParameterError(f"vary: neither the scene nor every module has '{name}'{suggestion(name, known)}")


def _shots(
    scene: Any,
    of_scene: Sequence[str],
    modules: Sequence[Module],
    count: int,
    orbit: bool | float,
    path: Sequence[Camera] | None,
    vary: Mapping[str, Range],
) -> Iterator[Shot]:
    degrees = 360.0 if orbit is True else float(orbit)
    still = None if set(vary) & set(of_scene) else load(scene)
    for index in range(count):
        # a full turn, and a loop of time, must not show its first picture twice
        t = index / count if path is None else index / max(1, count - 1)
        values = {name: first + (last - first) * t for name, (first, last) in vary.items()}
        here = still or load(scene, **{name: value for name, value in values.items() if name in of_scene})
        camera = along(path, t) if path is not None else here.camera
        assert camera is not None  # Scene frames itself
        camera = turned(camera, degrees * t) if degrees else camera
        rest = {name: value for name, value in values.items() if name not in of_scene}
        yield Shot(here, camera, _whole_where_needed(modules[0], rest))


def _scene_parameters(scene: Any) -> list[str]:
    """The parameters of a scene that a name stands for; a scene of another kind has none."""
    name = scene.partition("?")[0] if isinstance(scene, str) else ""
    return list(describe_scene(name).parameters) if name.isidentifier() else []


def _whole_where_needed(module: Module, values: Mapping[str, float]) -> dict[str, Any]:
    types = {name: type(getattr(module, name)) for name in values}
    return {name: round(value) if types[name] is int else value for name, value in values.items()}


def _pictures(
    shots: Iterable[Shot], modules: Sequence[Module], buffer: str, size: Size, seed: int, bar: Any
) -> Iterator[np.ndarray]:
    for shot in shots:
        yield _picture(shot, modules, buffer, size, seed)
        bar.update()


def _picture(shot: Shot, modules: Sequence[Module], buffer: str, size: Size, seed: int) -> np.ndarray:
    """(H, W, 3) uint8: the buffer of the first module, or the left half of it and the right half of the second's."""
    found = []
    for module in modules:
        frame = shared_lab().render(
            shot.scene, module.replace(**shot.parameters), camera=shot.camera, size=size, seed=seed
        )
        found.append(_seen(frame, buffer))
    if len(found) == 1:
        return found[0]
    middle = size[0] // 2
    picture = np.concatenate([found[0][:, :middle], found[1][:, middle:]], axis=1)
    picture[:, max(0, middle - 1) : middle + 1] = 255
    return picture


def _seen(frame: Frame, buffer: str) -> np.ndarray:
    values = frame[buffer]
    if values.dtype == np.uint8:
        return values
    if values.ndim == 2:
        return gray(values)
    if values.shape[2] != 3:
        raise ParameterError(f"buffer '{buffer}' has {values.shape[2]} channels; a film shows one or three")
    return (np.clip(np.nan_to_num(values), 0, 1) * 255 + 0.5).astype(np.uint8)


def _writer(out: Path) -> Callable[[Path, Iterator[np.ndarray], int], None]:
    """The function that writes this format. Raises `FileError` and, for a missing extra, `Error`, before the work."""
    suffix = out.suffix.lower()
    if suffix == ".png" and "%" in out.name:
        try:
            first = out.name % 0
        except (TypeError, ValueError):
            raise FileError(f"cannot write {out}: '{out.name}' is not a pattern such as %04d.png") from None
        out.parent.mkdir(parents=True, exist_ok=True)
        check_writable(out.parent / first)
        return _write_pictures
    if suffix not in (".mp4", ".webp", ".gif"):
        raise FileError(f"cannot write {out}: a film is one of {', '.join(FORMATS)}")
    check_writable(out)
    if suffix == ".mp4":
        need("film", "; .webp and .gif need no library")
        return _write_mp4
    return _write_with_pillow


def _write_pictures(out: Path, pictures: Iterator[np.ndarray], fps: int) -> None:
    for number, picture in enumerate(pictures):
        with replacing(out.parent / (out.name % number)) as file:
            Image.fromarray(picture).save(file, "PNG")


def _write_with_pillow(out: Path, pictures: Iterator[np.ndarray], fps: int) -> None:
    images = (Image.fromarray(picture) for picture in pictures)
    first = next(images)
    how: dict[str, Any] = {"save_all": True, "append_images": images, "duration": round(1000 / fps), "loop": 0}
    with replacing(out) as file:
        first.save(file, "WEBP" if out.suffix.lower() == ".webp" else "GIF", **how)


def _write_mp4(out: Path, pictures: Iterator[np.ndarray], fps: int) -> None:
    """H.264 with 4:2:0 chroma, which every player takes; an odd side is repeated once, since that needs even ones."""
    import av

    with replacing(out) as file, av.open(file, "w", format="mp4") as container:
        stream: Any = None
        for picture in pictures:
            height, width = picture.shape[:2]
            even = np.pad(picture, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
            if stream is None:
                stream = container.add_stream("libx264", rate=Fraction(fps), options={"crf": "18"})
                stream.height, stream.width = even.shape[:2]
                stream.pix_fmt = "yuv420p"
            for packet in stream.encode(av.VideoFrame.from_ndarray(even, format="rgb24")):
                container.mux(packet)
        for packet in stream.encode():
            container.mux(packet)


def parse_range(text: str) -> tuple[str, Range]:
    """('time', (0, 6)) of 'time=0:6'. Raises `ParameterError`."""
    name, _, values = text.partition("=")
    first, separator, last = values.partition(":")
    try:
        if not separator:
            raise ValueError
        return name.strip(), (float(first), float(last))
    except ValueError:
        raise ParameterError(f"--vary {text} is not NAME=FIRST:LAST, as in time=0:6") from None
