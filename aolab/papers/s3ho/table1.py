"""S3HO's table of costs."""

import statistics
from collections.abc import Mapping
from functools import partial
from typing import Any

from ...gl import context
from ...gl.texture import Size
from ...loading import load
from ...modules import S3HO, SSAO, SSBN, SSDO, Module
from ...pictures.sheet import table
from ...pipeline.api import shared_lab
from ...studies.machine import describe
from ..figure import Figure, Need, title
from ..timing import REPEATS, Cost, in_turns, median_ratio
from .atrium import RADIUS

# directions of two steps: milliseconds with SSAO, S3HO, SSDO and SSBN (Table 1); the bounce is given in section 4
METHODS, BOUNCE = ("SSAO", "S3HO", "SSDO", "SSBN"), "S3HO + bounce"
PAPER = {8: (6.9, 7.4, 10.1, 6.9), 16: (13.3, 14.1, 20.3, 13.6), 32: (26.3, 27.8, 40.7, 27.0)}
PAPER_BOUNCE = 59.0  # at 32 directions


def table1(size: Size = (1280, 720), repeats: int = REPEATS) -> Figure:
    """The estimates' passes, as in the paper, and whole frames: the atrium, two steps per direction, sums as printed.

    The ratios to SSAO are medians over turns; each turn draws one frame of every row. "+ bounce" is S3HOGI, with the
    pass of the senders.

    On a CPU (llvmpipe) S3HO costs more than SSAO. The paper's GPU waited for texture reads, and computed the sums of
    16 coefficients in that time; a CPU does not wait. At N = 8 the driver unrolls SSAO's loop of 8 directions, but not
    S3HO's.
    """
    scene = load("atrium")
    modules = {directions: _modules(directions) for directions in PAPER}
    draw = partial(shared_lab().render, scene, size=size)
    draws = {(n, name): partial(draw, module) for n, some in modules.items() for name, module in some.items()}
    costs = in_turns(draws, repeats)
    rows = [
        {"directions": n, "method": name, **_cost(costs[n, name], costs[n, "SSAO"], module.name), **_printed(n, name)}
        for n, some in modules.items()
        for name, module in some.items()
    ]
    needs = claimed({n: {row["method"]: row["ratio"] for row in rows if row["directions"] == n} for n in PAPER})
    numbers = {
        "rows": rows,
        "size": list(size),
        "triangles": scene.triangles,
        "turns": repeats,
        "renderer": context.renderer(),
        "machine": describe(),
    }
    claim = "SSBN costs less than S3HO, S3HO less than SSDO, and S3HO at most 1.07 times as much as SSAO"
    setting = f"{size[0]} x {size[1]}, {repeats} turns, {context.renderer()}, {describe()}"
    picture = table(_cells(rows), title=title(f"S3HO, Table 1, {setting}", claim, needs))
    return Figure(picture, numbers, claim, needs)


def claimed(ratios: Mapping[int, Mapping[str, float]]) -> tuple[Need, ...]:
    """The claim's needs, from the costs as multiples of SSAO's, by number of directions and method."""
    needs = []
    for n, ratio in ratios.items():
        needs += [
            Need(f"the cost of SSBN over S3HO's, N = {n}", ratio["SSBN"] / ratio["S3HO"], below=1),
            Need(f"the cost of S3HO over SSDO's, N = {n}", ratio["S3HO"] / ratio["SSDO"], below=1),
            Need(f"the cost of S3HO over SSAO's, N = {n}", ratio["S3HO"], below=1.075),
        ]
    return tuple(needs)


def _modules(directions: int) -> dict[str, Module]:
    common = {"radius": RADIUS, "directions": directions, "steps": 2}
    return {
        "SSAO": SSAO(**common),
        "S3HO": S3HO(**common).replace(estimator="plain"),
        "SSDO": SSDO(**common).replace(estimator="plain"),
        "SSBN": SSBN(**common).replace(weighting="uniform"),
        BOUNCE: S3HO(**common, indirect=True).replace(estimator="plain", senders="patches"),
    }


def _printed(directions: int, name: str) -> dict[str, float | None]:
    printed = dict(zip(METHODS, PAPER[directions], strict=True))
    if directions == max(PAPER):
        printed[BOUNCE] = PAPER_BOUNCE
    paper = printed.get(name)
    return {"paper": paper, "paper_ratio": paper and paper / printed["SSAO"]}


def _cost(costs: list[Cost], ssao: list[Cost], stem: str) -> dict[str, float]:
    """Milliseconds of the estimate's passes and of frames, and their ratios to SSAO's."""
    passes, frames = [cost.of(stem) for cost in costs], [cost.frame for cost in costs]
    return {
        "pass": statistics.median(passes),
        "ratio": median_ratio(passes, [cost.of("ssao") for cost in ssao]),
        "frame": statistics.median(frames),
        "frame_ratio": median_ratio(frames, [cost.frame for cost in ssao]),
    }


def _cells(rows: list[dict[str, Any]]) -> list[list[str]]:
    cells = [["N", "method", "pass ms", "/ SSAO", "paper ms", "/ SSAO", "frame ms", "/ SSAO"]]
    for row in rows:
        printed = ("", "") if row["paper"] is None else (f"{row['paper']:.1f}", f"{row['paper_ratio']:.2f}")
        own, frame = (f"{row['pass']:.1f}", f"{row['ratio']:.2f}"), (f"{row['frame']:.0f}", f"{row['frame_ratio']:.2f}")
        cells.append([str(row["directions"]), row["method"], *own, *printed, *frame])
    return cells
