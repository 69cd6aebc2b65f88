"""HAO, figure 6: the cost of the grid's size, of the number of rays and of the filter's size."""

import statistics
from collections.abc import Callable, Mapping
from typing import Any

from ...gl import context
from ...gl.texture import Size
from ...loading import load
from ...modules import HAO
from ...pictures.sheet import table
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...studies.machine import describe
from ..figure import Figure, Need, title
from ..timing import REPEATS, in_turns
from .settings import SIZE, TABLE_1, voxelised_anew

VARIED: dict[str, tuple[int, ...]] = {
    "voxels": (64, 128, 256, 512),
    "directions": (16, 32, 64, 128),
    "filter_size": (4, 8, 16, 32),
}


def fig6(size: Size = SIZE, repeats: int = REPEATS) -> Figure:
    """The milliseconds of a frame of toasters, which is voxelised anew each time, as one parameter varies."""
    scene, lab = load("toasters"), shared_lab()

    def draw(module: HAO) -> Callable[[], Frame]:
        return lambda: lab.render(voxelised_anew(scene), module, size=size)

    cases = {(name, value): TABLE_1.replace(**{name: value}) for name, values in VARIED.items() for value in values}
    costs = in_turns({case: draw(module) for case, module in cases.items()}, repeats)
    frames = {case: statistics.median(cost.frame for cost in found) for case, found in costs.items()}
    rays = {value: statistics.median(cost.of("hao") for cost in costs["directions", value]) for value in (16, 128)}
    found = {name: {value: frames[name, value] for value in values} for name, values in VARIED.items()}
    needs = claimed(found, rays)
    claim = "The cost of a frame is nearly flat in the size of the grid, and linear in the number of rays"
    rows = [["parameter", "value", "frame ms"]]
    rows += [[name, f"{value}", f"{ms:.1f}"] for name, values in found.items() for value, ms in values.items()]
    numbers: dict[str, Any] = {
        "milliseconds": found,
        "ray_milliseconds": rays,
        "triangles": scene.triangles,
        "turns": repeats,
        "renderer": context.renderer(),
        "machine": describe(),
    }
    setting = f"{scene.triangles:,} triangles, {size[0]}x{size[1]}, {context.renderer()}, {describe()}"
    picture = table(rows, title=title(f"HAO, Fig. 6, {setting}", claim, needs))
    return Figure(picture, numbers, claim, needs)


def claimed(frames: Mapping[str, Mapping[int, float]], rays: Mapping[int, float]) -> tuple[Need, ...]:
    """The claim's needs, from the milliseconds of frames by parameter, and of the rays' pass for 16 and 128 rays."""
    grid = frames["voxels"]
    return (
        Need("a frame with 256³ voxels over one with 64³", grid[256] / grid[64], below=1.3),
        Need("the rays' time with 128 rays over that with 16", rays[128] / rays[16], above=8 * 0.6, below=8 * 1.3),
        Need(
            "the time added by 8 times the rays over that added by 4 times the grid's size",
            (frames["directions"][128] - frames["directions"][16]) / max(grid[256] - grid[64], 1e-6),
            above=2.0,
        ),
    )
