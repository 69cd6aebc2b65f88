"""Growth of a frame's time with pixels, taps, triangles, lights, layers and views: exponents of fitted power laws."""

import statistics
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..modules import SSAO, Module
from ..pipeline.lab import Lab
from ..progress import progress_bar
from ..scene.lights import SpotLight
from ..scene.scene import Scene
from ..table import table as aligned
from . import machine

# the parts of a frame that the tables and the picture show; a pass of no other part is one of lighting
PARTS = {
    "g_buffer": ("g_buffer",),
    "occluders": ("peel", "pack layers", "views"),
    "estimate": ("ssao",),
    "filter": ("filter visibility",),
}
LIGHTING, FRAME = "lighting", "frame"
Case = tuple[int, Scene, Module, Size]


def scaling(size: Size, repeats: int) -> dict[str, Any]:
    """Milliseconds of the parts of a frame with `ssao`, and of the frame, while one number grows; and its exponents.

    Each time is the median of `repeats` warm frames: shadow maps are drawn before.
    """
    lab, cases = Lab(size), _cases(size)
    result: dict[str, Any] = {
        "renderer": context.renderer(),
        "machine": machine.describe(),
        "size": list(size),
        "frames": repeats,
        "growth": {},
    }
    with progress_bar("settings", sum(map(len, cases.values())), "setting") as bar:
        for name, settings in cases.items():
            result["growth"][name] = fitted(dict(_measured(lab, settings, repeats)))
            bar.update(len(settings))
    return result


def _cases(size: Size) -> dict[str, list[Case]]:
    boxes = load("boxes")
    shares = [(max(1, size[0] // k), max(1, size[1] // k)) for k in (4, 3, 2, 1)]
    details = [load("atrium", detail=detail) for detail in (1, 2, 3, 4)]
    rounds = [(2.5 * np.cos(angle), 3.0, 2.5 * np.sin(angle)) for angle in np.linspace(0, 6, 32)]
    lamps = [SpotLight(place, (-place[0], -3.0, -place[2])) for place in rounds]
    return {
        "pixels": [(w * h, boxes, SSAO(), (w, h)) for w, h in shares],
        "taps": [(n * 2, boxes, SSAO(directions=n, steps=2), size) for n in (8, 16, 32, 64)],
        "triangles": [(scene.triangles, scene, SSAO(radius=0.5), size) for scene in details],
        "lights": [(n, boxes.replace(lights=tuple(lamps[:n])), SSAO(), size) for n in (1, 4, 16, 32)],
        "layers": [(n, boxes, SSAO(occluders="layers", layers=n), size) for n in (2, 3, 4)],
        "views": [(n, boxes, SSAO(occluders="views", views=n), size) for n in (1, 2, 4)],
    }


def _measured(lab: Lab, settings: list[Case], repeats: int) -> Iterator[tuple[int, dict[str, float]]]:
    for count, scene, module, pixels in settings:
        lab.render(scene, module, size=pixels).complete("image")  # compiles shaders, uploads, draws shadow maps
        frames = [lab.render(scene, module, size=pixels).complete("image") for _ in range(repeats)]
        parts = [_parts(frame.timings, frame.frame_ms) for frame in frames]
        yield count, {name: statistics.median(one[name] for one in parts) for name in parts[0]}


def _parts(timings: Mapping[str, float], frame: float) -> dict[str, float]:
    own = {part: sum(timings.get(name, 0.0) for name in names) for part, names in PARTS.items()}
    return {**own, LIGHTING: sum(timings.values()) - sum(own.values()), FRAME: frame}


def fitted(costs: Mapping[int, Mapping[str, float]]) -> dict[str, Any]:
    """Exponents of milliseconds ≈ c · x^exponent, by least squares on the logarithms; of the parts that are there."""
    x = np.log(list(costs))
    names = [name for name in next(iter(costs.values())) if any(one[name] > 0 for one in costs.values())]
    exponents = {
        name: float(np.polyfit(x, np.log([max(one[name], 1e-3) for one in costs.values()]), 1)[0]) for name in names
    }
    kept = {count: {name: one[name] for name in names} for count, one in costs.items()}
    return {"milliseconds": kept, "exponents": exponents}


def table(result: Mapping[str, Any]) -> str:
    """The result of `scaling` as lines of text. The last line of each table has the exponents."""
    width, height = result["size"]
    parts = [f"renderer: {result['renderer']}\n{width}x{height}, medians of {result['frames']} frames"]
    for what, found in result["growth"].items():
        names = list(found["exponents"])
        rows = [[f"{count}", *(cost[name] for name in names)] for count, cost in found["milliseconds"].items()]
        rows.append(["exponent", *(found["exponents"][name] for name in names)])
        parts.append(aligned({what: ">", **{f"{name}, ms": ".3f" for name in names}}, rows))
    return "\n\n".join(parts)
