"""`aolab tune`."""

import json
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from . import completion, options


def tune(
    module: Annotated[
        str,
        Argument(
            metavar="MODULE",
            help="The method: a name of `aolab modules`, or FILE.py:CLASS.",
            autocompletion=completion.modules,
        ),
    ],
    parameters: Annotated[
        str | None, Option(metavar="A,B", help="The parameters to fit. Default: all numbers of the module's own.")
    ] = None,
    set_: options.Set = None,
    scenes: Annotated[
        str | None, Option(metavar="A,B", help="The scenes to fit to. Default: boxes,colonnade,toasters.")
    ] = None,
    test_scenes: Annotated[
        str | None, Option(metavar="A,B", help="Other scenes for the test. Default: cornell,atrium,skyscrapers.")
    ] = None,
    views: Annotated[
        int, Option(metavar="N", help="Cameras for each scene: the scene's own, and others beside it.")
    ] = 3,
    trials: Annotated[
        int | None, Option(metavar="N", help="Settings to try. Default: 25 for each parameter.", show_default=False)
    ] = None,
    size: options.PixelSize = "320x180",
    rays: options.Rays = 128,
    seed: Annotated[int, Option(metavar="N", help="Seed of the search.")] = 0,
    output: Annotated[
        Path | None, Option("-o", "--output", metavar="FILE.json", help="Write the fitted parameters.")
    ] = None,
    as_json: options.Json = False,
) -> None:
    """Fit a module's parameters to the ray-traced truth.

    The parameters are fitted on some scenes and tested on other scenes. The time grows with trials, views and pixels;
    a bar shows the time that is left.
    """
    from ..modules import MODULES, find
    from ..output import check_writable
    from ..studies.tune import tune as fit
    from . import text
    from .files import write_json

    if output is not None:
        check_writable(output)
    result = fit(
        find(module, MODULES, **text.settings(set_)),
        text.listed(parameters),
        scenes=text.listed(scenes),
        test_scenes=text.listed(test_scenes),
        views=views,
        trials=trials,
        size=text.size(size),
        rays=rays,
        seed=seed,
    )
    if output is not None:
        write_json(output, result.preset)
    print(json.dumps(result.to_dict(), indent=2) if as_json else result.table())
