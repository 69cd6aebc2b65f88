"""HAO, figure 7: three scenes without and with occlusion, and the cost of many triangles."""

import statistics
from functools import partial

from ...gl import context
from ...gl.texture import Size
from ...loading import load
from ...modules import Unoccluded
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.scene import Scene
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
    """Three scenes without occlusion and with HAO; and the atrium with few and many triangles, animated and still.

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

    def animated(scene: Scene) -> Frame:
        return lab.render(voxelised_anew(scene), TABLE_1, size=size)

    def still(scene: Scene) -> Frame:
        lab.render(scene, TABLE_1, size=size)  # which keeps its voxels
        return lab.render(scene, TABLE_1, size=size)

    draws = {
        (name, draw.__name__): partial(draw, scene)
        for name, scene in (("few", few), ("many", many))
        for draw in (animated, still)
    }
    costs = in_turns(draws, repeats)
    own = {case: statistics.median(map(own_cost, found)) for case, found in costs.items()}
    frames = {case: statistics.median(cost.frame for cost in found) for case, found in costs.items()}
    for kind in ("animated", "still"):
        needs += claimed(kind, own["few", kind], own["many", kind], frames["many", kind])
    claim = "Occlusion by HAO is near rays', and its cost hardly depends on the number of triangles"
    numbers = {
        "rmse": error,
        "triangles": {"few": few.triangles, "many": many.triangles},
        "milliseconds": {
            f"{kind} scene": {name: {"own": own[name, kind], "frame": frames[name, kind]} for name in ("few", "many")}
            for kind in ("animated", "still")
        },
        "rays": rays,
        "turns": repeats,
        "renderer": context.renderer(),
        "machine": describe(),
    }
    heading = f"HAO, Fig. 7, {context.renderer()}, {describe()}"
    return figure(heading, claim, needs, numbers, pictures[0::2] + pictures[1::2], 3)


def claimed(kind: str, few: float, many: float, frame: float) -> list[Need]:
    """The claim's need, from milliseconds: of HAO's own passes among few and many triangles, and of a whole frame.

    An `animated` scene is voxelised in each frame, a `still` one was voxelised before.
    """
    name = f"the cost that many triangles add to HAO's passes, as a share of the frame, {kind} scene"
    return [Need(name, (many - few) / frame, below=0.1)]
