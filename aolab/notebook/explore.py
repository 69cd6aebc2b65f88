"""`aolab.explore`: sliders, menus and a live picture in a notebook."""

from typing import TYPE_CHECKING, Any

from ..extras import missing
from ..gl.texture import Size
from ..gl.thread import handed
from ..loading import load
from ..modules import MODULES, Module, find
from ..scene.camera import Camera

if TYPE_CHECKING:
    from .explorer import Explorer

SIZE = (480, 270)


@handed
def explore(
    scene: Any,
    module: str | Module | type[Module] = "ssao",
    *,
    size: Size = SIZE,
    camera: Camera | None = None,
    modules: list[type[Module]] | None = None,
    accumulate: int = 4,
    rays: int = 64,
    **parameters: object,
) -> "Explorer":
    """A widget for notebooks that renders `scene` while its sliders move.

    The widget has a menu of modules (all built-in ones and `modules`, your own), a control for every parameter, and a
    menu of buffers. Dragging the picture or the arrow keys orbit the camera, the wheel zooms, a double click resets
    the camera. A click on a pixel shows its samples (`aolab.microscope`). A menu shows the truth (`aolab.reference`
    with `rays`) or the error in place of the picture.

    While a control moves, the widget renders fewer pixels; at rest it renders `size` (width, height) and averages
    `accumulate` sample sets. `frame`, `module`, `camera` and `code` are the widget's last frame, its module, its
    camera, and the Python line that renders the same. Raises `ParameterError` if anywidget is not installed, and
    the errors of `aolab.load`; later errors are shown in the widget.
    """
    try:
        from .explorer import Explorer
    except ImportError as error:
        raise missing("notebook", error) from error
    known = {**MODULES, **{one.name or one.__name__: one for one in modules or ()}}
    first = find(module, known, **parameters)
    known.setdefault(first.name or type(first).__name__, type(first))
    return Explorer(load(scene), first, known, size, camera, accumulate, rays)
