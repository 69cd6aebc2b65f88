"""HAO, figure 8: an animated scene, and a camera that moves without flicker."""

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...measures.flicker import flicker
from ...modules import SSAO, Unoccluded
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ...scene.camera import Camera
from ...truth import reference
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .settings import TABLE_1

TIMES = (0.62, 0.78, 0.94)  # seconds: a toaster hops
RADIUS = 1.5  # scene units
HEIGHT = 5.0  # scene units, of the orthographic picture


def fig8(size: Size = (320, 180), rays: int = 64) -> Figure:
    """Toasters at three times: without occlusion, HAO's visibility, and both; then a still scene and a moving camera.

    Numbers: for each time, HAO's RMSE and that of the grid of the first time, against rays; the flicker of surfaces
    while only the camera moves, by HAO and by SSAO without a filter.
    """
    lab, module = shared_lab(), TABLE_1.replace(radius=RADIUS)
    error, bare, changed, anew, pictures = [], [], [], [], []
    first = None
    for time in TIMES:
        scene = load("toasters", time=time)
        frame = lab.render(scene, module, size=size)
        truth = reference(scene, size=size, like=module, rays=rays, buffers=("visibility",))
        where = frame.mask & truth.mask
        error.append(rmse(frame["visibility"], truth["visibility"], where))
        bare.append(rmse(np.ones_like(truth["visibility"]), truth["visibility"], where))
        anew.append("voxels" in frame.timings)
        changed.append(0.0 if first is None else rmse(first, truth["visibility"], where))
        first = frame["visibility"] if first is None else first
        plain = lab.render(scene, Unoccluded(), size=size)
        pictures += [
            (f"{time:g} s, without", plain.image),
            ("visibility", gray(frame["visibility"])),
            ("HAO", frame.image),
        ]
    moving = _flicker(size)
    needs = [
        Need("the RMSE against rays over that without occlusion, the most", max(np.divide(error, bare)), below=0.7),
        Need(
            "the RMSE against rays over that of the first frame's occlusion, the most",
            max(np.divide(error[1:], changed[1:])),
            below=0.9,
        ),
        Need("the frames that are voxelised", float(np.mean(anew)), above=0.999),
        Need("HAO's flicker over SSAO's as the camera moves", moving["HAO"] / moving["SSAO"], below=0.2),
    ]
    claim = "An animated scene is voxelised in each frame, and nothing flickers if only the camera moves"
    numbers = {
        "seconds": list(TIMES),
        "rmse": error,
        "rmse_without": bare,
        "rmse_of_the_first": changed,
        "flicker": moving,
        "rays": rays,
    }
    return figure("HAO, Fig. 8", claim, needs, numbers, pictures, 3)


def _flicker(size: Size) -> dict[str, float]:
    """The mean change of points of surfaces while the camera moves, without a filter.

    The camera is orthographic and moves by whole pixels, so that every frame has the same points.
    """
    scene = load("toasters")
    assert scene.camera is not None  # Scene frames itself
    still = Camera(scene.camera.eye, scene.camera.target, ortho=HEIGHT)
    right = still.view_from_world[0, :3] * HEIGHT / size[1]  # a pixel, in world space
    cameras = [
        Camera(tuple(still.eye + pixels * right), tuple(still.target + pixels * right), ortho=HEIGHT)
        for pixels in range(4)
    ]
    bare = {"radius": RADIUS, "filter": "none", "scale": 1.0}
    modules = {"HAO": TABLE_1, "SSAO": SSAO(directions=TABLE_1.directions, steps=TABLE_1.steps)}
    frames = {
        name: [shared_lab().render(scene, module.replace(**bare), camera=camera, size=size) for camera in cameras]
        for name, module in modules.items()
    }
    return {name: flicker(some).mean for name, some in frames.items()}
