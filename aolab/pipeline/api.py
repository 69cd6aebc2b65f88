"""The functions of the package's face that need no object of their own."""

from functools import cache
from typing import Any

from ..gl.texture import Size
from ..modules import Module, ModuleName
from ..scene.camera import Camera
from .frame import Frame
from .lab import DEFAULT_SIZE, Lab
from .lighting import ToneMap


@cache
def shared_lab() -> Lab:
    """The lab behind `aolab.render`, made when first needed."""
    return Lab()


def render(
    scene: Any,
    module: ModuleName | str | Module | type[Module] = "ssao",
    *,
    size: Size = DEFAULT_SIZE,
    camera: Camera | None = None,
    seed: int = 0,
    accumulate: int = 1,
    exposure: float = 1.0,
    tone_map: ToneMap = "filmic",
    last: Frame | None = None,
    **parameters: object,
) -> Frame:
    """Render `scene` (anything that `aolab.load` takes) with a module; see `Lab.render`, which this calls.

    >>> aolab.render("boxes", "ssao", size=(640, 360), radius=0.5, directions=16)
    """
    return shared_lab().render(
        scene,
        module,
        camera=camera,
        size=size,
        seed=seed,
        accumulate=accumulate,
        exposure=exposure,
        tone_map=tone_map,
        last=last,
        **parameters,
    )
