"""The region of interest of a grid: the whole scene, a box, or the surroundings of an object that may move."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...errors import ParameterError, notice, suggestion
from ...scene.scene import Scene

Corner = tuple[float, float, float]
Box = tuple[Corner, Corner]
WHOLE = "scene"
SURROUNDINGS = 0.5  # of an object's diagonal: its region reaches so far beyond its bounds on every side


def region_of(scene: Scene, region: str | Box) -> np.ndarray:
    """(2, 3) float64: the world-space box of `region`: "scene", two opposite corners, or the name of an object.

    Objects are instances and meshes. An object's region reaches half the object's diagonal beyond its bounds.
    Raises `ParameterError` for a box without extent and for an unknown name. A `Notice` warns of a box without meshes.
    """
    if region == WHOLE:
        return scene.bounds
    if isinstance(region, str):
        return _around(scene, region)
    box = np.sort(np.array(region, np.float64), axis=0)
    if not np.ptp(box, axis=0).any():
        raise ParameterError(f"voxel_region = {region} has no extent: its two corners are the same")
    if not any(_meet(box, instance.bounds) for instance in scene.instances):
        notice(
            f"voxel_region = {region} holds no mesh of scene '{scene.name}', whose bounds are "
            f"{_plain(scene.bounds[0])} to {_plain(scene.bounds[1])}: nothing will block"
        )
    return box


def _around(scene: Scene, name: str) -> np.ndarray:
    found = [instance.bounds for instance in scene.instances if name in (instance.name, instance.mesh.name)]
    if not found:
        names = {label for instance in scene.instances for label in (instance.name, instance.mesh.name)} - {""}
        raise ParameterError(
            f"voxel_region = '{name}' is no object of scene '{scene.name}'{suggestion(name, [WHOLE, *sorted(names)])}"
        )
    low, high = np.min([box[0] for box in found], axis=0), np.max([box[1] for box in found], axis=0)
    reach = SURROUNDINGS * float(np.linalg.norm(high - low))
    return np.array([low - reach, high + reach])


def _meet(box: np.ndarray, other: np.ndarray) -> bool:
    return bool((box[0] <= other[1]).all() and (other[0] <= box[1]).all())


def _plain(corner: Sequence[Any] | np.ndarray) -> str:
    return "(" + ", ".join(f"{value:.3g}" for value in corner) + ")"
