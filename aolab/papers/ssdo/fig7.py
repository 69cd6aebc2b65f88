"""SSDO, figure 7: a hidden column, for a single view and for further cameras."""

from dataclasses import replace

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules import SSDO
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.mesh import Material
from ...scene.scene import Scene
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, Need, figure

RADIUS = 2.0  # metres: the hidden column stands 1.6 m behind the nearest one
CROP = (slice(0.5, 1.0), slice(0.25, 0.75))  # rows and columns, of the picture: the feet of both columns
KINDS = {"a single view": "depth", "four more views": "views", "rays": ""}


def fig7(size: Size = (320, 180), rays: int = 128) -> Figure:
    """The floor around a column that hides another column, which casts a shadow and bounces pink light.

    The columns are round: flutes would be finer than a pixel, and no screen-space method finds the bounce among them.
    Numbers, as multiples of the rays': the occlusion that is missing without the hidden column, and the bounce that is
    missing if the column is black.
    """
    scene = load("colonnade", fluted=False)
    *others, pink = scene.instances
    black = replace(pink, mesh=replace(pink.mesh, material=Material((0, 0, 0))))
    scenes = scene, scene.replace(instances=tuple(others)), scene.replace(instances=(*others, black))
    shade, bounce, pictures = {}, {}, []
    for name, occluders in KINDS.items():
        whole, without, unpainted = (_with_bounce(one, (2 * size[0], 2 * size[1]), occluders, rays) for one in scenes)
        lost = np.where(whole.mask, without["visibility"] - whole["visibility"], 0)
        gained = whole["indirect"] - unpainted["indirect"]
        shade[name], bounce[name] = float(lost.sum()), float(gained.sum())
        pictures.append((f"{name}: visibility", gray(_crop(whole["visibility"]))))
        pictures.append((f"{name}: 4 times the bounce", shown(4 * _crop(whole["indirect"]))))
        pictures.append((f"{name}: 10 times the hidden one's", shown(10 * _crop(np.maximum(gained, 0)))))
    found = {
        "shadow": {name: value / shade["rays"] for name, value in shade.items()},
        "bounce": {name: value / bounce["rays"] for name, value in bounce.items()},
    }
    needs = []
    for what, shares in found.items():
        needs += [
            Need(f"the hidden column's {what} over rays', a single view", shares["a single view"], -0.01, 0.01),
            Need(f"the hidden column's {what} over rays', four more views", shares["four more views"], 0.8, 1.2),
        ]
    claim = "A single view misses a hidden column's shadow and its bounce, and four more views find both"
    by_row = pictures[0::3] + pictures[1::3] + pictures[2::3]
    return figure("SSDO, Fig. 7", claim, needs, {"of_the_hidden_column": found, "rays": rays}, by_row, 3)


def _with_bounce(scene: Scene, size: Size, occluders: str, rays: int) -> Frame:
    """The frame with these `occluders`; with "" it is the truth."""
    module = SSDO(radius=RADIUS, directions=16, steps=8, bounces=1)
    if not occluders:
        return reference(scene, size=size, like=module, rays=rays, buffers=("visibility", "indirect"))
    return shared_lab().render(scene, module, size=size, accumulate=4, occluders=occluders)


def _crop(values: np.ndarray) -> np.ndarray:
    height, width = values.shape[:2]
    rows, columns = (
        slice(int(part.start * length), int(part.start * length) + length // 2)
        for part, length in zip(CROP, (height, width), strict=True)
    )
    return values[rows, columns]
