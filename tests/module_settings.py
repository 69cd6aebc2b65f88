"""The settings of a module that a test goes through: other values of a parameter, and other choices beside it."""

import itertools
import typing
from typing import Any

from aolab import Module, ParameterError
from aolab.modules.parameters import Parameters


def alternatives(module: type[Parameters], field: str) -> list[Any]:
    """Other values that the parameter may take: every other choice; for numbers, its bounds and multiples."""
    info = module.model_fields[field]
    choices = [value for kind in kinds(info.annotation) for value in typing.get_args(kind)]
    if set(kinds(info.annotation)) == {bool}:
        choices = [True, False]
    bounds = [
        bound for name in ("ge", "le") for one in info.metadata if (bound := getattr(one, name, None)) is not None
    ]
    numbers: list[Any] = [0.3, 1.7] if isinstance(info.default, int | float) else [0.3, 1.7, 32]
    if isinstance(info.default, int | float):
        numbers = [*bounds, info.default * 2, info.default // 2 if isinstance(info.default, int) else info.default / 2]
    numeric = {int, float} & set(kinds(info.annotation))
    words = ["scene", "wall"] if str in kinds(info.annotation) else []  # names of a scene's objects
    allowed = []
    for value in [*words, *choices, *(numbers if numeric else [])]:
        try:
            if getattr(module(**{field: value}), field) != info.default:
                allowed.append(value)
        except ParameterError:
            continue
    return allowed


def kinds(annotation: Any) -> list[Any]:
    """The plain types and Literals in an annotation."""
    if typing.get_origin(annotation) in (None, typing.Literal):
        return [annotation]
    return [
        kind
        for part in typing.get_args(annotation)
        if isinstance(part, type) or typing.get_args(part)
        for kind in kinds(part)
    ]


def contexts(module: type[Module], field: str) -> list[dict[str, Any]]:
    """Settings under which a parameter may matter: the defaults, another choice of one other parameter, or of two."""
    choices = [
        {other: value}
        for other, info in module.model_fields.items()
        if other != field and (info.annotation is bool or typing.get_origin(info.annotation) is typing.Literal)
        for value in ((False, True) if info.annotation is bool else typing.get_args(info.annotation))
        if value != info.default
    ]
    pairs = [{**one, **two} for one, two in itertools.combinations(choices, 2) if one.keys() != two.keys()]
    return [{}, *choices, *pairs]
