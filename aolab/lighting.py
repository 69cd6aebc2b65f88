"""From surfaces and visibility to a picture: direct, ambient, and the sum, tone mapped."""

import weakref
from dataclasses import dataclass
from typing import Any, Literal

import moderngl
import numpy as np

from .draw import Buffers, Painter
from .environment import HALF_MAX, Environment
from .gl import context
from .gl.texture import make, refuse_exhaustion
from .lights import DirectionalLight, PointLight, SpotLight
from .modules import Module
from .occluders import Occluders
from .passes import Pass
from .prefiltered import prefiltered
from .scene import Scene
from .shadows import ShadowMaps
from .view import View, matrix_bytes

ToneMap = Literal["filmic", "linear"]

_DIRECT = Pass("direct", "pipeline/direct.frag", {"direct": "RGBA16F"})
_AMBIENT = Pass("ambient", "pipeline/ambient.frag", {"ambient": "RGBA16F"})
_SENDER = Pass("sender", "pipeline/sender.frag", {"sender": "RGBA16F"})
_COMPOSE = Pass("compose", "pipeline/compose.frag", {"radiance": "RGBA16F", "image": "RGBA8"})

_KIND = {DirectionalLight: 0, PointLight: 1, SpotLight: 2}  # as in glsl/lib/light.glsl


class EnvironmentMaps:
    """Environments as textures, kept for as long as the environment lives."""

    def __init__(self) -> None:
        self._textures: weakref.WeakKeyDictionary[Environment, moderngl.Texture] = weakref.WeakKeyDictionary()
        self._prefiltered: weakref.WeakKeyDictionary[Environment, tuple[float, moderngl.Texture]] = (
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

    def prefiltered(self, environment: Environment, solid_angle: float) -> moderngl.Texture:
        """An octahedral map, RGBA float, blurred to `solid_angle` steradians; the last blur asked for is kept."""
        kept = self._prefiltered.get(environment)
        if kept is None or kept[0] != solid_angle:
            pixels = prefiltered(environment, solid_angle)
            padded = np.concatenate([pixels, np.ones_like(pixels[..., :1])], axis=-1)
            kept = self._prefiltered[environment] = solid_angle, make(pixels.shape[1::-1], "RGBA32F", padded.tobytes())
        return kept[1]


@dataclass(frozen=True)
class Display:
    """How radiance becomes an image: `exposure` multiplies it; `tone_map` is filmic, or linear (clipped at 1)."""

    exposure: float = 1.0
    tone_map: ToneMap = "filmic"


def light(
    painter: Painter,
    buffers: Buffers,
    scene: Scene,
    view: View,
    shadows: ShadowMaps,
    module: Module,
    occluders: Occluders,
) -> Buffers:
    """`direct` and `ambient` radiance; a module that gives `irradiance` has it reflected, in place of the SH's."""
    lit = _direct(painter, buffers, scene, view, shadows, module, occluders)
    if "irradiance" in buffers:
        return lit | reflect(painter, buffers, "irradiance", "ambient", view)
    return lit | _ambient(painter, buffers, scene, view)


def _direct(
    painter: Painter,
    buffers: Buffers,
    scene: Scene,
    view: View,
    shadows: ShadowMaps,
    module: Module | None = None,
    occluders: Occluders | None = None,
) -> Buffers:
    """`direct`: the lights through their shadow maps and, if the module has `light_steps`, past what is on screen."""
    count = len(scene.lights)
    values: dict[str, Any] = {"light_steps": 0, "radius": 0.0, "bias": 0.0, "thickness": 0.0}
    if module is not None:
        values |= module.model_dump()
    constants = {
        **{key: value for key, value in values.items() if isinstance(value, int)},
        "lights": count,
        "light_slots": max(1, count),
        "shadow_slots": len(shadows.matrices),
    }
    if not occluders or not values["light_steps"]:
        occluders = Occluders("depth")  # the shader asks nothing of it
    inputs = {**buffers, **occluders.inputs, "shadow_atlas": shadows.atlas}
    uniforms = {**view.uniforms, **_light_uniforms(scene, shadows), **values, **occluders.uniforms}
    aliases = {"occluders.glsl": f"occluders/{occluders.kind}.glsl"}
    return painter.run(_DIRECT, inputs, uniforms, view.size, constants, aliases)


def _ambient(painter: Painter, buffers: Buffers, scene: Scene, view: View) -> Buffers:
    assert scene.environment is not None  # Scene fills it in
    coefficients = np.asarray(scene.environment.irradiance_sh, np.float32).tobytes()
    uniforms = {**view.uniforms, "irradiance_sh": coefficients}
    return painter.run(_AMBIENT, buffers, uniforms, view.size, {"occluded": "visibility" in buffers})


def senders(
    painter: Painter, buffers: Buffers, scene: Scene, view: View, shadows: ShadowMaps, occluders: Occluders
) -> Buffers:
    """`sender`: what leaves each surface before any bounce, direct + ambient light; hidden ones join the occluders.

    The occlusion of hidden surfaces was not estimated: the environment reaches them unhindered.
    """
    for suffix, hidden in occluders.hidden.items():
        lit = _direct(painter, hidden.surfaces, scene, hidden.view, shadows)
        lit |= _ambient(painter, hidden.surfaces, scene, hidden.view)
        sent = painter.run(_SENDER, lit, hidden.view.uniforms, hidden.view.size)
        occluders.inputs[f"sender{suffix}"] = sent["sender"]
    return painter.run(_SENDER, buffers, view.uniforms, view.size)


def reflect(painter: Painter, buffers: Buffers, irradiance: str, radiance: str, view: View) -> Buffers:
    """The buffer `irradiance`, reflected diffusely, as `radiance`."""
    step = Pass(radiance, "pipeline/reflect.frag", {radiance: "RGBA16F"})
    return painter.run(step, {**buffers, "source": buffers[irradiance]}, view.uniforms, view.size)


def compose(
    painter: Painter, buffers: Buffers, maps: EnvironmentMaps, scene: Scene, view: View, display: Display
) -> Buffers:
    """`radiance` (the sum, over the environment) and `image` (tone mapped sRGB)."""
    assert scene.environment is not None
    inputs = {"indirect": buffers["ambient"], **buffers, "environment": maps.of(scene.environment)}
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
