"""SSDO's largest scene (figure 1) and its table of costs."""

import statistics

import numpy as np

from ..api import shared_lab
from ..bench import summary
from ..frame import Frame
from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..machine import describe
from ..modules import SSAO, SSDO, Module
from ..scene import Scene
from ..sheet import contact_sheet, table
from .figure import Figure

REPEATS = 9  # frames of which the median is told
RADIUS = 0.6  # metres: reaches across the mouldings and the folds of the curtains
PAPER_TRIANGLES = 537_000

# resolution, N: frames a second with SSAO, SSDO and one bounce, and the overheads in percent, as printed (Table 1)
PAPER = {
    ((1024, 768), 8): (81.0, 81.3, 65.8, 0.2, 19.3),
    ((1024, 768), 16): (58.0, 56.5, 40.5, 2.6, 30.2),
    ((1200, 960), 8): (37.7, 37.5, 25.5, 0.5, 32.4),
    ((1200, 960), 16): (25.4, 23.6, 14.7, 7.1, 22.2),
    ((1600, 1200), 8): (24.8, 24.2, 15.9, 2.4, 35.9),
    ((1600, 1200), 16): (16.8, 15.3, 9.0, 8.9, 46.4),
}


def fig1(size: Size = (960, 540), repeats: int = REPEATS) -> Figure:
    """The largest scene, without, with SSAO, SSDO, and one bounce; what the passes cost there and among few triangles.

    `detail` 1 and 4 of the atrium have the same shapes, so the passes see much the same picture.
    """
    modules: dict[str, Module] = {
        "none": SSAO(radius=1e-3, directions=1, steps=1),
        "SSAO": SSAO(radius=RADIUS, directions=16),
        "SSDO": SSDO(radius=RADIUS, directions=16),
        "SSDO + 1 bounce": SSDO(radius=RADIUS, directions=16, bounces=1),
    }
    large, small = load("atrium", detail=4), load("atrium", detail=1)
    lab = shared_lab()
    frames = {name: lab.render(large, module, size=size) for name, module in modules.items()}
    times: dict[str, list[float]] = {"large": [], "small": [], "frame": []}
    for _ in range(repeats):
        for name, scene in (("large", large), ("small", small)):
            frame = lab.render(scene, modules["SSDO + 1 bounce"], size=size)
            times[name].append(_own_passes(frame))
            if scene is large:
                times["frame"].append(frame.frame_ms)
    medians = {name: statistics.median(values) for name, values in times.items()}
    claim = "The method's own passes cost the same however many triangles the scene has"
    numbers = {
        "triangles": large.triangles,
        "paper_triangles": PAPER_TRIANGLES,
        "fewer_triangles": small.triangles,
        "milliseconds": {
            "passes": medians["large"],
            "passes_with_fewer_triangles": medians["small"],
            "frame": medians["frame"],
        },
        "renderer": context.renderer(),
        "machine": describe(),
    }
    title = (
        f"SSDO, Fig. 1: {large.triangles:,} triangles (the paper: {PAPER_TRIANGLES:,}). {claim}: {medians['large']:.0f} ms, "
        f"and {medians['small']:.0f} ms for {small.triangles:,} ({context.renderer()})."
    )
    picture = contact_sheet([(name, frame.image) for name, frame in frames.items()], 2, title=title)
    return Figure(picture, numbers, claim, medians["large"] < 1.25 * medians["small"])


def _own_passes(frame: Frame) -> float:
    return sum(milliseconds for name, milliseconds in frame.timings.items() if name.startswith("ssdo"))
