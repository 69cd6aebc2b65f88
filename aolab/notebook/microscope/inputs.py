"""The inputs of a shader, as arrays: the twin of the bindings that the pipeline gives to a pass."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import moderngl
import numpy as np

from ...gl.texture import Size, read
from ...gl.thread import handed
from ...modules.base import Module
from ...modules.estimate import Estimate
from ...modules.occluders import Product
from ...modules.occluders.base import OccluderKind
from ...modules.passes import Pass
from ...modules.virtual_lights import VirtualLights
from ...pipeline.frame import Frame
from ...pipeline.lighting import Lit
from ...pipeline.state import SurfaceState
from ...pipeline.surfaces import facing
from ...scene.scene import Scene

F = np.float32
Texture = moderngl.Texture | np.ndarray


@dataclass(frozen=True, eq=False)
class Inputs:
    """The values that the shader of `step` read, by their names in GLSL.

    `inputs["viewZ"]` is the array of a texture, top row first; `uniforms` has constants, too. `size` is that of the
    surfaces that the shader reads, and `scene` has the light of the frame.
    """

    step: Pass
    module: Module
    kind: OccluderKind
    scene: Scene
    size: Size
    textures: Mapping[str, Texture]
    uniforms: Mapping[str, Any]
    seeds: range
    _arrays: dict[str, np.ndarray] = field(default_factory=dict)

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._arrays:
            texture = self.textures[self.step.reads.get(name, name)]
            self._arrays[name] = texture if isinstance(texture, np.ndarray) else handed(read)(texture)
        return self._arrays[name]

    def number(self, name: str) -> np.float32:
        """A uniform as the shader has it."""
        return F(self.uniforms[name])

    def vector(self, name: str) -> np.ndarray:
        """A uniform vector, float32."""
        return np.asarray(self.uniforms[name], F)

    def matrix(self, name: str) -> np.ndarray:
        """A uniform matrix (4, 4), float32."""
        return np.frombuffer(self.uniforms[name], F).reshape(4, 4).T

    def samples(self, name: str, seed: int) -> np.ndarray:
        """A uniform of the sample set of a seed, float32, flat."""
        return np.frombuffer(self.module.samples(seed)[name], F)

    @property
    def orthographic(self) -> bool:
        return bool(self.uniforms["orthographic"])

    @property
    def kinds(self) -> tuple[OccluderKind, ...]:
        """The occluder kinds, those of a product one by one."""
        return _parts(self.kind)


def _parts(kind: OccluderKind) -> tuple[OccluderKind, ...]:
    return (*_parts(kind.first), *_parts(kind.second)) if isinstance(kind, Product) else (kind,)


def inputs(frame: Frame, step: Pass, estimate: Estimate | None, bounces: bool) -> Inputs:
    """The inputs of a frame's pass: of an `estimate`, or of the lighting for None.

    With `bounces`, the pass runs over lit surfaces, where occluders send light.
    """
    lit: Lit | None = frame.lit
    state: SurfaceState = lit.sending if lit and bounces else frame.kept
    if lit and estimate and estimate.scale:
        state = handed(lit.at_scale)(estimate.scale)
    module = state.frame.module
    # the lighting runs at full size, under the shading normals
    view = state.small_view if estimate else state.frame.view
    surfaces = facing(state.small, module.normals) if estimate else state.large
    parameters = state.frame.parameters
    textures: dict[str, Texture] = dict(frame.made)
    uniforms: dict[str, Any] = {**view.uniforms, **view.constants, **parameters.uniforms, **parameters.constants}
    for one in [state.occluders.bindings, *(lit.lights.seen_from(view) if lit else [])]:
        textures |= one.textures
        uniforms |= {**one.uniforms, **one.constants}
    textures |= surfaces
    if lit and isinstance(step, VirtualLights):
        maps = lit.lights.virtual[step.name]
        textures |= {"light_rows": maps.rows, "shadow_atlas": maps.atlas, "shadow_table": maps.table}
        uniforms["light_count"] = maps.count
    assert frame.scene is not None  # a lab rendered the frame
    uniforms |= step.constants
    # the lighting takes the first sample set only, an estimate all of them
    seeds = state.frame.seeds if estimate else state.frame.seeds[:1]
    return Inputs(step, module, state.frame.plan.occluders, frame.scene, view.size, textures, uniforms, seeds)
