"""Modules with a part of another one: `ssao+rsm` is SSAO with the bounce of reflective shadow maps."""

from collections.abc import Callable, Sequence
from functools import lru_cache

from ..errors import ParameterError, suggestion
from .base import Module
from .rsm import PAPER, with_rsm
from .virtual_lights import DEBEVEC, KELLER, with_environment_vpl, with_instant_radiosity

# the class with the part, and the part's paper
PARTS: dict[str, tuple[Callable[[type[Module]], type[Module]], str]] = {
    "rsm": (with_rsm, PAPER),
    "environment_vpl": (with_environment_vpl, DEBEVEC),
    "instant_radiosity": (with_instant_radiosity, KELLER),
}


def combined(name: str, module: type[Module], parts: Sequence[str]) -> type[Module]:
    """The module `name`, as `ssao+rsm`: the class `module` with `parts`, and with the parameters of all of them.

    Raises `ParameterError` for an unknown part, or a part that is there twice.
    """
    for part in parts:
        if part not in PARTS:
            raise ParameterError(f"module '{name}': '{part}' is no part of a module{suggestion(part, PARTS)}")
        if parts.count(part) > 1 or part in module.parts:
            raise ParameterError(f"module '{name}': the part '{part}' is there twice")
    return _combined(name, module, tuple(parts))  # pyright: ignore[reportArgumentType]


@lru_cache(maxsize=64)
def _combined(name: str, module: type[Module], parts: tuple[str, ...]) -> type[Module]:
    whole = module
    for part in parts:
        whole = PARTS[part][0](whole)
    facts = {
        "name": name,
        "title": " + ".join([module.title, *parts]),
        "paper": "; ".join([module.paper, *(PARTS[part][1] for part in parts)]),
    }
    return type(module.__name__, (whole,), {"__module__": module.__module__, "__doc__": module.__doc__, **facts})
