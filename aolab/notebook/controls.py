"""The controls of a module's parameters, built from their statement: a slider, a menu or a box for each."""

from typing import Any, Literal, get_args, get_origin

from ..modules import Module
from ..modules.base import auto_radius
from ..modules.parameters import AUTO, describe, own_first
from ..scene.scene import Scene

LOG_FROM = 20  # a slider whose ends have at least this ratio is logarithmic
AROUND = 10  # a parameter without an upper limit: up to this factor from its default


def controls(module: type[Module], scene: Scene) -> list[dict[str, Any]]:
    """One dictionary for each parameter, those of the class itself first, as JSON for the browser.

    `kind` is "choice" (with `choices`), "bool", "int" or "float" (with `low`, `high`, `log`). `auto`: whether the
    value may be "auto"; its number for this scene is `resolved`. `name`, `default`, `unit`, `description`: as stated.
    """
    resolved = module().resolved(scene)
    return [_control(module, name, getattr(resolved, name), scene) for name in own_first(module)]


def _control(module: type[Module], name: str, resolved: Any, scene: Scene) -> dict[str, Any]:
    field = module.model_fields[name]
    about = describe(module, name)
    result = {
        "name": name,
        "default": field.default,
        "resolved": resolved,
        "unit": about["unit"],
        "description": about["description"],
        "auto": field.default == AUTO,
    }
    if get_origin(field.annotation) is Literal:
        return {**result, "kind": "choice", "choices": list(get_args(field.annotation))}
    if isinstance(resolved, bool):
        return {**result, "kind": "bool"}
    if isinstance(resolved, str):
        return {**result, "kind": "text"}
    kind = "int" if isinstance(resolved, int) else "float"
    low, high = _range(module, name, float(resolved), scene)
    return {**result, "kind": kind, "low": low, "high": high, "log": low > 0 and high / low >= LOG_FROM}


def _range(module: type[Module], name: str, value: float, scene: Scene) -> tuple[float, float]:
    """The ends of a slider: the stated limits where they exist, else values around the default."""
    schema = module.model_json_schema()["properties"][name]
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
