"""The question that a module answers: the quantity that its estimate approximates, apart from all errors."""

from dataclasses import dataclass, replace
from math import inf
from typing import Literal, Self

from ..errors import ParameterError, suggestion
from ..maths.fading import CURVES, Fading


@dataclass(frozen=True)
class Question:
    """The quantity to be computed. A module states it with `Module.question`; `aolab.reference` answers it by rays.

    - `radius` (scene units; None is unlimited): occluders farther away do not count;
    - `falloff`: how an occluder's influence fades within the radius, for visibility and all that it weights. A number
      in [0, 1] is the modules' smoothstep over the outer share of the radius; a name is a curve of
      `aolab.maths.fading.openness`; a tuple is a curve's values at equal steps from 0 to the radius;
    - `measure`: the same for `obscurance` and `transfer`, μ of the paper; `sigma` (1/radius) is of `exponential` alone;
    - `spread` in (0, 1]: the half-angle of the cone of directions around the normal, in right angles. Each integral is
      the cosine-weighted mean over the cone, so that an open point has the visibility 1;
    - `bounces`: the greatest number of reflections in `transfer_multibounce`;
    - `limited_senders`: the environment's light on what blocks is limited by `radius` and `falloff`, as in modules,
      where each sender is a pixel with its own visibility. Without it, senders receive the physical light;
    - `blocked_senders`: surfaces block the light that other surfaces send. Without it, each ray collects the light of
      all surfaces along it, as a gather from reflective shadow maps does;
    - `normals`: the hemisphere's axis, the normal that normal and height maps bend (`shading`), or the vertices' own
      (`geometric`).

    Raises `ParameterError` for a value out of its range.
    """

    radius: float | None = None
    falloff: Fading = 0.0
    measure: Fading = "sqrt"
    sigma: float = 1.0
    spread: float = 1.0
    bounces: int = 8
    limited_senders: bool = False
    blocked_senders: bool = True
    normals: Literal["shading", "geometric"] = "shading"

    def __post_init__(self) -> None:
        if self.radius is not None and not (isinstance(self.radius, (int, float)) and self.radius > 0):
            raise ParameterError(f"radius = {self.radius!r} is not a length above 0 (None is unlimited)")
        for name in ("falloff", "measure"):
            if isinstance(getattr(self, name), list):  # as JSON has tuples
                object.__setattr__(self, name, tuple(getattr(self, name)))
            self._check_fading(name, getattr(self, name))
        if not 0 < self.sigma < inf:
            raise ParameterError(f"sigma = {self.sigma!r} is not a number above 0")
        if not 0 < self.spread <= 1:
            raise ParameterError(f"spread = {self.spread!r} is outside (0, 1]")
        if not isinstance(self.bounces, int) or self.bounces < 0:
            raise ParameterError(f"bounces = {self.bounces!r} is not a whole number from 0 on")
        if self.normals not in ("shading", "geometric"):
            raise ParameterError(f"normals = {self.normals!r} is not one of: shading, geometric")

    def _check_fading(self, name: str, fading: Fading) -> None:
        if isinstance(fading, str):
            if fading not in CURVES:
                raise ParameterError(f"{name} = {fading!r} is unknown{suggestion(fading, CURVES)}")
        elif isinstance(fading, tuple):
            grows = len(fading) > 1 and fading[0] == 0 and fading[-1] == 1 and list(fading) == sorted(fading)
            if not grows:
                raise ParameterError(f"{name} = {fading!r:.80} is not a list of numbers that grow from 0 to 1")
        elif not 0 <= fading <= 1:
            raise ParameterError(f"{name} = {fading!r} is outside [0, 1]")

    @property
    def reach(self) -> float:
        """The radius, infinite for None."""
        return inf if self.radius is None else float(self.radius)

    def replace(self, **changes: object) -> Self:
        """The same question with some fields changed. Raises `ParameterError`."""
        known = self.__dataclass_fields__
        for name in changes:
            if name not in known:
                raise ParameterError(f"a question has no '{name}'{suggestion(name, known)}")
        return replace(self, **changes)  # type: ignore[arg-type]
