"""Times on this machine: medians with interquartile ranges, and the name of the renderer with every figure."""

import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..modules import MODULES, SSAO, Module
from ..modules.passes import Pass
from ..pipeline.lab import Lab
from ..progress import progress_bar
from ..scene.scene import Scene
from ..table import table as aligned

SMALL = (640, 360)
Result = dict[str, Any]


def summary(values: Sequence[float]) -> dict[str, float]:
    """The median of `values`, and their spread: the interquartile range."""
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return {"median": middle, "spread": high - low}


def frames(scene_name: str, size: Size, repeats: int) -> Result:
    """Milliseconds of every pass and of the whole frame, for every module at `size`.

    Also the share of Python in a frame at 640×360, and SSAO against bare loops with as many taps.
    """
    scene, lab = load(scene_name), Lab(size)
    modules = {}
    with progress_bar("modules", len(MODULES) + 2, "module") as bar:
        for name, module in MODULES.items():
            modules[name] = _module(lab, scene, module(), size, repeats)
            bar.update()
        share = _python_share(lab, scene, repeats)
        bar.update()
        against = _against_bare_loops(lab, scene, size, repeats)
        bar.update()
    return {
        "renderer": context.renderer(),
        "scene": scene_name,
        "size": list(size),
        "frames": repeats,
        "modules": modules,
        "python_share": {"size": list(SMALL), "percent": share},
        "ssao_16x1_against": against,
    }


def _module(lab: Lab, scene: Scene, module: Module, size: Size, repeats: int) -> Result:
    lab.render(scene, module, size=size).complete("image")  # compiles the shaders
    measured = [lab.render(scene, module, size=size).complete("image") for _ in range(repeats)]
    passes = {name: summary([frame.timings[name] for frame in measured]) for name in measured[0].timings}
    return {"passes": passes, "frame": summary([frame.frame_ms for frame in measured])}


def _python_share(lab: Lab, scene: Scene, repeats: int) -> dict[str, float]:
    """The share of a warm frame outside of all passes, in percent."""
    lab.render(scene, "ssao", size=SMALL).complete("image")
    measured = [lab.render(scene, "ssao", size=SMALL).complete("image") for _ in range(repeats)]
    return summary([100 * (1 - sum(frame.timings.values()) / frame.frame_ms) for frame in measured])


def _against_bare_loops(lab: Lab, scene: Scene, size: Size, repeats: int) -> Result:
    """The SSAO pass with 16 directions × 1 step, and two loops with as many taps, frame by frame in turn."""
    module = SSAO(directions=16, steps=1, filter="none")
    candidates = {"ssao": module, **{name: _bare(name) for name in ("same_taps", "fixed_taps")}}
    times: dict[str, list[float]] = {name: [] for name in candidates}
    for turn in range(repeats + 1):
        for name, one in candidates.items():
            frame = lab.render(scene, one, size=size)
            if turn:  # the first frame compiles the shaders
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


def start_up(repeats: int) -> Result:
    """Seconds to import aolab, and from process start to a saved picture, each time in a new process."""
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
        command = [sys.executable, *arguments]  # in a session of its own, since Ctrl-C ends this process alone
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=os.environ, start_new_session=True)
        times.append(perf_counter() - start)
    return summary(times)


def table(result: Result) -> str:
    """The result of `frames` or `start_up` as lines of text, with the unit of every number."""
    parts = [_summaries("seconds", result["seconds"])] if "seconds" in result else _frames_tables(result)
    where = [f"renderer: {result['renderer']}"]
    if "scene" in result:
        where.append(f"scene: {result['scene']}")
    if "size" in result:
        width, height = result["size"]
        where.append(f"{width}x{height}, medians of {result['frames']} frames; ± is the interquartile range")
    return "\n\n".join(["\n".join(where), *parts])


def _frames_tables(result: Result) -> list[str]:
    rows = [
        (name, step, cost["median"], cost["spread"])
        for name, measured in result["modules"].items()
        for step, cost in {**measured["passes"], "frame": measured["frame"]}.items()
    ]
    share, bare = result["python_share"], result["ssao_16x1_against"]
    width, height = share["size"]
    return [
        aligned({"module": "", "pass": "", "milliseconds": ".3f", "±": ".3f"}, rows),
        _summaries("percent", {f"share of Python in a frame of {width}x{height}": share["percent"]}),
        _summaries("milliseconds", {f"{name}, 16 taps": cost for name, cost in bare["milliseconds"].items()}),
        _summaries("ratio", {f"ssao / {name}": cost for name, cost in bare["ratio"].items()}),
    ]


def _summaries(unit: str, found: Mapping[str, Mapping[str, float]]) -> str:
    return aligned({"": "", unit: ".3f", "±": ".3f"}, [(name, *cost.values()) for name, cost in found.items()])
