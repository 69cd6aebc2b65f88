"""One render as the shell asks for it: from words to a frame, and to files."""

import json
import warnings
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

from ..errors import FileError, Notice, ParameterError
from ..gl.texture import Size
from ..modules import MODULES, Module, find
from ..output import check_writable, replacing
from ..pictures.metadata import read_png
from ..pipeline.frame import Frame
from ..pipeline.lab import DEFAULT_SIZE, Lab
from ..scene.camera import Camera, Vec3
from ..scene.scene import Scene


@dataclass
class Job:
    """What to render and how; `parameters` may still be text, as `--set` gives it."""

    scene: str | None = None
    module: str = "ssao"
    parameters: dict[str, Any] = field(default_factory=dict)
    camera: Camera | None = None
    eye: Vec3 | None = None
    target: Vec3 | None = None
    fov: float | None = None
    size: Size = DEFAULT_SIZE
    seed: int = 0
    accumulate: int = 1
    exposure: float = 1.0
    tone_map: Any = "filmic"

    @classmethod
    def like(cls, picture: Path) -> Self:
        """The job that made this picture. Raises `FileError` where the picture does not say."""
        info = read_png(picture)
        try:
            return cls(
                scene=info["scene"],
                module=info["module"],
                parameters=info["parameters"],
                camera=Camera(**info["camera"]),
                size=tuple(info["size"]),
                seed=info["seed"],
                accumulate=info["accumulate"],
                exposure=info["exposure"],
                tone_map=info["tone_map"],
            )
        except (KeyError, TypeError) as error:
            raise FileError(f"{picture}: its aolab metadata is incomplete: {error}") from error

    def place_camera(self, eye: str | None, target: str | None, fov: float | None) -> None:
        """Take the camera's words; what is not said stays as the picture's or the scene's camera has it."""
        self.eye = None if eye is None else _vector("--eye", eye)
        self.target = None if target is None else _vector("--target", target)
        self.fov = fov

    def choose(self, *, size: str | None, **values: Any) -> None:
        """Override what was said; None leaves it."""
        if size is not None:
            self.size = parse_size(size)
        for name, value in values.items():
            if value is not None:
                setattr(self, name, value)

    def render(self, output: Path, buffers: Path | None = None, stats: Path | None = None) -> Frame:
        """Render and write. Everything that can be refused is refused before the work."""
        _check_outputs(output, buffers, stats)
        module = typed(self.module, self.parameters)
        scene, notes = self._load()
        lab = Lab(self.size)
        view = {"camera": self._camera(scene), "seed": self.seed, "accumulate": self.accumulate}
        display = {"exposure": self.exposure, "tone_map": self.tone_map}
        frame = lab.render(scene, module, **view, **display)
        if stats:
            frame = lab.render(scene, module, **view, **display)  # the first one compiled the shaders
        _write(frame, notes, output, buffers, stats)
        return frame

    def trace(
        self, rays: int, radius: float | None, output: Path, buffers: Path | None = None, stats: Path | None = None
    ) -> Frame:
        """Ray-trace and write; the module gives radius and falloff, unless `radius` is said."""
        from ..truth import reference
        from ..truth.reference import DEFAULT_BUFFERS

        _check_outputs(output, buffers, stats)
        module = typed(self.module, self.parameters)
        scene, notes = self._load()
        reach: dict[str, Any] = {"like": module} if radius is None else {"radius": radius}
        frame = reference(
            scene,
            size=self.size,
            camera=self._camera(scene),
            seed=self.seed,
            rays=rays,
            buffers=(*DEFAULT_BUFFERS, "image"),
            **reach,
        )
        _write(frame, notes, output, buffers, stats)
        return frame

    def _load(self) -> tuple[Scene, list[str]]:
        from ..loading import load

        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", Notice)
            scene = load(self.scene)
        for note in caught:
            warnings.warn(note.message, note.category, stacklevel=1)
        return scene, [str(note.message) for note in caught]

    def _camera(self, scene: Scene) -> Camera:
        camera = self.camera or scene.camera
        assert camera is not None  # Scene frames itself
        changes = {key: getattr(self, key) for key in ("eye", "target", "fov") if getattr(self, key) is not None}
        if self.fov is not None:
            changes["fit"] = False  # --fov is vertical in a picture of any shape
        return replace(camera, **changes)


def _check_outputs(output: Path, *others: Path | None) -> None:
    if output.suffix.lower() != ".png":
        raise FileError(f"cannot write {output}: images are written as .png")
    paths = [path for path in (output, *others) if path is not None]
    for path in paths:
        check_writable(path)
    if len({path.resolve() for path in paths}) < len(paths):
        raise FileError(f"cannot write two things to one file: {', '.join(map(str, paths))}")


def _write(frame: Frame, notes: list[str], output: Path, buffers: Path | None, stats: Path | None) -> None:
    frame.notes = [*notes, *frame.notes]
    frame.save(output)
    if buffers:
        frame.save_buffers(buffers)
    if stats:
        with replacing(stats) as file:
            file.write((json.dumps(frame.stats(), indent=2) + "\n").encode())


def typed(name: str, parameters: dict[str, Any]) -> Module:
    """The module with its parameters, text turned into their types."""
    module = type(find(name, MODULES))
    values = {}
    for key, value in parameters.items():
        if key in module.stated() and isinstance(value, str):
            # the JSON reading of a word, where it has one: 16, 0.5, true; pydantic checks it after that
            with suppress(json.JSONDecodeError):
                value = json.loads(value)
        values[key] = value
    return module(**values)


def parse_size(text: str) -> Size:
    """'1280x720' as (1280, 720). Raises `ParameterError`."""
    width, separator, height = text.lower().partition("x")
    if not separator or not width.isdecimal() or not height.isdecimal():
        raise ParameterError(f"size = '{text}' is not WIDTHxHEIGHT, as in 1280x720")
    return int(width), int(height)


def _vector(name: str, text: str) -> Vec3:
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise ParameterError(f"{name} {text} is not three numbers X,Y,Z") from None
    return x, y, z
