"""Error against time: every module over a range of its settings, and the settings that no other setting beats.

All modules have the same radius. A module is compared with rays of this radius and of the module's own falloff, a
module without a radius with the rays for SSAO.
"""

import statistics
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import product
from typing import Any, Literal, get_args

import numpy as np

from ..errors import ParameterError, notice
from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..measures.metrics import differences
from ..modules import MODULES, SSAO, Module, find
from ..modules.parameters import AUTO, label
from ..pipeline.frame import Frame
from ..pipeline.lab import Lab
from ..progress import progress_bar
from ..scene.scene import Scene
from ..truth import reference
from ..version import __version__
from . import machine
from .bench import summary
from .curve import Curve, Point

# Parameters that trade time for error: numbers are multiplied by factors, of a filter all kinds are tried.
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
    """Measure `modules` (default: all), each over its `settings`; times are medians over warm `frames`.

    Raises `ParameterError` for fewer than 2 frames, and the exceptions of `aolab.render` and `aolab.reference`.
    """
    if not isinstance(frames, int) or frames < 2:
        raise ParameterError(f"frames = {frames!r}: a median with its spread needs 2 or more")
    scene, lab = load(scene), Lab(size)
    judge = SSAO(radius=radius).resolved(scene)
    # the passes that every frame has; this is the first frame of the lab, so that the shadow maps are among them
    shared = lab.render(scene, "none", filter="none").complete().timings.keys() - {"none"}

    grids = [(module, settings(module)) for module in _chosen(modules, judge, scene)]
    variants, noise = [], 0.0
    with progress_bar("errors", sum(len(grid) for _, grid in grids), " settings") as bar:
        for module, grid in grids:
            like = module if module.occlusion_radius is not None else judge
            wanted = ("visibility", "standard_error")
            truth = reference(scene, size=size, rays=rays, like=like, seed=seed, buffers=wanted)
            for one, varied in grid:
                error = visibility_error(
                    lab.render(scene, one, seed=seed).complete(), truth
                )  # also compiles the shaders
                variants.append((one, varied, one == module, error))
                bar.update()
            noise = max(noise, noise_of(truth))

    times = _times(lab, scene, [variant[0] for variant in variants], frames, shared)
    points = [
        _point(label(type(module)), varied, default, error, passes)
        for (module, varied, default, error), passes in zip(variants, times, strict=True)
    ]
    return curve_of(points, noise, scene, size=size, radius=judge.radius, rays=rays, seed=seed, frames=frames)


def curve_of(points: Sequence[Point], noise: float, scene: Scene, *, size: Size, **conditions: Any) -> Curve:
    """The curve of measured points, with its front; `conditions`: the radius, the rays, the seed and the frames."""
    front = pareto_front([(point.milliseconds, point.rmse) for point in points])
    info = {
        "aolab": __version__,
        "renderer": context.renderer(),
        "machine": machine.describe(),
        "scene": scene.source or scene.name,
        "size": list(size),
        **conditions,
    }
    return Curve(tuple(replace(point, front=i in front) for i, point in enumerate(points)), info, noise)


def noise_of(truth: Frame) -> float:
    """The RMS of the standard error of the truth's visibility, over the pixels with a surface."""
    return float(np.sqrt(np.mean(truth["standard_error"][truth.mask] ** 2)))


def settings(module: Module) -> list[tuple[Module, dict[str, Any]]]:
    """The variants of `module`, itself among them, each with the values that were varied.

    The variants are the grid over the parameters in `FACTORS` and `KINDS`. Values out of a parameter's range are left
    out. A module without parameters of its own is a single point, since it cannot trade time for error.
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
    """Indices of the pairs (milliseconds, error) that no other pair equals or beats in both; of equals, the first."""
    front, best = set(), float("inf")
    for index in sorted(range(len(costs)), key=costs.__getitem__):
        if costs[index][1] < best:
            front.add(index)
            best = costs[index][1]
    return front


def visibility_error(frame: Frame, truth: Frame) -> dict[str, float]:
    """RMSE, bias and the other `differences` of visibility, over the pixels with a surface.

    Raises `ParameterError` if no pixel shows a surface.
    """
    mask = truth.mask
    if not mask.any():
        raise ParameterError("visibility cannot be compared: no pixel of this view shows a surface")
    return differences(frame["visibility"][mask] - truth["visibility"][mask])


def _chosen(modules: Iterable[str | Module | type[Module]] | None, judge: SSAO, scene: Scene) -> list[Module]:
    """The modules that have the buffer `visibility`, with the radius of `judge`."""
    chosen = []
    for module in (find(one, MODULES) for one in (modules or MODULES)):
        if "visibility" not in {*module.outputs, *module.derived}:
            given = ", ".join(module.outputs)
            notice(f"{label(type(module))} is left out: it has {given}, no visibility")
        elif module.has_radius():
            chosen.append(module.replace(radius=judge.radius))
        else:
            chosen.append(module.resolved(scene))
    return chosen


def _times(
    lab: Lab, scene: Scene, modules: list[Module], frames: int, shared: set[str]
) -> list[list[dict[str, float]]]:
    """{own pass: milliseconds} by module and frame. The modules take turns, so that a slow minute affects them all."""
    times: list[list[dict[str, float]]] = [[] for _ in modules]
    with progress_bar("times", frames * len(modules), " frames") as bar:
        for _ in range(frames):
            for module, known in zip(modules, times, strict=True):
                timings = lab.render(scene, module).complete().timings
                known.append({name: milliseconds for name, milliseconds in timings.items() if name not in shared})
                bar.update()
    return times


def _point(
    name: str, varied: dict[str, Any], default: bool, error: dict[str, float], passes: list[dict[str, float]]
) -> Point:
    cost = summary([sum(frame.values()) for frame in passes])
    medians = {step: statistics.median(frame[step] for frame in passes) for step in passes[0]}
    return Point(name, varied, default, cost["median"], cost["spread"], medians, error["rmse"], error["bias"])
