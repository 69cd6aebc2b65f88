"""Error against milliseconds: every module over a range of its settings, and the settings that nothing beats.

All modules have one radius. Each is held against rays of that radius and its own falloff; a module that has no radius,
against those of SSAO.
"""

import json
import statistics
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np

from . import machine
from .bench import summary
from .errors import Error, FileError, Notice, ParameterError
from .frame import Frame
from .gl import context
from .gl.texture import Size
from .lab import Lab
from .loading import load
from .measures.metrics import differences
from .modules import MODULES, SSAO, Module, find
from .output import check_writable, replacing
from .parameters import AUTO, label
from .scene import Scene
from .truth import reference
from .version import __version__

# What trades time for error: numbers by factors of their default, a filter by each of its kinds.
FACTORS = {"directions": (0.25, 0.5, 1, 2), "steps": (0.5, 1, 2), "scale": (0.5, 1)}
KINDS = ("filter",)


@dataclass(frozen=True)
class Point:
    """One setting of a module: what it adds to a frame, and how it errs.

    `milliseconds` is the median of the sum of the passes that the frame has because of the module, `spread` its
    interquartile range, `passes` each one's median; `rmse` and `bias` are of visibility, over all pixels with a
    surface. `front`: nothing else measured is at least as fast and at least as good.
    """

    module: str
    settings: dict[str, Any]
    default: bool
    milliseconds: float
    spread: float
    passes: dict[str, float]
    rmse: float
    bias: float
    front: bool = False

    @property
    def label(self) -> str:
        """'ssao 16×2 box4', and 'at 0.5' behind it for a scale below 1."""
        rest = dict(self.settings)
        taps = "×".join(str(rest.pop(key)) for key in ("directions", "steps") if key in rest)
        scale = rest.pop("scale", 1)
        words = [self.module, taps, *map(str, rest.values()), f"at {scale:g}" if scale != 1 else ""]
        return " ".join(filter(None, words))


@dataclass(frozen=True)
class Curve:
    """All points; `info` says where and how they were measured, `noise` is the RMS of the truth's standard error."""

    points: tuple[Point, ...]
    info: dict[str, Any]
    noise: float

    @property
    def front(self) -> list[Point]:
        """The Pareto front, fastest first: each of its points errs less than all that are faster."""
        return sorted((point for point in self.points if point.front), key=lambda point: point.milliseconds)

    @property
    def title(self) -> str:
        """Scene, size, radius and rays."""
        return "{scene}, {size[0]}×{size[1]}, radius {radius:.3g}, truth of {rays} rays a pixel".format(**self.info)

    @property
    def place(self) -> str:
        """Renderer, machine, and how often each time was taken."""
        return "{renderer}; {machine}; medians of {frames} frames".format(**self.info)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {**self.info, "truth_standard_error": self.noise, "points": [asdict(point) for point in self.points]}

    def table(self) -> str:
        """The front, and the defaults beside it, as lines to read."""
        lines = [self.title, self.place, f"{'':<40}{'ms':>9}{'±':>8}{'rmse':>9}{'bias':>9}"]
        for one in [*self.front, *(point for point in self.points if point.default and not point.front)]:
            about = one.label + (", default" if one.default else "") + ("" if one.front else ", not on the front")
            lines.append(f"{about:<40}{one.milliseconds:9.2f}{one.spread:8.2f}{one.rmse:9.4f}{one.bias:+9.4f}")
        return "\n".join(lines)


def curve(
    scene: Any,
    modules: Iterable[str | Module | type[Module]] | None = None,
    *,
    radius: float | Literal["auto"] = AUTO,
    size: Size = (640, 360),
    rays: int = 256,
    frames: int = 5,
    seed: int = 0,
) -> Curve:
    """Measure `modules` (all by default), each over its `settings`; times are medians over warm `frames`.

    Raises `ParameterError` for fewer than 2 frames, and what `aolab.render` and `aolab.reference` raise.
    """
    if not isinstance(frames, int) or frames < 2:
        raise ParameterError(f"frames = {frames!r}: a median with its spread needs 2 or more")
    scene, lab = load(scene), Lab(size)
    judge = SSAO(radius=radius).resolved(scene)
    # passes of every frame; the first one of this lab has the shadow maps among them
    shared = lab.render(scene, "none", filter="none").timings.keys() - {"none"}

    variants, noise = [], 0.0
    for module in _chosen(modules, judge, scene):
        like = module if hasattr(module, "radius") else judge
        truth = reference(scene, size=size, rays=rays, like=like, seed=seed, buffers=("visibility", "standard_error"))
        for one, varied in settings(module):
            error = visibility_error(lab.render(scene, one, seed=seed), truth)  # compiles, too
            variants.append((one, varied, one == module, error))
        noise = max(noise, float(np.sqrt(np.mean(truth["standard_error"][truth.mask] ** 2))))

    times = _times(lab, scene, [variant[0] for variant in variants], frames, shared)
    points = [
        _point(label(type(module)), varied, default, error, passes)
        for (module, varied, default, error), passes in zip(variants, times, strict=True)
    ]
    front = pareto_front([(point.milliseconds, point.rmse) for point in points])
    info = {
        "aolab": __version__,
        "renderer": context.renderer(),
        "machine": machine.describe(),
        "scene": scene.source or scene.name,
        "size": list(size),
        "radius": judge.radius,
        "rays": rays,
        "seed": seed,
        "frames": frames,
    }
    return Curve(tuple(replace(point, front=i in front) for i, point in enumerate(points)), info, noise)


