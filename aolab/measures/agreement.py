"""Whether two results may be compared at all: the same view, the same question, the same light."""

from collections.abc import Callable, Iterable
from itertools import zip_longest
from typing import Any

import numpy as np

from ..errors import ParameterError, notice
from ..pipeline.frame import Frame
from ..scene.mesh import Mesh
from ..scene.scene import Scene
from ..truth.cache import look_parts, shape_parts

_OCCLUSION = ("radius", "falloff", "spread")
_OPEN = ("visibility", "bent_normal", "ambient", "sh", *(f"sh{i}" for i in range(4)))
_LIT = ("direct", "ambient", "indirect", "radiance", "image")
# the fields of a question that each buffer depends on; `direct` depends on none
_FIELDS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(_OPEN, _OCCLUSION),
    **dict.fromkeys(("indirect", "radiance", "image"), (*_OCCLUSION, "limited_senders", "blocked_senders")),
    **dict.fromkeys(("obscurance", "transfer"), ("radius", "measure", "sigma", "spread")),
    "transfer_multibounce": ("radius", "spread", "bounces"),
}


def check(a: object, b: object, names: tuple[str, str], buffers: Iterable[str]) -> None:
    """Look at what two frames say of themselves; mappings of arrays say nothing.

    Raises `ParameterError` for cameras that differ: pixels do not correspond. Questions, scenes and lights that differ
    are a `Notice`, which names the difference.
    """
    if not (isinstance(a, Frame) and isinstance(b, Frame)):
        return
    _check_cameras(a, b, names)
    buffers = {name.removesuffix("_raw") for name in buffers}
    told = [*_questions(a, b, names, buffers), *_scenes(a, b, names, buffers), *_lights(a, b, names, buffers)]
    for text in told:
        notice(f"{text}; the difference counts as error")


def _check_cameras(a: Frame, b: Frame, names: tuple[str, str]) -> None:
    ours, theirs = a.info.get("camera"), b.info.get("camera")
    if not ours or not theirs:
        return
    for field in ours:
        if not _same(ours[field], theirs.get(field)):
            raise ParameterError(
                f"{names[0]} and {names[1]} have different cameras: {field} = {ours[field]} against "
                f"{theirs.get(field)}; give both the same `camera`"
            )


def _questions(a: Frame, b: Frame, names: tuple[str, str], buffers: set[str]) -> list[str]:
    ours, theirs = a.info.get("question"), b.info.get("question")
    if not ours or not theirs or ours["radius"] is None:  # a module without radius, `none`, is wrong about any
        return []
    fields = dict.fromkeys(field for name in _FIELDS if name in buffers for field in _FIELDS[name])
    differing = [field for field in fields if not _same(ours[field], theirs[field])]
    if not differing:
        return []
    one, other = (", ".join(f"{field} = {who[field]}" for field in differing) for who in (ours, theirs))
    return [
        f"the questions differ: {names[0]} has {one}, {names[1]} has {other}; `aolab.reference(scene, like=frame)` "
        "answers the question of a frame"
    ]


def _scenes(a: Frame, b: Frame, names: tuple[str, str], buffers: set[str]) -> list[str]:
    ours, theirs = a.info.get("scene"), b.info.get("scene")
    sources = ours and theirs and ours != theirs
    told = f"the scenes differ: {names[0]} shows {ours}, {names[1]} shows {theirs}"
    if not a.scene or not b.scene:
        return [told] if sources else []
    if not _same_meshes(a.scene, b.scene, shape_parts):
        return [told if sources else f"the surfaces of {names[0]} and {names[1]} differ"]
    if buffers & set(_LIT) and not _same_meshes(a.scene, b.scene, look_parts):
        return [f"the materials of {names[0]} and {names[1]} differ"]
    return []


def _same_meshes(a: Scene, b: Scene, parts: Callable[[Mesh], Iterable[Any]]) -> bool:
    """Whether two scenes have the same instances, as far as the `parts` of their meshes."""
    if a is b:
        return True
    if len(a.instances) != len(b.instances):
        return False
    for one, other in zip(a.instances, b.instances, strict=True):
        if not np.array_equal(one.world_from_local, other.world_from_local):
            return False
        pairs = () if one.mesh is other.mesh else zip_longest(parts(one.mesh), parts(other.mesh))
        if not all(np.array_equal(part, counterpart) for part, counterpart in pairs):
            return False
    return True


def _lights(a: Frame, b: Frame, names: tuple[str, str], buffers: set[str]) -> list[str]:
    if not a.scene or not b.scene or not buffers & set(_LIT):
        return []
    assert a.scene.environment is not None  # Scene fills it in
    assert b.scene.environment is not None
    parts = {
        "environments": np.array_equal(a.scene.environment.radiance, b.scene.environment.radiance),
        "lights": repr(a.scene.lights) == repr(b.scene.lights),
    }
    return [f"the {part} of {names[0]} and {names[1]} differ" for part, same in parts.items() if not same]


def _same(one: Any, other: Any) -> bool:
    """Equal, or numbers and tuples of numbers that are equal but for rounding."""
    if one is None or other is None or isinstance(one, (str, bool)) or isinstance(other, (str, bool)):
        return one == other
    return np.shape(one) == np.shape(other) and np.allclose(one, other, rtol=1e-6, atol=0)
