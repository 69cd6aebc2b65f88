"""The controls of a module's parameters, built from their statement: a slider, a menu or a box for each."""

from collections.abc import Mapping
from typing import Any, Literal, get_args, get_origin

from ..modules import Module
from ..modules.base import auto_radius
from ..modules.parameters import AUTO, Choice, Parameters, describe, own_first
from ..scene.scene import Scene

LOG_FROM = 20  # a slider whose ends have at least this ratio is logarithmic
AROUND = 10  # a parameter without an upper limit: up to this factor from its default


def controls(module: type[Module], scene: Scene) -> list[dict[str, Any]]:
    """One dictionary for each parameter, those of the class itself first, as JSON for the browser.

    `kind` is "choice" (with `choices`), "bool", "int" or "float" (with `low`, `high`, `log`). `auto`: whether the
    value may be "auto"; its number for this scene is `resolved`. `with`: [axis, choice] for a parameter that exists
    only with this occluder kind or filter. `name`, `default`, `unit`, `description`: as stated.
    """
    resolved = module().resolved(scene)
    stated = module.stated()
    return [_control(stated[name], name, getattr(resolved, name, None), scene) for name in own_first(module)]


def of_choices(module: type[Module], values: Mapping[str, Any]) -> dict[str, Any]:
    """The values without those of an occluder kind or a filter that is not chosen."""
    chosen = {axis: values.get(axis, module.model_fields[axis].default) for axis in module.choices}
    stated = module.stated()

    def exists(name: str) -> bool:
        owner = stated.get(name)
        return owner is None or not issubclass(owner, Choice) or chosen[owner.axis] == owner.name

    return {name: value for name, value in values.items() if exists(name)}


def _control(owner: type[Parameters], name: str, resolved: Any, scene: Scene) -> dict[str, Any]:
    field = owner.model_fields[name]
    about = describe(owner, name)
    resolved = field.default if resolved is None else resolved
    if resolved == AUTO and about["unit"] == "scene units":  # no one number: a length to start from
        resolved = auto_radius(scene)
    result = {
        "name": name,
        "default": field.default,
        "resolved": resolved,
        "unit": about["unit"],
        "description": about["description"],
        "auto": field.default == AUTO,
        "with": [owner.axis, owner.name] if issubclass(owner, Choice) else None,
    }
    if get_origin(field.annotation) is Literal:
        return {**result, "kind": "choice", "choices": list(get_args(field.annotation))}
    if isinstance(resolved, bool):
        return {**result, "kind": "bool"}
    if isinstance(resolved, str):
        return {**result, "kind": "text"}
    kind = "int" if isinstance(resolved, int) else "float"
    low, high = _range(owner, name, float(resolved), scene)
    return {**result, "kind": kind, "low": low, "high": high, "log": low > 0 and high / low >= LOG_FROM}


def _range(owner: type[Parameters], name: str, value: float, scene: Scene) -> tuple[float, float]:
    """The ends of a slider: the stated limits where they exist, else values around the default."""
    schema = owner.model_json_schema()["properties"][name]
    bounds: dict[str, float] = {}
    for branch in (schema, *schema.get("anyOf", [])):
        bounds |= {key: branch[key] for key in ("minimum", "exclusiveMinimum", "maximum") if key in branch}
    around = auto_radius(scene) if name == "radius" else abs(value) or 1.0
    high = float(bounds.get("maximum", around * AROUND))
    if "minimum" in bounds:
        return float(bounds["minimum"]), high
    if "exclusiveMinimum" in bounds:
        least = float(bounds["exclusiveMinimum"])
        return least + min(around, high - least) / AROUND, high
    return -high, high
