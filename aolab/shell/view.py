"""`aolab view`."""

from dataclasses import replace
from typing import Annotated

from typer import Option

from . import options


def view(
    scene: options.Scene = None,
    module: options.Module = None,
    set_: options.Set = None,
    occluders: options.Occluders = None,
    size: options.PixelSize = "960x540",
    seed: options.Seed = None,
    eye: options.Eye = None,
    target: options.Target = None,
    up: options.Up = None,
    fov: options.Fov = None,
    rays: Annotated[int, Option(metavar="N", help="Rays for each pixel of the truth, an even number.")] = 64,
) -> None:
    """Look at a scene in a window.

    Drag to turn the camera; the wheel brings it nearer. Keys choose module, buffer and truth: h lists them.
    """
    from ..loading import load
    from ..modules import MODULES, find
    from ..notebook.viewer import Viewer
    from ..notebook.window import Window
    from .job import asked
    from .text import settings
    from .text import size as parsed

    job = asked(scene, None)
    job.move(eye, target, up, fov)
    chosen = {} if occluders is None else {"occluders": occluders}
    found = find(module or "ssao", MODULES, **settings(set_), **chosen)
    loaded = load(job.scene)
    assert loaded.camera is not None  # Scene frames itself
    camera = replace(loaded.camera, **job.moved)
    Window(Viewer(loaded, found, parsed(size), camera, seed or 0, rays), f"aolab: {scene}").run()
