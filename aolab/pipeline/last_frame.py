"""The last frame of an animation, as the passes of the next one read it."""

import moderngl
import numpy as np

from ..errors import ParameterError
from ..gl.bindings import Bindings
from ..scene.view import View, matrix_bytes
from .frame import Frame
from .state import SurfaceState

_OWNER = "the last frame"
NO_LAST = Bindings(
    _OWNER,
    uniforms={"last_from_view": matrix_bytes(np.eye(4)), "last_pixel_from_ray": (1.0, 1.0, 0.0, 0.0)},
    constants={"has_last": False},
)


def last_frame(last: Frame | None, view: View) -> Bindings:
    """The buffers of `last` as textures `last_NAME`, and the way from the view space of `view` to its pixels.

    `has_last` is whether there is a last frame. Raises `ParameterError` for a frame that no lab rendered.
    """
    if last is None:
        return NO_LAST
    if not isinstance(last, Frame) or not isinstance(last.kept, SurfaceState):
        given = f"a frame of {last.info.get('module')}" if isinstance(last, Frame) else f"{last!r:.80}"
        raise ParameterError(f"last: {given} was not rendered by a lab; it has no textures")
    before = last.kept.frame.view
    textures = {f"last_{name}": one for name, one in last.textures.items() if isinstance(one, moderngl.Texture)}
    uniforms = {
        "last_from_view": matrix_bytes(before.camera.view_from_world @ np.linalg.inv(view.camera.view_from_world)),
        "last_pixel_from_ray": before.uniforms["pixel_from_ray"],
    }
    return Bindings(_OWNER, textures, uniforms, {"has_last": True})
