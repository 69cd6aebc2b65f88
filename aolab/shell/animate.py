"""`aolab animate`."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from . import completion, options


def animate(
    scene: Annotated[
        str, Argument(metavar="SCENE", help="A scene's name or a model file.", autocompletion=completion.scenes)
    ],
    module: options.Module = None,
    set_: options.Set = None,
    orbit: Annotated[bool, Option("--orbit", help="Turn the camera once around its target.")] = False,
    path: Annotated[Path | None, Option(metavar="FILE.json", help="A list of cameras: eye, target, up, fov.")] = None,
    vary: Annotated[
        list[str] | None, Option(metavar="NAME=FIRST:LAST", help="A parameter of scene or module that changes.")
    ] = None,
    beside: Annotated[
        str | None,
        Option(metavar="NAME", help="A second module, for the right half.", autocompletion=completion.modules),
    ] = None,
    buffer: Annotated[str, Option(help="The buffer that the film shows.")] = "image",
    size: options.PixelSize = "640x360",
    seconds: Annotated[float, Option(help="The length of the film.")] = 4.0,
    fps: Annotated[int, Option(help="Frames a second.")] = 25,
    seed: options.Seed = None,
    output: Annotated[
        Path, Option("-o", "--output", metavar="FILE", help="film.mp4, .webp, .gif, or DIR/%04d.png.")
    ] = Path("film.webp"),
) -> None:
    """Render a film of a scene.

    The camera turns (--orbit) or follows a path (--path), and parameters change (--vary); these combine.
    """
    from ..modules import MODULES, find
    from ..studies.film import animate as film
    from ..studies.film import parse_range, read_path
    from .text import settings
    from .text import size as parsed

    values = settings(set_)
    out = film(
        scene,
        find(module or "ssao", MODULES, **values),
        out=output,
        orbit=orbit,
        path=read_path(path) if path else None,
        vary=dict(parse_range(text) for text in vary or []),
        beside=find(beside, MODULES, **values) if beside else None,
        buffer=buffer,
        size=parsed(size),
        seconds=seconds,
        fps=fps,
        seed=seed or 0,
    )
    print(out)
