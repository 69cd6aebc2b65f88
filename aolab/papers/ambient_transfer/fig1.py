"""Ambient transfer, figure 1: the fuzzy measures, and the obscurance that each of them gives beside a wall."""

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure as Plot
from PIL import Image

from ...gl.texture import Size
from ...modules.ambient_transfer import AmbientTransfer
from ...modules.measures import MEASURES, Measure
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ..figure import Figure, Need, figure
from .corner import beside_the_wall, corner, exact

CONVERGED = AmbientTransfer(radius=1.0, directions=16, steps=16, thickness=10, bias=0, filter="none")
BEYOND = (1.1, 1.3)  # radii from the wall


def fig1(size: Size = (320, 180), accumulate: int = 8) -> Figure:
    """The four measures as curves, and the converged obscurance of a floor beside an endless wall with each.

    Numbers: the mean and the root mean square difference from the exact obscurance; the obscurance beyond the radius.
    """
    scene, numbers, needs, pictures = corner(), {}, [], []
    pictures.append(("the measures, by the distance in radii", _curves(size)))
    for name, kind in MEASURES.items():
        measure = kind()
        frame = shared_lab().render(scene, CONVERGED, size=size, measure=measure, accumulate=accumulate)
        near, distance = beside_the_wall(frame, 0.1, 1.0)
        error = frame["obscurance"][near] - exact(distance, measure)
        beyond, farther = beside_the_wall(frame, *BEYOND)
        numbers[name] = {
            "bias": float(error.mean()),
            "rmse": float(np.sqrt((error**2).mean())),
            "mean": float(frame["obscurance"][near].mean()),
            "beyond the radius": float(frame["obscurance"][beyond].mean()),
            "beyond the radius, exact": float(exact(farther, measure).mean()),
        }
        needs.append(Need(f"the bias of the obscurance, {name}", numbers[name]["bias"], -0.012, 0.012))
        needs.append(Need(f"the rmse of the obscurance, {name}", numbers[name]["rmse"], below=0.025))
        pictures.append((f"{name}: mean {numbers[name]['mean']:.3f}", gray(frame["obscurance"])))
        open_beyond = numbers[name]["beyond the radius"]
        if name == "exponential":
            needs.append(Need("the obscurance beyond the radius, exponential", open_beyond, below=0.9995))
        else:
            needs.append(Need(f"the obscurance beyond the radius, {name}", open_beyond, above=0.9995))
    means = [numbers[name]["mean"] for name in ("classical", "linear", "sqrt")]
    needs.append(
        Need(
            "the least step of the mean from classical to linear to square root", float(min(np.diff(means))), above=0.02
        )
    )
    claim = (
        "Any measure that grows from 0 to 1 gives an obscurance; those that are 1 from the radius on consider near "
        "occluders alone, and the exponential one considers far ones too"
    )
    return figure("Ambient transfer, Fig. 1", claim, needs, numbers, pictures, 3)


def _curves(size: Size) -> np.ndarray:
    """(H, W, 3) uint8."""
    plot = Plot(figsize=(3.2, 1.8), dpi=200, layout="constrained")
    axes = plot.subplots()
    distance = np.linspace(0, 1.5, 301)
    for measure in _each():
        axes.plot(distance, measure.openness(distance), label=measure.name)
    axes.tick_params(labelsize=6)
    axes.legend(fontsize=6, loc="lower right")
    canvas = FigureCanvasAgg(plot)
    canvas.draw()
    picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3])
    return np.asarray(picture.resize(size, Image.Resampling.LANCZOS))


def _each() -> list[Measure]:
    return [kind() for kind in MEASURES.values()]
