"""Palettes: the albedo of each mesh, for scenes whose meshes have one albedo each."""

import weakref

import moderngl
import numpy as np

from ..gl.bindings import Bindings
from ..gl.texture import make
from ..modules.buffers import SURFACES
from ..modules.passes import TERMS, Pass
from ..scene.scene import Scene
from .asked import sampled
from .doubts import is_own
from .geometry import kinds_of, stored
from .lighting import in_one_pass
from .pass_runner import Buffers
from .state import FrameContext, SurfaceState
from .surfaces import as_bindings

MOST = 2048  # meshes: half floats hold the whole numbers up to here

_FORMAT = SURFACES["albedo"].format
_ALBEDO = Pass("albedo", "pipeline/albedo.frag", {"albedo": _FORMAT}, background={"albedo": 0.0})


def is_enough(frame: FrameContext) -> bool:
    """Whether the number of a pixel's mesh may stand for its albedo, which need not be drawn then.

    Each mesh has one colour; and the albedo is read by terms of the lighting alone, which read the palette too.
    """
    scene, module = frame.scene, frame.module
    kinds = kinds_of(scene)
    if len(scene.meshes) > MOST or kinds["textured"] or kinds["vertex_colored"]:
        return False
    if module.scale < 1 or is_own(module) or not in_one_pass(module):
        return False
    return "albedo" not in sampled(frame, [step for step in module.all_passes() if step.shader not in TERMS.values()])


def albedo(state: SurfaceState) -> Buffers:
    """`albedo` from the palette."""
    view = state.frame.view
    given = [as_bindings(state.large), Bindings("the view", uniforms=view.uniforms, constants=view.constants)]
    return state.frame.runner.run(_ALBEDO, given, view.size, where=state.where)


class Palettes:
    """Textures of palettes, kept for as long as the scene lives."""

    def __init__(self) -> None:
        self._textures: weakref.WeakKeyDictionary[Scene, moderngl.Texture] = weakref.WeakKeyDictionary()

    def of(self, scene: Scene) -> moderngl.Texture:
        """The albedos of the scene's meshes in a row, by number; the same as those that the G-buffer holds."""
        if scene not in self._textures:
            colors = np.ones((len(scene.meshes), 4), np.float16)
            colors[:, :3] = [stored(mesh.material.base_color) for mesh in scene.meshes]
            self._textures[scene] = make((len(colors), 1), _FORMAT, colors.tobytes())
        return self._textures[scene]
