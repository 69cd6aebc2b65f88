"""`aolab compare`."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

from . import completion, options

if TYPE_CHECKING:
    from ..measures.turning_light import Relighting
    from ..modules import Module
    from ..studies.ranking import Ranking


def compare(
    scene: Annotated[
        str, Argument(metavar="SCENE", help="A scene by name, or a model file.", autocompletion=completion.scenes)
    ],
    modules: Annotated[
        str | None, Option(metavar="A,B", help="The modules, as in 'none,ssao?steps=4'. Default: all.")
    ] = None,
    size: options.PixelSize = "480x270",
    rays: options.Rays = 256,
    radius: options.Radius = None,
    buffer: Annotated[
        str | None, Option(metavar="NAME", help="The buffer that is compared. Default: by the modules' claims.")
    ] = None,
    output: Annotated[
        Path | None, Option("-o", "--output", metavar="FILE.png", help="Write a sheet of pictures, a row a module.")
    ] = None,
    relight: Annotated[
        int | None,
        Option(metavar="K", min=1, help="Compare ambient light instead, under K rotations of the environment."),
    ] = None,
    flip: Annotated[bool, Option("--flip/--no-flip", help="Measure FLIP, the slowest of the measures.")] = True,
    as_json: options.Json = False,
) -> None:
    """Compare modules with the ray-traced truth.

    Prints a line for each module, the least error first. The time grows with pixels, rays and modules, and with K
    rotations; a bar shows the time that is left.
    """
    from ..errors import ParameterError
    from ..modules import MODULES, find
    from . import text

    chosen = [find(name, MODULES) for name in text.listed(modules) or MODULES]
    if relight is not None:
        if output is not None or buffer is not None:
            raise ParameterError("--relight prints errors of ambient light: it takes no -o and no --buffer")
        found = _relit(scene, chosen, text.size(size), rays, radius, relight)
        print(_relit_json(found) if as_json else _relit_table(found, relight))
        return
    entries = _compared(scene, chosen, text.size(size), rays, radius, buffer, output, flip)
    print(json.dumps([one.to_dict() for one in entries], indent=2, allow_nan=False) if as_json else entries)


def _compared(
    scene: str,
    modules: "list[Module]",
    size: tuple[int, int],
    rays: int,
    radius: float | None,
    buffer: str | None,
    output: Path | None,
    flip: bool,
) -> "Ranking":
    from ..extras import need
    from ..output import replacing
    from ..studies.ranking import compare_modules, sheet
    from .files import check_picture

    if output is not None:
        check_picture(output)
        need("pictures", ", or leave out -o")
    entries = compare_modules(scene, modules, size=size, rays=rays, radius=radius, buffer=buffer, flip=flip)
    if output is not None:
        with replacing(output) as file:
            sheet(entries).save(file, "PNG")
    return entries


def _relit(
    scene: str, modules: "list[Module]", size: tuple[int, int], rays: int, radius: float | None, turns: int
) -> "dict[str, Relighting]":
    """{module: errors}, the least error first."""
    from ..loading import load
    from ..measures.turning_light import relighting_error
    from ..progress import progress_bar
    from ..studies.ranking import label, with_their_truth

    loaded = load(scene)
    pairs = with_their_truth(loaded, modules, radius)
    found = {}
    with progress_bar("modules", len(pairs), "module") as bar:
        for module, like in pairs:
            found[label(module, loaded)] = relighting_error(loaded, module, turns, size=size, rays=rays, like=like)
            bar.update()
    return dict(sorted(found.items(), key=lambda item: item[1].rmse))


def _relit_json(found: "dict[str, Relighting]") -> str:
    return json.dumps([{"module": name, **json.loads(one.to_json())} for name, one in found.items()], indent=2)


def _relit_table(found: "dict[str, Relighting]", turns: int) -> str:
    import numpy as np

    from ..table import table

    rows = []
    for name, one in found.items():
        worst = one.measures[one.worst].rmse
        rows.append([name, one.rmse, float(np.mean(one.relative)), worst, f"{one.degrees[one.worst]:.0f}°"])
    columns = {f"ambient, {turns} rotations": "", "rmse": ".4f", "relative": ".3f", "worst": ".4f", "at": ">"}
    return table(columns, rows)
