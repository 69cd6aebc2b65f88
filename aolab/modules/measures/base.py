"""The interface of a fuzzy measure: how strongly a direction counts as open, by the distance of its first occluder."""

from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ...errors import ParameterError
from ...gl.bindings import Bindings
from ...maths.fading import Fading, inverted
from ..parameters import Choice

STEPS = 128  # of the tables that stand for a measure in the shader and in the reference


class Measure(Choice):
    """A fuzzy measure μ (Umenhoffer, Tóth and Szirmay-Kalos 2009, figure 1). A subclass states its parameters, and:

    `name` (lower case), and `openness(distance)`: μ(d), growing from 0 at distance 0 to 1 at distance 1; distances are
    in radii, arrays of float64. All else follows: the density and the inverse by numbers, tables of `STEPS` steps in
    place of GLSL, and their values for the reference. `shader`, a file under glsl/ or GLSL text, replaces the tables by

    - `float measureOpenness(float d)`, `float measureDensity(float d)` and `float measureInverse(float share)`.

    Raises `ParameterError` for an openness that does not grow from 0 to 1.
    """

    axis: ClassVar[str] = "measure"
    shader: ClassVar[str] = "measures/table.glsl"

    def openness(self, distance: np.ndarray) -> np.ndarray:
        """μ(d) (n,) of `distance` (n,), in radii."""
        raise NotImplementedError(f"{self.label()} has no method `openness(distance)`")

    def density(self, distance: np.ndarray) -> np.ndarray:
        """μ'(d) (n,) of `distance` (n,): the share of the samples per radius."""
        table = self._table
        cell = np.minimum(distance * STEPS, STEPS - 1).astype(int)
        return np.where(distance < 1, np.diff(table)[cell] * STEPS, 0.0)

    def inverse(self, share: np.ndarray) -> np.ndarray:
        """μ⁻¹(ξ) (n,), in radii, of `share` (n,) in [0, 1]."""
        return inverted(self.openness, share)

    @cached_property
    def farthest(self) -> float:
        """The distance of the farthest sample, in radii."""
        return float(self.inverse(np.ones(1))[0])

    @property
    def fading(self) -> Fading:
        """The measure as `Question` has it."""
        return tuple(self._table.tolist())

    def bindings(self) -> Bindings:
        """The measure's parameters, its tables and its shader."""
        numbers = self.numbers()
        uniforms: dict[str, Any] = dict(numbers)
        if self.shader == Measure.shader:
            for name, table in (("measure_openness", self._table), ("measure_inverse", self._inverse_table)):
                uniforms[name] = table.astype(np.float32).tobytes()
        uniforms["measure_farthest"] = self.farthest
        return Bindings(self.label(), {}, uniforms, {**numbers, "measure_steps": STEPS}, {"measure.glsl": self.shader})

    @cached_property
    def _inverse_table(self) -> np.ndarray:
        """μ⁻¹ at `STEPS` + 1 shares from 0 to 1."""
        return self.inverse(np.linspace(0, 1, STEPS + 1))

    @cached_property
    def _table(self) -> np.ndarray:
        """μ at `STEPS` + 1 distances from 0 to 1."""
        table = np.asarray(self.openness(np.linspace(0, 1, STEPS + 1)), np.float64)
        ends = table.shape == (STEPS + 1,) and abs(table[0]) < 1e-6 and abs(table[-1] - 1) < 1e-6
        if not ends or not (np.diff(table) >= -1e-9).all():
            shown = f"{table[0]:g} to {table[-1]:g}" if table.shape == (STEPS + 1,) else f"an array {table.shape}"
            raise ParameterError(
                f"{self.label()}: openness(distance) is {shown}; it must grow from 0 at distance 0 to 1 at distance 1"
            )
        return table
