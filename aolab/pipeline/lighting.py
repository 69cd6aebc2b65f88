"""From surfaces and visibility to a picture: direct, ambient, and the sum, tone mapped."""

import weakref
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import moderngl
import numpy as np

from ..gl import context
from ..gl.source import Constant
from ..gl.texture import make, refuse_exhaustion
from ..modules import Module
from ..modules.passes import AMBIENT, DIRECT, Pass, reflect
from ..scene.environment import HALF_MAX, Environment
from ..scene.lights import DirectionalLight, PointLight, SpotLight
from ..scene.prefiltered import Table
from ..scene.scene import Scene
from ..scene.view import View, matrix_bytes
from .occluders import Occluders
from .pass_runner import Buffers, Painter
from .shadows import ShadowMaps

ToneMap = Literal["filmic", "linear"]

_SENDER = Pass("sender", "pipeline/sender.frag", {"sender": "RGBA16F"})
_COMPOSE = Pass("compose", "pipeline/compose.frag", {"radiance": "RGBA16F", "image": "RGBA8"})

_KIND = {DirectionalLight: 0, PointLight: 1, SpotLight: 2}  # as in glsl/lib/light.glsl


class EnvironmentMaps:
    """Environments, and what is made of them, as textures, kept for as long as the environment lives."""

    def __init__(self) -> None:
        self._textures: weakref.WeakKeyDictionary[Environment, moderngl.Texture] = weakref.WeakKeyDictionary()
        self._tables: weakref.WeakKeyDictionary[Environment, dict[str, tuple[Table, moderngl.Texture]]] = (
            weakref.WeakKeyDictionary()
        )

    def of(self, environment: Environment) -> moderngl.Texture:
        """RGB, half float, first row up (+y): as glsl/lib/environment.glsl reads it."""
        if environment not in self._textures:
            height, width = environment.radiance.shape[:2]
            data = np.ascontiguousarray(np.minimum(environment.radiance, HALF_MAX), np.float16).tobytes()
            texture = context.get().texture((width, height), 3, data, dtype="f2", alignment=2)
            refuse_exhaustion(f"environment '{environment.name}' of {width}x{height}")
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x, texture.repeat_y = True, False
            self._textures[environment] = texture
        return self._textures[environment]

    def tables(self, environment: Environment, wanted: Mapping[str, Table]) -> Buffers:
        """What a module wants to be made of the environment, RGBA float; the last of each name is kept."""
        known = self._tables.setdefault(environment, {})
        for name, table in wanted.items():
            if name not in known or known[name][0] != table:
                pixels = table(environment)
                padded = np.concatenate([pixels, np.ones_like(pixels[..., :1])], axis=-1)
                texture = make(pixels.shape[1::-1], "RGBA32F", padded.tobytes())
                if table.smooth:
                    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
                known[name] = table, texture
        return {name: known[name][1] for name in wanted}


@dataclass(frozen=True)
class Display:
    """How radiance becomes an image: `exposure` multiplies it; `tone_map` is filmic, or linear (clipped at 1)."""

    exposure: float = 1.0
    tone_map: ToneMap = "filmic"


@dataclass(frozen=True)
class Illumination:
    """What lights a scene: its lights with their shadows, its environment, and `tables` made of that (textures)."""

    scene: Scene
    shadows: ShadowMaps
    tables: Buffers = field(default_factory=dict)

    @property
    def environment(self) -> Environment:
        assert self.scene.environment is not None  # Scene fills it in
        return self.scene.environment

    @cached_property
    def inputs(self) -> Buffers:
        """Textures that lighting passes may read."""
        return {**self.tables, "shadow_atlas": self.shadows.atlas}

    @cached_property
    def constants(self) -> dict[str, Constant]:
        """How many lights and shadow tiles there are; an array has at least one slot, since GLSL has no empty one."""
        count = len(self.scene.lights)
        return {"lights": count, "light_slots": max(1, count), "shadow_slots": len(self.shadows.matrices)}

    @cached_property
    def _uniforms(self) -> dict[str, object]:
        return {
            **_light_uniforms(self.scene, self.shadows),
            "irradiance_sh": self.environment.irradiance_sh.astype(np.float32).tobytes(),
        }

    def uniforms(self, view: View) -> dict[str, object]:
        """The lights; the coefficients of the environment's irradiance and, in view space, of its radiance."""
        seen = view.sh_from_world @ self.environment.radiance_sh
        return {**self._uniforms, "view_environment_sh": np.ascontiguousarray(seen.T, np.float32).tobytes()}


