"""Error against milliseconds: every module over a range of its settings, and the settings that nothing beats.

All modules have one radius. Each is held against rays of that radius and its own falloff; a module that has no radius,
against those of SSAO.
"""

import statistics
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import product
from typing import Any, Literal, get_args

import numpy as np

from ..errors import Notice, ParameterError
from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..measures.metrics import differences
from ..modules import MODULES, SSAO, Module, find
from ..modules.parameters import AUTO, label
from ..pipeline.frame import Frame
from ..pipeline.lab import Lab
from ..scene.scene import Scene
from ..truth import reference
from ..version import __version__
from . import machine
from .bench import summary
from .curve import Curve, Point

# What trades time for error: numbers by factors of their default, a filter by each of its kinds.
FACTORS = {"directions": (0.25, 0.5, 1, 2), "steps": (0.5, 1, 2), "scale": (0.5, 1)}
KINDS = ("filter",)


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
