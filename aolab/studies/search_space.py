"""What may be tuned, and how far: derived from a module's own statement of its parameters."""

from dataclasses import dataclass
from typing import Any, Protocol

from ..errors import ParameterError, suggestion
from ..modules import Module
from ..modules.parameters import label

MEANING = {"radius", "falloff"}  # the truth is told them, too: they are the question, not the answer
COST = {"directions", "steps", "scale", "occluders"}  # more of it is always better, and slower
LIGHT = {"bleeding", "distance_clamp", "environment_lod", "light_steps", "light_window"}  # visibility knows none of it
SPAN = 30.0  # a positive number is searched within this factor of where it stands
WIDE = 10.0  # ranges that span more than this factor are searched on a logarithmic scale
DIGITS = 3  # significant ones of a tuned number; more would say nothing


class Trial(Protocol):
    """What Optuna's trial can do."""

    def suggest_float(self, name: str, low: float, high: float, *, log: bool) -> float: ...
    def suggest_int(self, name: str, low: int, high: int, *, log: bool) -> int: ...
    def suggest_categorical(self, name: str, choices: list[Any]) -> Any: ...


@dataclass(frozen=True)
class Axis:
    """One parameter's range, both ends included, or its `choices`; `start` is where the search begins."""

    name: str
    start: Any
    low: float = 0.0
    high: float = 0.0
    log: bool = False
    whole: bool = False
    choices: tuple[Any, ...] = ()

    def suggest(self, trial: Trial) -> Any:
        """A value to try."""
        if self.choices:
            return trial.suggest_categorical(self.name, list(self.choices))
        if self.whole:
            return trial.suggest_int(self.name, int(self.low), int(self.high), log=self.log)
        value = trial.suggest_float(self.name, self.low, self.high, log=self.log)
        return min(max(float(f"{value:.{DIGITS}g}"), self.low), self.high)


def tunable(module: Module) -> list[str]:
    """Numbers of the module's own that say neither what is asked nor what it may cost, and are of visibility."""
    own = type(module).model_fields.keys() - Module.model_fields.keys() - MEANING - COST - LIGHT
    return [name for name in type(module).model_fields if name in own and _is_number(getattr(module, name))]


def axis(module: Module, name: str) -> Axis:
    """The range of a parameter: choices as they are, numbers from their bounds and from where they stand.

    A positive number is searched within a factor of 30 of its value, any other over its whole range. Raises
    `ParameterError` for a parameter that is unknown, that is no unknown of the problem, or that has no range.
    """
    module_name, fields = label(type(module)), type(module).model_fields
    if name not in fields:
        raise ParameterError(f"{module_name} has no parameter '{name}'{suggestion(name, fields)}")
    if name in MEANING:
        raise ParameterError(f"{name} is not to be tuned: the truth has the same one; set it, with --set {name}=VALUE")
    if name in COST:
        raise ParameterError(f"{name} is not to be tuned: it trades time for error; set it, with --set {name}=VALUE")
    schema = type(module).model_json_schema()["properties"][name]
    start = getattr(module, name)
    if "enum" in schema or schema.get("type") == "boolean":
        return Axis(name, start, choices=tuple(schema.get("enum", (False, True))))
    if not _is_number(start):
        raise ParameterError(
            f"{module_name}: {name} = {start!r} is neither a number nor one of a few: nothing to search"
        )
    low = schema.get("minimum", schema.get("exclusiveMinimum"))
    high = schema.get("maximum", schema.get("exclusiveMaximum"))
    if start > 0:
        low = start / SPAN if low is None else max(low, start / SPAN)
        high = start * SPAN if high is None else min(high, start * SPAN)
    if low is None or high is None:
        raise ParameterError(f"{module_name}: {name} has no range to search from {start!r}; state its ge and le")
    whole = isinstance(start, int)
    if whole:
        low, high = round(low), round(high)
    return Axis(name, start, low, high, log=low > 0 and high / low > WIDE, whole=whole)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)