def light(
    painter: Painter, buffers: Buffers, lit_by: Illumination, view: View, module: Module, occluders: Occluders
) -> Buffers:
    """`direct` and `ambient` radiance, and what else the module's lighting passes give."""
    lit: Buffers = {}
    for step in module.lighting():
        lit |= _run(painter, step, buffers, lit_by, view, module, occluders)
    return lit


# for a surface of which no method knows anything: no samples towards the lights
_PLAIN = {"light_steps": 0, "radius": 0.0, "bias": 0.0, "thickness": 0.0}


def _run(
    painter: Painter,
    step: Pass,
    buffers: Buffers,
    lit_by: Illumination,
    view: View,
    module: Module | None = None,
    occluders: Occluders | None = None,
) -> Buffers:
    """One lighting pass. The occluders matter only where samples are taken towards the lights."""
    values, constants = (module.model_dump(), module.constants()) if module else ({}, {})
    if occluders is None or not values.get("light_steps"):
        occluders = Occluders("depth")  # the shader asks nothing of it
    return painter.run(
        step,
        {**buffers, **occluders.inputs, **lit_by.inputs},
        {**_PLAIN, **view.uniforms, **lit_by.uniforms(view), **values, **occluders.uniforms},
        view.size,
        {**_PLAIN, **constants, **lit_by.constants, "occluded": "visibility" in buffers},
        {"occluders.glsl": f"occluders/{occluders.kind}.glsl"},
    )


def senders(painter: Painter, buffers: Buffers, lit_by: Illumination, view: View, occluders: Occluders) -> Buffers:
    """`sender`, what leaves each surface before any bounce, direct + ambient light; and those of hidden surfaces.

    The occlusion of hidden surfaces was not estimated: the environment reaches them unhindered.
    """
    sent: Buffers = {}
    for suffix, hidden in occluders.hidden.items():
        lit = {}
        for step in (DIRECT, AMBIENT):
            lit |= _run(painter, step, hidden.surfaces, lit_by, hidden.view)
        sent[f"sender{suffix}"] = painter.run(_SENDER, lit, hidden.view.uniforms, hidden.view.size)["sender"]
    return {**sent, **painter.run(_SENDER, buffers, view.uniforms, view.size)}


def bounced(painter: Painter, buffers: Buffers, view: View) -> Buffers:
    """`indirect`: the irradiance `bounce`, reflected."""
    return painter.run(reflect("bounce", "indirect"), buffers, view.uniforms, view.size)


def compose(painter: Painter, buffers: Buffers, environment: moderngl.Texture, view: View, display: Display) -> Buffers:
    """`radiance` (the sum, over the environment) and `image` (tone mapped sRGB)."""
    inputs = {"indirect": buffers["ambient"], **buffers, "environment": environment}
    constants = {"has_indirect": "indirect" in buffers, "filmic_tone": display.tone_map == "filmic"}
    return painter.run(_COMPOSE, inputs, {**view.uniforms, "exposure": display.exposure}, view.size, constants)


def _light_uniforms(scene: Scene, shadows: ShadowMaps) -> dict[str, bytes]:
    slots = max(1, len(scene.lights))
    kind, tile = np.zeros(slots, np.int32), np.full(slots, -1, np.int32)
    position, direction, color = (np.zeros((slots, 3), np.float32) for _ in range(3))
    spot_cos = np.zeros((slots, 2), np.float32)
    for i, one in enumerate(scene.lights):
        kind[i], tile[i] = _KIND[type(one)], shadows.first_tile[i]
        color[i] = one.irradiance if isinstance(one, DirectionalLight) else one.intensity
        if not isinstance(one, DirectionalLight):
            position[i] = one.position
        if not isinstance(one, PointLight):
            direction[i] = np.asarray(one.direction) / np.linalg.norm(one.direction)
        if isinstance(one, SpotLight):
            spot_cos[i] = np.cos(np.radians([one.inner, one.outer]))
    return {
        "light_kind": kind.tobytes(),
        "light_tile": tile.tobytes(),
        "light_position": position.tobytes(),
        "light_direction": direction.tobytes(),
        "light_color": color.tobytes(),
        "light_spot_cos": spot_cos.tobytes(),
        "shadow_from_world": b"".join(matrix_bytes(matrix) for matrix in shadows.matrices),
        "shadow_tile": shadows.tiles.astype(np.float32).tobytes(),
    }
