"""HAO, figure 7: three scenes without and with occlusion, and the cost of many triangles."""

import statistics
from functools import partial

from ...gl import context
from ...gl.texture import Size
from ...loading import load
from ...modules import Unoccluded
from ...pipeline.api import shared_lab
from ...studies.machine import describe
from ...truth import reference
from ..figure import Figure, Need, figure
from ..pixels import rmse
from ..timing import REPEATS, in_turns
from .settings import SIZE, TABLE_1, own_cost, voxelised_anew

# in place of the paper's scenes: 21k boxes, a dragon of 871k triangles and a cathedral of 80k. The radius, in
# scene units, is about twelve voxels
RADII = {"skyscrapers": 1.5, "toasters": 1.5, "atrium": 1.5}
DETAILS = (1, 4)  # of the atrium


def fig7(size: Size = SIZE, rays: int = 64, repeats: int = REPEATS) -> Figure:
    """Three scenes without occlusion and with HAO; and the atrium with few and with many triangles, voxelised anew.

    Numbers: the RMSE of the visibility against rays that answer the same question, with HAO and without; the cost of
    HAO's own passes with many triangles and with few.
    """
    lab, error, pictures, needs = shared_lab(), {}, [], []
    for name, radius in RADII.items():
        scene = load(name)
        module = TABLE_1.replace(radius=radius)
        plain, frame = lab.render(scene, Unoccluded(), size=size), lab.render(scene, module, size=size)
        truth = reference(scene, size=size, like=module, rays=rays, buffers=("visibility",))
        where = frame.mask & truth.mask
        error[name] = {
            kind: rmse(one["visibility"], truth["visibility"], where) for kind, one in (("none", plain), ("HAO", frame))
        }
        needs.append(Need(f"HAO's RMSE over that without, {name}", error[name]["HAO"] / error[name]["none"], below=0.7))
        pictures += [(f"{name}, without occlusion", plain.image), ("with HAO", frame.image)]
    few, many = (load("atrium", detail=detail) for detail in DETAILS)
    draws = {
        name: partial(lambda scene: lab.render(voxelised_anew(scene), TABLE_1, size=size), scene)
        for name, scene in (("few", few), ("many", many))
    }
    costs = in_turns(draws, repeats)
    own = {name: statistics.median(map(own_cost, found)) for name, found in costs.items()}
    frames = {name: statistics.median(cost.frame for cost in found) for name, found in costs.items()}
    needs += claimed(own["few"], own["many"], frames["many"])
    claim = "Occlusion by HAO is near rays', and its cost hardly depends on the number of triangles"
    numbers = {
        "rmse": error,
        "triangles": {"few": few.triangles, "many": many.triangles},
        "milliseconds": {"own": own, "frame": frames},
        "rays": rays,
        "turns": repeats,
        "renderer": context.renderer(),
        "machine": describe(),
    }
    heading = f"HAO, Fig. 7, {context.renderer()}, {describe()}"
    return figure(heading, claim, needs, numbers, pictures[0::2] + pictures[1::2], 3)


def claimed(few: float, many: float, frame: float) -> list[Need]:
    """The claim's needs, from milliseconds: of HAO's own passes among few and many triangles, and of a whole frame."""
    return [
        Need(
            "the cost that many triangles add to HAO's passes, as a share of the frame", (many - few) / frame, below=0.1
        )
    ]
