"""Modules compared with the truth and sorted by error: the study behind `aolab compare`."""

import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image

from ..errors import ParameterError, notice
from ..extras import need
from ..gl.texture import Size
from ..loading import load
from ..measures.comparison import Comparison, measured
from ..modules import MODULES, Module, find
from ..pictures import html
from ..pipeline.api import shared_lab
from ..progress import progress_bar
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..table import table
from ..truth import reference

DEFAULT_SIZE = (480, 270)
REPEATS = 3  # warm frames; the time of a frame is their median
Modules = str | Module | type[Module] | Iterable[str | Module | type[Module]]
MEASURES = ("rmse", "bias", "p99", "ssim", "flip")  # of the table
_ON_SHEET = ("rmse", "bias", "p99", "psnr", "ssim", "flip", "angle")


@dataclass(frozen=True, eq=False)
class Entry:
    """The result of a module. `label` is its name with the parameters that differ from the defaults.

    `milliseconds` is the time of a whole frame, the median of warm frames on this machine.
    """

    label: str
    module: Module
    comparison: Comparison
    milliseconds: float
    info: dict[str, Any]

    def __repr__(self) -> str:
        one = _only(self)
        return f"<Entry {self.label}: {one.name} rmse {one.rmse:.4g}, {self.milliseconds:.1f} ms>"

    def _repr_html_(self) -> str:
        return self.comparison._repr_html_()

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON."""
        return {
            "module": self.module.name,
            "label": self.label,
            "parameters": self.module.values(),
            "milliseconds": self.milliseconds,
            **self.info,
            **self.comparison.to_dict(),
        }


class Ranking(list[Entry]):
    """The entries of `compare_modules`, the least error first: a list that prints as a table of measures.

    In a notebook it shows the table and the `sheet`.
    """

    def _rows(self) -> list[list[Any]]:
        return [[one.label, *(getattr(_only(one), name) for name in MEASURES), one.milliseconds] for one in self]

    def _equal(self) -> list[str]:
        """A line for each group of modules with the same result in all pixels."""
        groups: list[list[Entry]] = []
        for one in self:
            result = _only(one).result
            alike = (some for some in groups if np.array_equal(_only(some[0]).result, result, equal_nan=True))
            group = next(alike, None)
            groups.append([one]) if group is None else group.append(one)
        return [
            f"the same {_only(group[0]).name}, pixel by pixel: {', '.join(one.label for one in group)}"
            for group in groups
            if len(group) > 1
        ]

    def __repr__(self) -> str:
        head = _only(self[0]).name if self else ""
        lines = table({head: "", **dict.fromkeys(MEASURES, ".4f"), "frame ms": ".1f"}, self._rows())
        return "\n".join([lines, *self._equal()])

    def _repr_html_(self) -> str:
        rows = [[row[0], *(f"{number:.4f}" for number in row[1:-1]), f"{row[-1]:.1f}"] for row in self._rows()]
        picture = html.img(sheet(self), "A row for each module: result, truth, error and numbers") if self else ""
        lines = "".join(f"<p>{line}</p>" for line in self._equal())
        return html.table(("module", *MEASURES, "frame ms"), rows) + lines + picture


def compare_modules(
    scene: Any,
    modules: Modules | None = None,
    *,
    size: Size = DEFAULT_SIZE,
    camera: Camera | None = None,
    rays: int = 256,
    radius: float | None = None,
    buffer: str | None = None,
    seed: int = 0,
    accumulate: int = 1,
    flip: bool = True,
) -> Ranking:
    """Render `scene` with each of `modules` (default: all), compare `buffer` with the truth, and sort by RMSE.

    Without a `buffer`, it is the one that all the modules claim (`Module.claims`), and `ambient` if their claims
    differ: in `visibility`, methods for coloured light do not differ from SSAO.
    The least error comes first. A module is compared with a reference of its own radius and falloff, a module without a
    radius with the reference of the first module that has one. `radius` (scene units) replaces all radii. `flip=False`
    leaves out the slowest measure. A `Notice` counts the results whose RMSE is to a good part the truth's own noise.
    Raises `ParameterError`, before any ray is traced, if a module lacks the buffer or a library is missing, and the
    exceptions of `aolab.render` and `aolab.reference`.
    """
    if flip:
        need("flip", ", or flip=False (--no-flip in the shell)")
    scene = load(scene)
    view: dict[str, Any] = {"size": size, "camera": camera, "seed": seed}
    pairs = with_their_truth(scene, modules or MODULES, radius)
    claimed = {module.claims for module, _ in pairs}
    buffer = buffer or (claimed.pop() if len(claimed) == 1 else "ambient")
    for module, _ in pairs:
        frame = shared_lab().render(scene, module, **view)
        if buffer not in frame.buffers:
            raise ParameterError(f"module {module.name} has no '{buffer}'; it has {', '.join(frame.buffers)}")
    entries = []
    with progress_bar("modules", len(pairs), "module") as bar:
        for module, like in pairs:
            reach = {"like": like} if like else {"radius": None if module.claims == "ambient" else radius}
            truth = reference(scene, **view, rays=rays, buffers=(buffer,), **reach)  # type: ignore[arg-type]
            frame = shared_lab().render(scene, module, **view, accumulate=accumulate)
            comparison = measured(frame, truth, buffer, flip=flip)
            frame.complete()  # compiles the shaders
            again = [
                shared_lab().render(scene, module, **view, accumulate=accumulate).complete().frame_ms
                for _ in range(REPEATS)
            ]
            info = {"scene": scene.source or scene.name, "rays": rays, "renderer": frame.info["renderer"]}
            entries.append(Entry(label(module, scene), module, comparison, statistics.median(again), info))
            bar.update()
    ranking = Ranking(sorted(entries, key=lambda entry: entry.comparison[buffer].rmse))
    if noisy := [one for one in map(_only, ranking) if one.is_noisy]:
        shares = " to ".join(dict.fromkeys(f"{end(one.noise / one.rmse for one in noisy):.0%}" for end in (min, max)))
        notice(
            f"buffer '{buffer}': the truth's own standard error is {shares} of the RMSE of {len(noisy)} of "
            f"{len(ranking)} results; give more `rays`"
        )
    return ranking


def sheet(entries: Sequence[Entry], *, limit: float | None = None) -> Image.Image:
    """A row for each entry, in this order: result, truth, error and numbers. All rows have one scale of error."""
    from ..measures.pictures import Line, draw

    if not entries:
        raise ParameterError("a sheet of no modules: give at least one entry")
    lines = [Line(_only(entry), entry.label, _text(entry)) for entry in entries]
    first = entries[0]
    width, height = first.comparison.regions["all"].shape[::-1]
    title = (
        f"{first.info['scene']}: {_only(first).name}, {width}×{height}, truth of {first.info['rays']} rays a pixel"
        f"   ({first.info['renderer']})"
    )
    return draw(lines, title, limit=limit)


def with_their_truth(scene: Scene, modules: Modules, radius: float | None = None) -> list[tuple[Module, Module | None]]:
    """Pairs of a module, resolved and with `radius` if given, and of the module whose reference it is compared with.

    The second is the first itself, or, if it has no radius, the first module of all that has; None if none has. It is
    None, too, for a method without a radius that claims ambient light: shadow maps reach to the end of the scene.
    """
    modules = [modules] if isinstance(modules, (str, Module, type)) else modules
    chosen = [_with_radius(find(one, MODULES), radius).resolved(scene) for one in modules]
    first = next((module for module in chosen if module.occlusion_radius is not None), None)
    return [(module, module if module.occlusion_radius is not None else _other(module, first)) for module in chosen]


def _other(module: Module, first: Module | None) -> Module | None:
    return None if module.claims == "ambient" else first


def _with_radius(module: Module, radius: float | None) -> Module:
    if radius is None or not module.has_radius():
        return module
    return module.replace(radius=radius)  # type: ignore[return-value]


def label(module: Module, scene: Scene) -> str:
    """The name of a module, and its parameters that differ from the defaults."""
    defaults = type(module)().resolved(scene).values()
    changed = [f"{key}={value:g}" if isinstance(value, float) else f"{key}={value}"
               for key, value in module.values().items() if value != defaults.get(key)]  # fmt: skip
    return " ".join([module.name or type(module).__name__, *changed])


def _only(entry: Entry):
    return next(iter(entry.comparison.buffers.values()))


def _text(entry: Entry) -> str:
    """The numbers beside the pictures."""
    one = _only(entry)
    rows: list[tuple[str, float | str]] = [
        (name, getattr(one, name)) for name in _ON_SHEET if getattr(one, name) == getattr(one, name)
    ]
    regions = [(name, where.rmse) for name, where in one.measures.items() if name != "all" and where.pixels]
    rows += [("", ""), ("rmse at", ""), *regions]
    if (radius := entry.module.occlusion_radius) is not None:
        rows += [("", ""), ("radius", radius)]
    rows.append(("frame, ms", f"{entry.milliseconds:.1f}"))
    return table({"": "", " ": ".4g"}, rows).lstrip("\n")
