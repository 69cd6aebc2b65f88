"""Rendering with the shaders of a student, of the solution or of a mistake: the pictures that checks compare."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ..errors import Notice
from ..modules import Module
from ..modules.estimate import Estimate
from ..modules.filters.base import Filter
from ..modules.parameters import Choice
from ..modules.passes import Pass
from ..pipeline.frame import Frame
from ..pipeline.lab import Lab
from ..scene.scene import Scene
from .exercise import Exercise, Rendered, Step
from .scenes import hidden, named

Texts = Mapping[str, str | Path]  # {file: GLSL text, or the path of a file}


@dataclass(frozen=True, eq=False)
class Shot:
    """A frame to render: a scene, the changes of the module's parameters, and the render's arguments."""

    scene: Scene
    changes: Mapping[str, Any]
    arguments: Mapping[str, Any]
    key: tuple[Any, ...]


def shots(exercise: Exercise, step: Step, check: Rendered, seed: int) -> list[Shot]:
    """The frames of a check; only `hidden` has several, on the scenes of `seed`."""
    count = getattr(check, "count", 0)
    scenes = [hidden(seed, number) for number in range(count)] if count else [named(check.scene)]
    arguments: dict[str, Any] = {"size": check.size or exercise.spec.size}
    arguments |= {"seed": check.seed, "accumulate": check.accumulate}
    found = []
    for number, scene in enumerate(scenes):
        camera = scene.camera
        assert camera is not None  # Scene frames itself
        given = {"eye": check.eye, "target": check.target}
        placed = replace(camera, **{name: place for name, place in given.items() if place is not None})
        changes = {**step.set, **check.set}
        key = (check.scene, seed if count else None, number, str(changes), str(arguments), check.eye, check.target)
        found.append(Shot(scene, changes, {**arguments, "camera": placed}, key))
    return found


@dataclass
class Renders:
    """Renders an exercise's module, and keeps the frames of the solution and of its mistakes."""

    exercise: Exercise
    lab: Lab = field(default_factory=Lab)
    kept: dict[tuple[Any, ...], Frame] = field(default_factory=dict)

    def solution(self, shot: Shot) -> Frame:
        """The frame of the solution, on this machine."""
        return self.kept_frame(shot, self.exercise.solution, "")

    def kept_frame(self, shot: Shot, texts: Texts, name: str) -> Frame:
        """A frame with the shaders of the mistake `name`, or of the solution (""), rendered at the first call."""
        if (name, shot.key) not in self.kept:
            self.kept[name, shot.key] = self.frame(shot, texts)
        return self.kept[name, shot.key]

    def frame(self, shot: Shot, texts: Texts) -> Frame:
        """A frame with these shaders. Raises `ShaderError` for one that does not compile."""
        module = self.exercise.module.replace(**shot.changes)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Notice)  # a check has sentences of its own about NaN and ranges
            return self.lab.render(shot.scene, with_shaders(module, self.exercise, texts), **shot.arguments)


_last: list[Renders] = []


def renders_of(exercise: Exercise) -> Renders:
    """The renders of an exercise; those of the last call, if the exercise is the same, so that little is compiled."""
    if not _last or not _same(_last[0].exercise, exercise):
        _last[:] = [Renders(exercise)]
    return _last[0]


def _same(a: Exercise, b: Exercise) -> bool:
    return a.folder == b.folder and a.spec == b.spec and a.solution == b.solution


def with_shaders(module: Module, exercise: Exercise, texts: Texts) -> Module:
    """The module whose passes, those of its filter too, have the shaders of an exercise in place of their own."""
    files = {one.replaces or one.file: texts[one.file] for one in exercise.spec.shaders}
    kind, outputs = type(module), exercise.spec.outputs
    make: Any = type(kind)  # the metaclass of pydantic
    facts: dict[str, Any] = {"__module__": __name__, "__qualname__": kind.__qualname__, "__doc__": kind.__doc__}
    if outputs:
        facts |= {"outputs": outputs, "shader": next(iter(files.values()))}

    def swapped(step: Any) -> Any:
        if isinstance(step, Estimate):
            return replace(step, passes=[*map(swapped, step.passes)], once=[*map(swapped, step.once)])
        if not isinstance(step, Pass):
            return step
        includes = {name: _text(files.get(file, file)) for name, file in step.includes.items()}
        return replace(step, shader=files.get(str(step.shader), step.shader), includes=includes)

    def chosen(self: Module, axis: str) -> Choice:
        choice = kind.chosen(self, axis)
        if isinstance(choice, Filter) and any(str(one.shader) in files for one in choice.passes({"source": "R16F"})):
            return _filter_with_shaders(choice, swapped)
        return choice

    facts |= {
        "estimate": lambda self: swapped(kind.estimate(self)),
        "lighting": lambda self: [*map(swapped, kind.lighting(self))],
        "bounce": lambda self: swapped(kind.bounce(self)),
        "chosen": chosen,
    }
    made = make(kind.__name__, (kind,), facts)
    return made(**{name: getattr(module, name) for name in kind.model_fields}, **(module.model_extra or {}))


def _text(shader: str | Path) -> str:
    return shader.read_text(encoding="utf-8") if isinstance(shader, Path) else shader


def _filter_with_shaders(choice: Filter, swapped: Any) -> Filter:
    kind = type(choice)
    make: Any = type(kind)
    facts = {"passes": lambda self, formats: [*map(swapped, kind.passes(self, formats))]}
    made = make(kind.__name__, (kind,), {"__module__": __name__, "__doc__": kind.__doc__, **facts})
    return made(**{name: getattr(choice, name) for name in kind.model_fields})