def settings(module: Module) -> list[tuple[Module, dict[str, Any]]]:
    """The module over the grid of those of `FACTORS` and `KINDS` that it has, itself among them, and what was varied.

    What falls outside of a parameter's range is left out. A module without parameters of its own has nothing to trade
    time with: it is one point.
    """
    fields = type(module).model_fields
    if fields.keys() <= Module.model_fields.keys():
        return [(module, {})]
    axes = {
        name: [_times_factor(getattr(module, name), by) for by in FACTORS[name]] for name in FACTORS if name in fields
    }
    axes |= {name: list(get_args(fields[name].annotation)) for name in KINDS}
    found: dict[str, tuple[Module, dict[str, Any]]] = {}
    for values in product(*axes.values()):
        varied = dict(zip(axes, values, strict=True))
        try:
            found.setdefault(str(varied), (module.replace(**varied), varied))  # type: ignore[arg-type]
        except ParameterError:
            continue
    return list(found.values())


def _times_factor(value: float, factor: float) -> float:
    return max(1, round(value * factor)) if isinstance(value, int) else value * factor


def pareto_front(costs: Sequence[tuple[float, float]]) -> set[int]:
    """Indices of the (milliseconds, error) than which no other is at least as good in both; of equals, the first."""
    front, best = set(), float("inf")
    for index in sorted(range(len(costs)), key=costs.__getitem__):
        if costs[index][1] < best:
            front.add(index)
            best = costs[index][1]
    return front


def visibility_error(frame: Frame, truth: Frame) -> dict[str, float]:
    """RMSE, bias and the other `differences` of visibility, over the pixels with a surface. Raises `ParameterError`."""
    mask = truth.mask
    if not mask.any():
        raise ParameterError("there is nothing to measure: no pixel of this view shows a surface")
    return differences(frame["visibility"][mask] - truth["visibility"][mask])


def _chosen(modules: Iterable[str | Module | type[Module]] | None, judge: SSAO, scene: Scene) -> list[Module]:
    """The modules with the judge's radius, those that give visibility."""
    chosen = []
    for module in (find(one, MODULES) for one in (modules or MODULES)):
        if "visibility" not in {*module.outputs, *module.derived}:
            given = ", ".join(module.outputs)
            warnings.warn(f"{label(type(module))} is left out: it gives {given}, no visibility", Notice, stacklevel=3)
        elif hasattr(module, "radius"):
            chosen.append(module.replace(radius=judge.radius))
        else:
            chosen.append(module.resolved(scene))
    return chosen


def _times(
    lab: Lab, scene: Scene, modules: list[Module], frames: int, shared: set[str]
) -> list[list[dict[str, float]]]:
    """{own pass: milliseconds} by module and frame; turn by turn, so that a slower minute is everybody's."""
    times: list[list[dict[str, float]]] = [[] for _ in modules]
    for _ in range(frames):
        for module, known in zip(modules, times, strict=True):
            timings = lab.render(scene, module).timings
            known.append({name: milliseconds for name, milliseconds in timings.items() if name not in shared})
    return times


def _point(
    name: str, varied: dict[str, Any], default: bool, error: dict[str, float], passes: list[dict[str, float]]
) -> Point:
    cost = summary([sum(frame.values()) for frame in passes])
    medians = {step: statistics.median(frame[step] for frame in passes) for step in passes[0]}
    return Point(name, varied, default, cost["median"], cost["spread"], medians, error["rmse"], error["bias"])


def quality_command(scene: str, output: Path, **how: Any) -> Curve:
    """Measure, draw `output`, and write the data beside it as JSON; what can be refused is refused before the work."""
    if output.suffix.lower() != ".png":
        raise FileError(f"cannot write {output}: the picture is written as .png")
    data = output.with_suffix(".json")
    for path in (output, data):
        check_writable(path)
    try:
        from .quality_picture import draw
    except ImportError as error:
        raise Error(f"the picture needs matplotlib: pip install matplotlib ({error})") from error
    measured = curve(scene, **how)
    with replacing(output) as file:
        draw(measured).savefig(file, format="png")
    with replacing(data) as file:
        file.write((json.dumps(measured.to_dict(), indent=2) + "\n").encode())
    return measured
