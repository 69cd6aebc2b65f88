"""Ambient transfer, figure 9: a carved wall under the environment, modulated with O and with W, and W alone."""

from dataclasses import replace

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules.ambient_transfer import AmbientTransfer
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.mesh import Material
from ...scene.scene import Scene
from ...truth import reference
from ..closeups import over_background
from ..figure import Figure, Need, figure
from ..pixels import rmse, world_positions

# the carving exists in the height map alone, as in section 6
MODULE = AmbientTransfer(radius=0.3, directions=16, steps=4, measure="linear", occluders="height")
FRONT = Camera((0, 1.1, 5), (0, 1.1, 0), ortho=1.9)  # without parallax between the flat wall and the carved one
DARK = 0.2  # creases: the darkest share of the wall


def fig9(size: Size = (320, 180), rays: int = 256) -> Figure:
    """A wall of albedo (0.6, 0.3, 0.3) whose relief is a height map; beside rays on a wall with the relief as geometry.

    Numbers: O and W in the creases by colour; the root mean square errors of W by the height map and by the depth
    buffer alone; W under white, and its difference from O under black surfaces.
    """
    lab, flat, carved = shared_lab(), _daylight(load("relief")), _daylight(load("relief", carved=True))
    frame = lab.render(flat, MODULE, size=size, camera=FRONT)
    by_depth = lab.render(flat, MODULE.replace(occluders="depth"), size=size, camera=FRONT)
    truth = reference(carved, like=frame, rays=rays, buffers=("obscurance", "transfer"))
    wall = _wall(frame, truth)
    crease = wall & (truth["obscurance"] < np.quantile(truth["obscurance"][wall], DARK))
    transfer, open = (frame[name][crease].mean(axis=0) for name in ("transfer", "obscurance"))
    traced, error = truth["transfer"][crease].mean(axis=0), rmse(frame["transfer"], truth["transfer"], wall)
    without = rmse(by_depth["transfer"], truth["transfer"], wall)
    white, black = (lab.render(_painted(flat, value), MODULE, size=size, camera=FRONT) for value in (1.0, 0.0))
    off_white = float(np.abs(white["transfer"] - 1)[wall & (white["obscurance"] > 0)].max())
    off_black = float(np.abs(black["transfer"] - black["obscurance"][..., None])[wall].max())
    needs = (
        Need("red over green of W in the creases", float(transfer[0] / transfer[1]), 1.03, 1.3),
        Need("W over O in the creases, red", float(transfer[0] / open), above=1.1),
        Need("W over O in the creases, green", float(transfer[1] / open), above=1.04),
        Need("W in the creases over rays', red", float(transfer[0] / traced[0]), 0.85, 1.15),
        Need("the error of W by the height map over that by the depth", error / without, below=0.6),
        Need("the greatest difference of W from 1 under white surfaces", off_white, below=1e-6),
        Need("the greatest difference of W from O under black surfaces", off_black, below=1e-6),
    )
    numbers = {
        "in the creases": {"O": float(open), "W": transfer.tolist(), "W by rays": traced.tolist()},
        "rmse of W": {"height map": error, "depth": without},
        "W under white less 1": off_white,
        "W under black less O": off_black,
    }
    seen = lab.render(flat, MODULE, size=size)
    plain = lab.render(flat, "none", size=size)
    pictures = [
        ("environment only", plain.image),
        ("modulated with O", _modulated(seen)),
        ("modulated with W", seen.image),
        ("W", (255 * seen["transfer"].clip(0, 1)).astype(np.uint8)),
        ("W by the depth alone", (255 * by_depth["transfer"].clip(0, 1)).astype(np.uint8)),
        ("W by rays, carved", (255 * truth["transfer"].clip(0, 1)).astype(np.uint8)),
    ]
    claim = "O darkens creases too much; W is lighter there and has the colour of the surface"
    return figure("Ambient transfer, Fig. 9", claim, needs, numbers, pictures, 3)


def _daylight(scene: Scene) -> Scene:
    """The scene without its sun."""
    return scene.replace(lights=())


def _painted(scene: Scene, albedo: float) -> Scene:
    """The scene with one albedo for all surfaces."""
    instances = []
    for one in scene.instances:
        material = Material((albedo, albedo, albedo), height=one.mesh.material.height)
        instances.append(replace(one, mesh=replace(one.mesh, material=material)))
    return scene.replace(instances=tuple(instances))


def _wall(frame: Frame, truth: Frame) -> np.ndarray:
    """(H, W) bool: the pixels that show the wall, flat and carved."""
    flat, carved = (world_positions(one)[..., 2] for one in (frame, truth))
    return frame.mask & truth.mask & (np.abs(flat) < 1e-3) & (carved > -0.01) & (carved < 0.1)


def _modulated(frame: Frame) -> np.ndarray:
    """(H, W, 3) uint8: the frame's image without the reflections of occluders."""
    return over_background(frame["ambient"] + frame["direct"], frame)
