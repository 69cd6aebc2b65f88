"""What things cost here: medians, with the interquartile range beside them and the renderer's name by every figure."""

import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..modules import MODULES, SSAO, Module
from ..modules.passes import Pass
from ..pipeline.lab import Lab
from ..scene.scene import Scene

SMALL = (640, 360)
Result = dict[str, Any]


def summary(values: Sequence[float]) -> dict[str, float]:
    """Median and spread (interquartile range) of milliseconds."""
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return {"median": middle, "spread": high - low}


def frames(scene_name: str, size: Size, repeats: int) -> Result:
    """Every module's passes and whole frame at `size`; Python's share at 640×360; SSAO against bare loops."""
    scene, lab = load(scene_name), Lab(size)
    result: Result = {
        "renderer": context.renderer(),
        "scene": scene_name,
        "size": list(size),
        "frames": repeats,
        "modules": {name: _module(lab, scene, module(), size, repeats) for name, module in MODULES.items()},
        "python_share": {"size": list(SMALL), "percent": _python_share(lab, scene, repeats)},
        "ssao_16x1_against": _against_bare_loops(lab, scene, size, repeats),
    }
    return result


def _module(lab: Lab, scene: Scene, module: Module, size: Size, repeats: int) -> Result:
    lab.render(scene, module, size=size)  # compiles
    measured = [lab.render(scene, module, size=size) for _ in range(repeats)]
    passes = {name: summary([frame.timings[name] for frame in measured]) for name in measured[0].timings}
    return {"passes": passes, "frame": summary([frame.frame_ms for frame in measured])}


def _python_share(lab: Lab, scene: Scene, repeats: int) -> dict[str, float]:
    """The part of a steady frame in which no GL command was issued or waited for, in percent."""
    lab.render(scene, "ssao", size=SMALL)
    measured = [lab.render(scene, "ssao", size=SMALL) for _ in range(repeats)]
    return summary([100 * (1 - sum(frame.timings.values()) / frame.frame_ms) for frame in measured])


def _against_bare_loops(lab: Lab, scene: Scene, size: Size, repeats: int) -> Result:
    """The SSAO pass, 16 directions × 1 step, and two loops with as many taps, turn by turn in one run."""
    module = SSAO(directions=16, steps=1, filter="none")
    candidates = {"ssao": module, **{name: _bare(name) for name in ("same_taps", "fixed_taps")}}
    times: dict[str, list[float]] = {name: [] for name in candidates}
    for turn in range(repeats + 1):
        for name, one in candidates.items():
            frame = lab.render(scene, one, size=size)
            if turn:  # the first one compiles
                times[name].append(frame.timings[one.name])
    ratios = {
        name: summary([ssao / bare for ssao, bare in zip(times["ssao"], times[name], strict=True)])
        for name in ("same_taps", "fixed_taps")
    }
    return {"milliseconds": {name: summary(values) for name, values in times.items()}, "ratio": ratios}


def _bare(shader: str) -> Module:
    class Bare(SSAO):
        def passes(self) -> list[Pass]:
            return [Pass("ssao", f"bench/{shader}.frag", self.outputs)]

    return Bare(directions=16, steps=1, filter="none")


def scaling(size: Size, repeats: int) -> Result:
    """How the passes and the frame grow with pixels, taps and triangles: fitted exponents of a power law."""
    lab = Lab(size)
    boxes = load("boxes")
    halves = [(max(1, size[0] // k), max(1, size[1] // k)) for k in (4, 3, 2, 1)]
    by_pixels = {w * h: _costs(lab, boxes, SSAO(), (w, h), repeats) for w, h in halves}
    by_taps = {n * 2: _costs(lab, boxes, SSAO(directions=n, steps=2), size, repeats) for n in (8, 16, 32, 64)}
    details = [load("atrium", detail=detail) for detail in (1, 2, 3, 4)]
    by_triangles = {scene.triangles: _costs(lab, scene, SSAO(radius=0.5), size, repeats) for scene in details}
    return {
        "renderer": context.renderer(),
        "size": list(size),
        "frames": repeats,
        "pixels": _fit(by_pixels),
        "taps": _fit(by_taps),
        "triangles": _fit(by_triangles),
    }


def _costs(lab: Lab, scene: Scene, module: Module, size: Size, repeats: int) -> dict[str, float]:
    measured = _module(lab, scene, module, size, repeats)
    passes = {name: measured["passes"][name]["median"] for name in ("g_buffer", "ssao", "filter visibility")}
    return {**passes, "frame": measured["frame"]["median"]}


def _fit(costs: dict[int, dict[str, float]]) -> Result:
    """milliseconds ≈ c · x^exponent, by least squares on the logarithms."""
    x = np.log(list(costs))
    names = next(iter(costs.values()))
    exponents = {
        name: float(np.polyfit(x, np.log([max(one[name], 1e-3) for one in costs.values()]), 1)[0]) for name in names
    }
    return {"milliseconds": costs, "exponents": exponents}


def start_up(repeats: int) -> Result:
    """Seconds to import aolab, and from process start to a saved picture, each in a fresh process."""
    with tempfile.TemporaryDirectory() as folder:
        picture = str(Path(folder) / "out.png")
        render = ["-m", "aolab.shell.cli", "render", "boxes", "--size", "640x360", "-o", picture]
        importing = ["-c", "import aolab; aolab.Lab, aolab.render, aolab.load, aolab.SSAO"]
        seconds = {
            "python alone": _process(["-c", "pass"], repeats),
            "import aolab, and its names": _process(importing, repeats),
            "start to saved picture, 640x360": _process(render, repeats),
        }
    return {"renderer": context.renderer(), "seconds": seconds}


def _process(arguments: list[str], repeats: int) -> dict[str, float]:
    times = []
    for _ in range(repeats):
        start = perf_counter()
        subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL, env=os.environ)
        times.append(perf_counter() - start)
    return summary(times)


def table(result: Result) -> str:
    """The result as lines to read."""
    lines: list[str] = []
    _rows(result, 0, lines.append)
    return "\n".join(lines)


def _rows(value: Result, depth: int, emit: Callable[[str], None]) -> None:
    indent = "  " * depth
    for key, one in value.items():
        if isinstance(one, dict) and set(one) == {"median", "spread"}:
            emit(f"{indent}{key:<{34 - 2 * depth}}{one['median']:9.3f} ± {one['spread']:.3f}")
        elif isinstance(one, dict):
            emit(f"{indent}{key}")
            _rows(one, depth + 1, emit)
        elif isinstance(one, float):
            emit(f"{indent}{key:<{34 - 2 * depth}}{one:9.3f}")
        else:
            emit(f"{indent}{key}: {one}")
