"""Palettes: the albedo of each mesh that has one albedo. That of other meshes, with patterns, is drawn."""

import weakref
from collections.abc import Mapping

import moderngl
import numpy as np

from ..gl.bindings import Bindings
from ..gl.texture import Depth, make
from ..modules.buffers import SURFACES
from ..modules.passes import Pass
from ..scene.scene import Scene
from .doubts import is_own
from .geometry import stored
from .lighting import in_one_pass
from .pass_runner import Buffers
from .state import FrameContext, SurfaceState
from .surfaces import as_bindings

MOST = 2048  # meshes: half floats hold the whole numbers up to here

_FORMAT = SURFACES["albedo"].format
_ALBEDO = Pass("albedo", "pipeline/albedo.frag", {"albedo": _FORMAT}, background={"albedo": 0.0})


def is_enough(frame: FrameContext) -> bool:
    """Whether the number of a pixel's mesh may stand for its albedo, which need not be drawn then.

    Some mesh has one albedo; and the albedo is read by terms of the lighting alone, which read the palette too.
    """
    scene, module = frame.scene, frame.module
    if len(scene.meshes) > MOST or not scene.plain:
        return False
    if is_own(module) or not in_one_pass(frame.plan):
        return False
    return "albedo" not in frame.plan.sampled_unlit


def albedo(state: SurfaceState) -> Buffers:
    """`albedo` from the palette and the patterns."""
    view = state.frame.view
    given = [as_bindings(state.large), Bindings("the view", uniforms=view.uniforms, constants=view.constants)]
    return state.frame.runner.run(_ALBEDO, given, view.size, where=state.where)


class Palettes:
    """Textures of palettes, kept for as long as the scene lives."""

    def __init__(self) -> None:
        self._textures: weakref.WeakKeyDictionary[Scene, moderngl.Texture] = weakref.WeakKeyDictionary()

    def surfaces(self, frame: FrameContext, formats: Mapping[str, str], depth: Depth) -> Buffers:
        """The surface buffers with `palette` in the place of `albedo`, and `patterns` for meshes with patterns."""
        scene, views, draw = frame.scene, [frame.view], frame.rasterizer.surfaces
        without = {name: format for name, format in formats.items() if name != "albedo"}
        buffers = draw(views, formats=without, depth=depth, only=scene.plain)
        if scene.patterned:
            buffers = draw(views, formats=formats, depth=depth, only=scene.patterned, onto=buffers)
            buffers["patterns"] = buffers.pop("albedo")
        return buffers | {"palette": self._of(scene)}

    def _of(self, scene: Scene) -> moderngl.Texture:
        """A row of the meshes' albedos by number, as the G-buffer stores them; 0 for a mesh with patterns."""
        if scene not in self._textures:
            colors = np.zeros((len(scene.meshes), 4), np.float16)
            for color, mesh in zip(colors, scene.meshes, strict=True):
                if mesh in scene.plain:
                    color[:] = *stored(mesh.material.base_color), 1
            self._textures[scene] = make((len(colors), 1), _FORMAT, colors.tobytes())
        return self._textures[scene]
