"""`aolab modules`."""

import json
from typing import TYPE_CHECKING, Annotated

from typer import Argument

from . import completion, options

if TYPE_CHECKING:
    from ..modules import Module


def modules(
    name: Annotated[
        str | None,
        Argument(
            metavar="NAME",
            help="A module, or FILE.py:CLASS: list its parameters.",
            show_default=False,
            autocompletion=completion.modules,
        ),
    ] = None,
    as_json: options.Json = False,
) -> None:
    """List the modules, or the parameters of a module."""
    from ..modules import MODULES, find
    from ..table import table

    chosen = MODULES if name is None else {name: type(find(name, MODULES))}
    if as_json:
        print(json.dumps({key: module.model_json_schema() for key, module in chosen.items()}, indent=2))
    elif name is None:
        print(table({"module": "", "method": ""}, [(key, module.title) for key, module in chosen.items()]))
        print("\n`aolab modules NAME` lists the parameters of a module.")
    else:
        print(described(chosen[name]))


def described(module: "type[Module]") -> str:
    """Title, paper and every parameter: the module's own, those of all modules, those of occluder kinds and filters."""
    from ..modules import Module
    from ..modules.parameters import describe, label

    parts: dict[str, list[str]] = {"parameters": [], "parameters of all modules": []}
    for name in module.stated():
        about = describe(module, name)
        if about["with"]:
            part = f"parameters with {about['with']}"
        else:
            part = "parameters of all modules" if name in Module.model_fields else "parameters"
        facts = ", ".join(filter(None, (about["type"], about["range"], about["unit"])))
        lines = parts.setdefault(part, [])
        lines += [f"  {name} = {about['default']}  ({facts})", f"      {about['description']}"]
    found = [f"{label(module)}: {module.title}", *([f"  {module.paper}"] if module.paper else [])]
    for part, lines in parts.items():
        found += ["", f"{part}:" if lines else f"{part}: none", *lines]
    return "\n".join(found)
