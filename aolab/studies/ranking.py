"""Modules against the truth, sorted by error: what `aolab compare` shows."""

import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from PIL import Image

from ..errors import ParameterError
from ..gl.texture import Size
from ..loading import load
from ..measures.comparison import Comparison, compare
from ..modules import MODULES, Module, find
from ..pipeline.api import shared_lab
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..truth import reference

DEFAULT_SIZE = (480, 270)
REPEATS = 3  # warm frames, of which the median is told
_ON_SHEET = ("rmse", "bias", "p99", "psnr", "ssim", "flip", "angle")


@dataclass(frozen=True, eq=False)
class Entry:
    """One module's line: its name with the parameters that differ from its defaults, how it did, and what it cost.

    `milliseconds` is a whole frame, the median of warm ones; the time of software rendering depends on the machine.
    """

    label: str
    module: Module
    comparison: Comparison
    milliseconds: float
    info: dict[str, Any]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON."""
        return {
            "module": self.module.name,
            "label": self.label,
            "parameters": self.module.model_dump(),
            "milliseconds": self.milliseconds,
            **self.info,
            **self.comparison.to_dict(),
        }


def compare_modules(
    scene: Any,
    modules: Iterable[str | Module | type[Module]] | None = None,
    *,
    size: Size = DEFAULT_SIZE,
    camera: Camera | None = None,
    rays: int = 256,
    radius: float | None = None,
    buffer: str = "visibility",
    seed: int = 0,
    accumulate: int = 1,
    flip: bool = True,
) -> list[Entry]:
    """Render `scene` with each of `modules` (default: all), compare `buffer` with the truth, sort by RMSE, best first.

    Each module is held against a reference of its own radius and falloff; one that has no radius against that of the
    first one that has. `radius` (scene units) sets them all. Raises what `aolab.render` and `aolab.reference` raise.
    """
    scene = load(scene)
    entries = []
    for module, like in with_their_truth(scene, modules or MODULES, radius):
        truth = reference(
            scene,
            size=size,
            camera=camera,
            rays=rays,
            buffers=(buffer,),
            seed=seed,
            like=like,
            radius=None if like else radius,
        )
        settings = {"camera": camera, "size": size, "seed": seed, "accumulate": accumulate}
        frame = shared_lab().render(scene, module, **settings)
        if buffer not in frame.buffers:
            raise ParameterError(f"module {module.name} gives no '{buffer}'; it has {', '.join(frame.buffers)}")
        comparison = compare(frame, truth, buffer, flip=flip)
        again = [shared_lab().render(scene, module, **settings).frame_ms for _ in range(REPEATS)]
        info = {"scene": scene.source or scene.name, "rays": rays, "renderer": frame.info["renderer"]}
        entries.append(Entry(label(module, scene), module, comparison, statistics.median(again), info))
    return sorted(entries, key=lambda entry: entry.comparison[buffer].rmse)


def sheet(entries: Sequence[Entry], *, limit: float | None = None) -> Image.Image:
    """A line an entry: result, truth, error, numbers, milliseconds; in the order given, all with one scale of error."""
    from ..measures.pictures import Line, draw

    if not entries:
        raise ParameterError("a sheet of no modules: name at least one")
    lines = [Line(_only(entry), entry.label, _text(entry)) for entry in entries]
    first = entries[0]
    width, height = first.comparison.regions["all"].shape[::-1]
    title = (
        f"{first.info['scene']}: {_only(first).name}, {width}×{height}, truth of {first.info['rays']} rays a pixel"
        f"   ({first.info['renderer']})"
    )
    return draw(lines, title, limit=limit)


def with_their_truth(
    scene: Scene, modules: Iterable[str | Module | type[Module]], radius: float | None = None
) -> list[tuple[Module, Module | None]]:
    """The modules, resolved, with `radius` if given; each with the one that says the truth's radius and falloff.

    That is itself, or, of one that has no radius, the first that has.
    """
    chosen = [_with_radius(find(one, MODULES), radius).resolved(scene) for one in modules]
    first = next((module for module in chosen if hasattr(module, "radius")), None)
    return [(module, module if hasattr(module, "radius") else first) for module in chosen]


def _with_radius(module: Module, radius: float | None) -> Module:
    if radius is None or not hasattr(module, "radius"):
        return module
    return module.replace(radius=radius)  # type: ignore[return-value]


def label(module: Module, scene: Scene) -> str:
    """Name and parameters that are not the defaults."""
    defaults = type(module)().resolved(scene).model_dump()
    changed = [f"{key}={value:g}" if isinstance(value, float) else f"{key}={value}"
               for key, value in module.model_dump().items() if value != defaults.get(key)]  # fmt: skip
    return " ".join([module.name or type(module).__name__, *changed])


def _only(entry: Entry):
    return next(iter(entry.comparison.buffers.values()))


def _text(entry: Entry) -> str:
    """The numbers beside the pictures."""
    one = _only(entry)
    lines = [f"{name:<12}{getattr(one, name):>9.4g}" for name in _ON_SHEET if getattr(one, name) == getattr(one, name)]
    where = [
        f"{region:<12}{measures.rmse:>9.4g}"
        for region, measures in one.measures.items()
        if region != "all" and measures.pixels
    ]
    if isinstance(radius := getattr(entry.module, "radius", None), float):
        where += ["", f"{'radius':<12}{radius:>9.4g}"]
    return "\n".join([*lines, "", "rmse at", *where, f"{'frame':<12}{entry.milliseconds:>9.1f} ms"])
