"""`aolab reference`."""

from pathlib import Path
from typing import Annotated

from typer import Option

from . import options


def reference(
    scene: options.Scene = None,
    module: options.Module = None,
    set_: options.Set = None,
    size: options.Size = None,
    seed: options.Seed = None,
    eye: options.Eye = None,
    target: options.Target = None,
    up: options.Up = None,
    up_axis: options.UpAxis = None,
    fov: options.Fov = None,
    like: options.Like = None,
    output: options.Output = Path("reference.png"),
    buffer: options.Buffer = None,
    buffers: options.Buffers = None,
    stats: options.Stats = None,
    rays: Annotated[int | None, Option(metavar="N", help="Rays for each pixel, an even number. Default: 256.")] = None,
    radius: options.Radius = None,
) -> None:
    """Ray-trace a scene, the truth for a module.

    Occlusion has the radius and the falloff of the module, so that the result can be compared with the module's.
    """
    from .files import Files
    from .job import asked
    from .text import settings

    job = asked(scene, like)
    job.turn_up(up_axis)
    job.use(module, settings(set_))
    job.move(eye, target, up, fov)
    job.choose(size=size, seed=seed, buffer=buffer)
    files = Files(output, job.buffer, buffers, stats)
    files.check()
    print(files.write(job.trace(rays, radius)))
