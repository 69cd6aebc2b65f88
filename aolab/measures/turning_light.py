"""Relighting error: the error of a result while the light turns around the scene."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ParameterError, notice
from ..gl.texture import Size
from ..loading import load
from ..modules import MODULES, Module, find
from ..pipeline.api import shared_lab
from ..progress import progress_bar
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..table import table
from ..truth import reference
from .buffer import NOISY
from .comparison import measured
from .metrics import Measures
from .pairing import Buffers

DEFAULT_SIZE = (320, 180)


@dataclass(frozen=True, eq=False)
class Relighting:
    """The measures of `buffer` under each of K environments, turned by `degrees` about +y."""

    buffer: str
    degrees: list[float]
    measures: list[Measures]
    relative: list[float]  # rmse / root mean square of the reference

    @property
    def rmse(self) -> float:
        """The root mean square error over all environments together."""
        return float(np.sqrt(np.mean([one.rmse**2 for one in self.measures])))

    @property
    def noise(self) -> float:
        """The root mean square of the reference's standard error over all environments; NaN where it is not known."""
        return float(np.sqrt(np.mean([one.noise**2 for one in self.measures])))

    @property
    def worst(self) -> int:
        """The index of the environment with the largest RMSE."""
        return int(np.argmax([one.rmse for one in self.measures]))

    def to_json(self) -> str:
        """RMSE, bias and relative RMSE under each rotation."""
        known = [share if np.isfinite(share) else None for share in self.relative]  # JSON has no NaN
        return json.dumps({
            "buffer": self.buffer,
            "rmse": self.rmse,
            "rotations": [
                {"degrees": degrees, "rmse": one.rmse, "bias": one.bias, "relative": relative}
                for degrees, one, relative in zip(self.degrees, self.measures, known, strict=True)
            ],
        })  # fmt: skip

    def __str__(self) -> str:
        columns = {"degrees": ".1f", "rmse": ".4g", "bias": ".4g", "relative": ".4g"}
        found = zip(self.degrees, self.measures, self.relative, strict=True)
        rows = [(degrees, one.rmse, one.bias, relative) for degrees, one, relative in found]
        head = f"{self.buffer} under {len(self.degrees)} rotations: rmse {self.rmse:.4g}"
        return f"{head}\n\n{table(columns, rows)}"


def relight(
    result: Callable[[Environment], Buffers],
    truth: Callable[[Environment], Buffers],
    environment: Environment,
    k: int = 16,
    buffer: str = "ambient",
) -> Relighting:
    """Compare `buffer` of `result` and `truth`, functions of the environment, under `k` equal turns of it about +y.

    A `Notice` is given if the truth's own noise is more than a third of the error. Raises `ParameterError` for an
    environment that is the same all around: turning it changes nothing.
    """
    if not isinstance(k, int) or k < 1:
        raise ParameterError(f"k = {k!r} is not a whole number of rotations from 1 on")
    if k > 1 and np.ptp(environment.radiance, axis=1).max() == 0:
        raise ParameterError(
            f"environment '{environment.name}' is the same all around: turning it {k} times tests nothing; "
            "give another one, such as Environment.sky(sun_direction=(1, 1, 0)), or k=1"
        )
    degrees = [360 * i / k for i in range(k)]
    measures, relative = [], []
    with progress_bar("rotations", k, "rotation") as bar:
        for angle in degrees:
            turned = environment.rotated(angle)
            one = measured(result(turned), truth(turned), buffer, flip=False)[buffer]
            scale = float(np.sqrt(np.mean(one.reference[one.foreground].astype(np.float64) ** 2)))
            measures.append(one.measures["all"])
            relative.append(one.rmse / scale if scale > 0 else float("nan"))
            bar.update()
    found = Relighting(buffer, degrees, measures, relative)
    if found.noise > NOISY * found.rmse > 0:
        notice(
            f"relighting error of '{buffer}': the reference's own standard error, {found.noise:.2g}, is "
            f"{found.noise / found.rmse:.0%} of the RMSE, {found.rmse:.2g}; give the reference more `rays`"
        )
    return found


def relighting_error(
    scene: Any,
    module: str | Module | type[Module],
    k: int = 16,
    *,
    environment: Environment | None = None,
    size: Size = DEFAULT_SIZE,
    camera: Camera | None = None,
    rays: int = 64,
    accumulate: int = 1,
    seed: int = 0,
    buffer: str = "ambient",
    like: str | Module | type[Module] | None = None,
    **parameters: object,
) -> Relighting:
    """`relight` of a module against the reference that answers its question, in the scene's environment or another.

    The noise of `rays` rays is part of the error. `parameters` are the module's. The truth answers the module's own
    question, or that of `like`.
    """
    scene = load(scene)
    method = find(module, MODULES, **parameters).resolved(scene)

    first = shared_lab().render(scene, method, size=size, camera=camera, seed=seed, accumulate=accumulate)

    def result(light: Environment) -> Buffers:
        return shared_lab().relight(first, environment=light)

    def truth(light: Environment) -> Buffers:
        lit = scene.replace(environment=light)
        return reference(lit, size=size, camera=camera, rays=rays, like=like or method, buffers=(buffer,), seed=seed)

    return relight(result, truth, environment or scene.environment, k, buffer)
