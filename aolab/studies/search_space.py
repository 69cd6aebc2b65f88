"""The search space of tuning: parameters and ranges, derived from the declaration of a module."""

from dataclasses import dataclass
from typing import Any, Protocol

from ..errors import ParameterError, suggestion
from ..modules import Module
from ..modules.parameters import label

MEANING = {"radius", "falloff"}  # the truth has them, too: they are the question, not the answer
COST = {"directions", "steps", "scale", "occluders"}  # a greater value is better and slower
SPAN = 30.0  # a positive number is searched within this factor of its value
WIDE = 10.0  # ranges that span more than this factor are searched on a logarithmic scale
DIGITS = 3  # significant digits of a tuned number; the error does not depend on further digits


class Trial(Protocol):
    """The methods of Optuna's trial that are used here."""

    def suggest_float(self, name: str, low: float, high: float, *, log: bool) -> float: ...
    def suggest_int(self, name: str, low: int, high: int, *, log: bool) -> int: ...
    def suggest_categorical(self, name: str, choices: list[Any]) -> Any: ...


@dataclass(frozen=True)
class Axis:
    """The range of a parameter with both ends, or its `choices`. The search begins at `start`."""

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
    """The numbers of the module's own that are neither shared with the truth nor a matter of cost.

    Some of them may have no effect on the measured buffer; `tune` finds out by rendering.
    """
    own = type(module).model_fields.keys() - Module.model_fields.keys() - MEANING - COST
    return [name for name in type(module).model_fields if name in own and _is_searched(module, name)]


def _is_searched(module: Module, name: str) -> bool:
    return _is_number(getattr(module, name)) and "enum" not in _schema(module, name)


def axis(module: Module, name: str) -> Axis:
    """The choices of a parameter, or its range.

    A positive number is searched within a factor of 30 of its value, any other number over its whole range. Raises
    `ParameterError` for a parameter that is unknown, shared with the truth, a matter of cost, or without a range.
    """
    module_name, fields = label(type(module)), type(module).model_fields
    if name not in fields:
        raise ParameterError(f"{module_name} has no parameter '{name}'{suggestion(name, fields)}")
    if name in MEANING:
        raise ParameterError(f"{name} cannot be tuned: the truth has the same {name}; set it, with --set {name}=VALUE")
    if name in COST:
        raise ParameterError(f"{name} cannot be tuned: it trades time for error; set it, with --set {name}=VALUE")
    schema = _schema(module, name)
    start = getattr(module, name)
    if "enum" in schema or schema.get("type") == "boolean":
        return Axis(name, start, choices=tuple(schema.get("enum", (False, True))))
    if not _is_number(start):
        raise ParameterError(f"{module_name}: {name} = {start!r} cannot be tuned: it is neither a number nor a choice")
    low = schema.get("minimum", schema.get("exclusiveMinimum"))
    high = schema.get("maximum", schema.get("exclusiveMaximum"))
    if start > 0:
        low = start / SPAN if low is None else max(low, start / SPAN)
        high = start * SPAN if high is None else min(high, start * SPAN)
    if low is None or high is None:
        raise ParameterError(f"{module_name}: {name} = {start!r} has no range to search; declare its ge and le")
    whole = isinstance(start, int)
    if whole:
        low, high = round(low), round(high)
    return Axis(name, start, low, high, log=low > 0 and high / low > WIDE, whole=whole)


def _schema(module: Module, name: str) -> dict[str, Any]:
    return type(module).model_json_schema()["properties"][name]


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)
