"""A picture to make: scene, module, camera and settings, from options or from the metadata of a picture."""

import warnings
from dataclasses import dataclass, field, fields, replace
from inspect import signature
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError, create_model

from ..errors import FileError, Notice, ParameterError
from ..gl.texture import Size
from ..modules import MODULES, Module, find
from ..pictures.metadata import read_png
from ..pipeline.frame import Frame
from ..pipeline.lab import DEFAULT_SIZE, Lab
from ..scene.camera import Camera
from ..scene.scene import Scene
from . import text

REFERENCE = "reference"  # the module's name in the metadata of a ray-traced picture


@dataclass
class Job:
    """A picture to make. The names are those of the metadata in a PNG; `parameters` may be text, as --set gives it.

    The picture shows `buffer`. `camera` is the scene's if None; `moved` overrides its eye, target, up or fov.
    """

    scene: str | None = None
    module: str = "ssao"
    parameters: dict[str, Any] = field(default_factory=dict)
    camera: Camera | None = None
    size: Size = DEFAULT_SIZE
    seed: int = 0
    accumulate: int = 1
    exposure: float = 1.0
    tone_map: str = "filmic"
    buffer: str = "image"
    moved: dict[str, Any] = field(default_factory=dict)

    def use(self, module: str | None, settings: dict[str, Any]) -> None:
        """Choose another module, with its defaults, or only other parameters. Raises `ParameterError`."""
        if module is not None and module != self.module:
            self.module, self.parameters = module, {}
        if self.module == REFERENCE:
            self.parameters |= settings
        else:
            self.parameters = type(find(self.module, MODULES)).changed(self.parameters, settings)

    def turn_up(self, axis: str | None) -> None:
        """Let the `axis` of the scene's file point up; None leaves the scene as it is."""
        if axis is not None:
            self.scene = f"{self.scene}{'&' if '?' in str(self.scene) else '?'}up_axis={axis}"

    def move(self, eye: str | None, target: str | None, up: str | None, fov: float | None) -> None:
        """Override values of the camera; None leaves a value as it is."""
        places = {"eye": eye, "target": target, "up": up}
        self.moved = {name: text.vector(f"--{name}", given) for name, given in places.items() if given is not None}
        if fov is not None:
            self.moved |= {"fov": fov, "fit": False}  # --fov is vertical in a picture of any shape

    def choose(self, *, size: str | None, **values: Any) -> None:
        """Override settings; None leaves a setting as it is."""
        if size is not None:
            self.size = text.size(size)
        for name, value in values.items():
            if value is not None:
                setattr(self, name, value)

    def render(self, warm: bool = False) -> Frame:
        """Render the picture; `warm` repeats the frame, so that its times do not contain the shaders' compilation."""
        if self.module == REFERENCE:
            raise ParameterError("the picture was ray-traced: use `aolab reference --like`, or choose a --module")
        module = find(self.module, MODULES, **self.parameters)
        scene, notes = self._load()
        lab = Lab(self.size)
        settings: dict[str, Any] = {
            name: getattr(self, name) for name in ("seed", "accumulate", "exposure", "tone_map")
        }
        for _ in range(2 if warm else 1):
            frame = lab.render(scene, module, camera=self._camera(scene), **settings)
            if warm:
                frame.complete()
        frame.notes = [*notes, *frame.notes]  # pyright: ignore[reportPossiblyUnboundVariable]
        return frame  # pyright: ignore[reportPossiblyUnboundVariable]

    def trace(self, rays: int | None, radius: float | None) -> Frame:
        """Ray-trace the picture with the radius and the falloff of the module; `radius` replaces the module's."""
        from ..truth import reference
        from ..truth.buffers import BUFFERS, base_of
        from ..truth.reference import DEFAULT_BUFFERS

        settings = self._reach(radius)
        if rays is not None:
            settings["rays"] = rays
        wanted = [*DEFAULT_BUFFERS, "image"]
        if (name := base_of(self.buffer)) in BUFFERS and name not in wanted:
            wanted.append(name)
        scene, notes = self._load()
        frame = reference(scene, size=self.size, camera=self._camera(scene), seed=self.seed, buffers=wanted, **settings)
        frame.notes = [*notes, *frame.notes]
        return frame

    def _reach(self, radius: float | None) -> dict[str, Any]:
        if self.module == REFERENCE:
            return {**self._settings_of_a_reference(), **({} if radius is None else {"radius": radius})}
        module: Module = find(self.module, MODULES, **self.parameters)
        if radius is None:
            return {"like": module}
        return {"like": module.replace(radius=radius)} if hasattr(module, "radius") else {"radius": radius}

    def _settings_of_a_reference(self) -> dict[str, Any]:
        """The metadata's `parameters` of a ray-traced picture, as `aolab.reference` takes them: also its question."""
        from ..modules.question import Question
        from ..truth import reference

        given = {name: value for name, value in self.parameters.items() if name != "buffers"}
        known = {**signature(reference).parameters, **signature(Question).parameters}
        types: dict[str, Any] = {name: (known[name].annotation, ...) for name in given.keys() & known.keys()}
        checked = create_model("Settings", __config__={"extra": "forbid"}, **types)
        try:
            return checked(**given).model_dump()
        except ValidationError as error:
            raise FileError(f"the settings of the reference are damaged: {_first(error)}") from None

    def _load(self) -> tuple[Scene, list[str]]:
        """The scene, and the notices about it, which are shown as well."""
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
        return replace(camera, **self.moved)


def asked(scene: str | None, like: Path | None) -> Job:
    """The job that repeats the picture `like`, or that renders `scene` with the usual settings.

    Raises `ParameterError` without a scene, and `FileError` if the picture lacks its metadata.
    """
    job = like_picture(like) if like else Job()
    if scene is not None:
        if scene.lower().endswith(".png"):
            raise ParameterError(f"{scene} is a picture, not a scene: to repeat it, write --like {scene}")
        job.scene = scene
    if job.scene is None:
        reason = f"{like} shows a scene that was made in Python: name a scene" if like else "which scene? Name one"
        raise ParameterError(f"{reason} (`aolab scenes` lists them), a model file, or --like FILE.png")
    return job


def like_picture(picture: Path) -> Job:
    """The job that made a picture. Raises `FileError` if its metadata is incomplete or wrong."""
    info = read_png(picture)
    needed = ("scene", "module", "parameters", "camera", "size", "seed")
    if missing := [name for name in needed if name not in info]:
        raise FileError(f"{picture}: its aolab metadata is incomplete: it lacks {', '.join(missing)}")
    known = {one.name: info[one.name] for one in fields(Job) if one.name in info}
    try:
        return TypeAdapter(Job).validate_python(known)
    except ValidationError as error:
        raise FileError(f"{picture}: its aolab metadata is damaged: {_first(error)}") from None


def _first(error: ValidationError) -> str:
    """The place and the message of the first mistake."""
    first = error.errors()[0]
    return f"{'.'.join(map(str, first['loc']))}: {first['msg']}"
