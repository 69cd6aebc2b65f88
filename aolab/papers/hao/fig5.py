"""HAO, figure 5: the number of rays, without and with the filter."""

from itertools import pairwise

from ...gl.texture import Size
from ...loading import load
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ..figure import Figure, Need, figure
from ..pixels import noise
from .settings import TABLE_1

RAYS = (16, 32, 64, 128)


def fig5(size: Size = (320, 180), seeds: int = 4) -> Figure:
    """A colonnade with 16 to 128 rays a pixel, before and after the filter.

    Numbers: the relative noise among `seeds` sets of rays.
    """
    scene, lab = load("colonnade"), shared_lab()
    raw, filtered, pictures = [], [], []
    for count in RAYS:
        bare, smooth = (
            [lab.render(scene, module, size=size, seed=seed) for seed in range(1, seeds + 1)]
            for module in (TABLE_1.replace(directions=count, filter="none"), TABLE_1.replace(directions=count))
        )
        where = bare[0].mask
        raw.append(noise([frame["visibility"] for frame in bare], where))
        filtered.append(noise([frame["visibility"] for frame in smooth], where))
        pictures += [(f"{count} rays", gray(bare[0]["visibility"])), ("filtered", gray(smooth[0]["visibility"]))]
    needs = [
        Need(
            "the raw noise over that of half as many rays, the most",
            max(many / few for few, many in pairwise(raw)),
            below=0.85,
        ),
        Need("the filtered noise over the raw noise, the most", max(map(float.__truediv__, filtered, raw)), below=0.8),
    ]
    claim = "More rays have less noise, and the filter removes noise at every number of rays"
    numbers = {"rays": list(RAYS), "raw_noise": raw, "filtered_noise": filtered, "seeds": seeds}
    return figure("HAO, Fig. 5", claim, needs, numbers, pictures[0::2] + pictures[1::2], 4)
