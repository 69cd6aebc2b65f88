"""From surfaces and an estimate to a picture: direct and ambient light, a bounce, and the sum, tone mapped."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import moderngl
import numpy as np

from ..gl.bindings import Bindings
from ..modules.buffers import LIT
from ..modules.estimate import Estimate
from ..modules.passes import TERMS, Pass, reflect
from ..modules.virtual_lights import VirtualLights
from ..scene.environment import Environment
from ..scene.lights import DirectionalLight, PointLight, SpotLight
from ..scene.scene import Scene
from ..scene.view import View
from .estimate import estimate, steps
from .pass_runner import Buffers, PassRunner
from .plan import Plan
from .reflective import ReflectiveMaps
from .shadows import ShadowMaps
from .state import SurfaceState
from .surfaces import as_bindings
from .virtual_lights import VirtualLightMaps, irradiance

ToneMap = Literal["filmic", "linear"]

_COMPOSE = Pass("compose", "pipeline/compose.frag", {name: LIT[name].format for name in ("radiance", "image")})

_IMAGE = Pass("image", "pipeline/image.frag", {"image": LIT["image"].format})
_SKY = Pass("image", "pipeline/sky.frag", _IMAGE.outputs)

_KIND = {DirectionalLight: 0, PointLight: 1, SpotLight: 2}  # as in glsl/lib/light.glsl


@dataclass(frozen=True)
class Display:
    """How radiance becomes an image: `exposure` multiplies it; `tone_map` is filmic, or linear (clipped at 1)."""

    exposure: float = 1.0
    tone_map: ToneMap = "filmic"


@dataclass(frozen=True, eq=False)
class Lights:
    """All that shines on a scene: its lamps with their shadow maps, its environment, and `tables` made of that.

    `reflective` are the lamps' reflective shadow maps, for modules that sample them, and `virtual` the virtual lights
    of each such step, by its name.
    """

    lamps: Bindings
    sky: Environment
    tables: Buffers
    reflective: ReflectiveMaps | None = None
    virtual: Mapping[str, VirtualLightMaps] = field(default_factory=dict)

    def seen_from(self, view: View) -> Sequence[Bindings]:
        """The lights, and the environment in world space and in the view's."""
        radiance = view.sh_from_world @ self.sky.radiance_sh
        environment = {
            "irradiance_sh": self.sky.irradiance_sh.astype(np.float32).tobytes(),
            "view_environment_sh": np.ascontiguousarray(radiance.T, np.float32).tobytes(),
        }
        reflected = [self.reflective.bindings] if self.reflective else []
        clamps = [maps.clamp for maps in self.virtual.values()]
        return [self.lamps, Bindings("the environment", self.tables, environment), *reflected, *clamps]


@dataclass(frozen=True, eq=False)
class Lit:
    """All that has lit a frame: its lights; and its surfaces, whose occluders send light if a bounce was computed.

    `scaled`: the same surfaces at other scales than the module's, for those who look at the passes there.
    """

    lights: Lights
    sending: SurfaceState
    scaled: dict[float, SurfaceState] = field(default_factory=dict)

    def at_scale(self, scale: float) -> SurfaceState:
        """The surfaces at a scale, made at the first call. The textures live as long as the frame."""
        if scale not in self.scaled:
            self.scaled[scale] = self.sending.at_scale(scale)
        return self.scaled[scale]


def lamps(scene: Scene, shadows: ShadowMaps) -> Bindings:
    """The scene's lights, with their shadow maps, as glsl/lib/lights.glsl reads them."""
    count = len(scene.lights)
    slots = max(1, count)  # GLSL has no empty array
    kind, tile = np.zeros(slots, np.int32), np.full(slots, -1, np.int32)
    position, direction, color = (np.zeros((slots, 3), np.float32) for _ in range(3))
    spot_cos = np.zeros((slots, 2), np.float32)
    for i, one in enumerate(scene.lights):
        kind[i], tile[i] = _KIND[type(one)], shadows.first_tile[i]
        color[i] = one.irradiance if isinstance(one, DirectionalLight) else one.intensity
        if not isinstance(one, DirectionalLight):
            position[i] = one.position - scene.shader_origin
        if not isinstance(one, PointLight):
            direction[i] = np.asarray(one.direction) / np.linalg.norm(one.direction)
        if isinstance(one, SpotLight):
            spot_cos[i] = np.cos(np.radians([one.inner, one.outer]))
    uniforms = {
        "light_kind": kind.tobytes(),
        "light_tile": tile.tobytes(),
        "light_position": position.tobytes(),
        "light_direction": direction.tobytes(),
        "light_color": color.tobytes(),
        "light_spot_cos": spot_cos.tobytes(),
        "tile_from_world": shadows.rows[0, :4].tobytes(),
        "tile_place": shadows.rows[0, 4].tobytes(),
    }
    constants = {
        "lights": count,
        "light_slots": slots,
        "suns_alone": all(isinstance(one, DirectionalLight) for one in scene.lights),
        "one_tile": len(shadows.rows) == 1,
    }
    textures = {"shadow_atlas": shadows.atlas, "shadow_table": shadows.table}
    return Bindings("the lights", textures, uniforms, constants)


def names(plan: Plan) -> list[str]:
    """The buffers of the module's lighting, before they are computed."""
    found = [name for step in plan.lighting for name in _outputs(step)]
    if bounce := plan.bounce:
        found += ["sender", *_outputs(bounce), "indirect"]
    return [*found, *_COMPOSE.outputs]


def _outputs(step: Estimate | Pass) -> list[str]:
    return [*step.outputs, *(f"{name}_raw" for name in step.outputs if isinstance(step, Estimate))]


def light(state: SurfaceState, lights: Lights) -> Buffers:
    """`direct` and `ambient` radiance, and all other outputs of the module's lighting steps."""
    frame, lit = state.frame, {}
    shining = lights.seen_from(frame.view)
    for step in frame.plan.lighting:
        given = [Bindings("the estimate", state.estimate), *shining, Bindings("the lighting", lit)]
        if isinstance(step, Estimate):
            lit |= estimate(state.at_scale(step.scale), step, given)
        elif isinstance(step, VirtualLights):
            known = [as_bindings(state.large), frame.parameters]
            lit |= irradiance(state, step, lights.virtual[step.name], known)
        else:
            known = [as_bindings(state.large), frame.parameters, frame.samples(frame.seeds[0]), *given]
            lit |= steps(frame, [step], [*known, *_included(state, step)])
    return lit


def _included(state: SurfaceState, step: Pass) -> Iterator[Bindings]:
    """The shader text that other parts give, where the pass includes it: each is compiled in, so that others do not."""
    includes = state.frame.runner.programs.declared(step.shader, step.includes).includes
    if "occluders.glsl" in includes:
        yield state.occluders.bindings
    if "openness.glsl" in includes:
        yield Bindings("the openness", includes={"openness.glsl": state.frame.module.openness()})


def bounced(runner: PassRunner, surfaces: Buffers, lit: Buffers, bounce: Buffers, view: View) -> Buffers:
    """`indirect`: the irradiance `bounce`, reflected, and the bounce that the lighting has computed."""
    more = "lit" if "indirect" in lit else ""
    known = {**surfaces, **bounce, **({more: lit["indirect"]} if more else {})}
    return runner.run(reflect("bounce", "indirect", more), [Bindings("the bounce", known)], view.size)


def in_one_pass(plan: Plan) -> bool:
    """Whether `image` draws the module's picture: all lighting steps are terms, which no bounce reads."""
    return plan.bounce is None and all(
        isinstance(step, Pass) and step.shader == TERMS.get(step.name) for step in plan.lighting
    )


def image(
    state: SurfaceState, lights: Lights, environment: moderngl.Texture, display: Display, sky: object = None
) -> Buffers:
    """`image` of a module for which `in_one_pass` is true: one pass over surfaces, one over the background.

    With `sky`, the key of all that the background depends on, it is drawn once, and copied while the key is the same.
    """
    frame = state.frame
    terms = [step for step in frame.plan.lighting if isinstance(step, Pass)]
    shown = _shown(environment, frame.view, display)
    given = [
        as_bindings(state.large),
        Bindings("the estimate", state.estimate),
        frame.parameters,
        *lights.seen_from(frame.view),
        *(Bindings(f"the pass '{one.name}'", constants=one.constants, includes=one.includes) for one in terms),
        *shown,
    ]
    has = {"has_emission": "emission" in state.large}
    includes = {} if any(one.name == "indirect" for one in terms) else {"indirect.glsl": "lighting/no_indirect.glsl"}
    runner, size = frame.runner, frame.view.size
    step = replace(_IMAGE, constants=has, includes=includes)
    if sky is not None:
        behind = runner.kept("sky", sky, lambda: runner.run(_SKY, shown, size))
        return runner.run(step, given, size, where=state.where, elsewhere=behind)
    made = runner.run(step, given, size, where=state.where)
    return runner.run(_SKY, shown, size, targets=made, where=state.where.background)


def _shown(environment: moderngl.Texture, view: View, display: Display) -> Sequence[Bindings]:
    """The values that both ways to the picture read."""
    return (
        Bindings("the environment's map", {"environment": environment}),
        Bindings("the view", uniforms=view.uniforms, constants=view.constants),
        Bindings("the display", {}, {"exposure": display.exposure}, {"filmic_tone": display.tone_map == "filmic"}),
    )


def compose(
    runner: PassRunner, buffers: Buffers, environment: moderngl.Texture, view: View, display: Display
) -> Buffers:
    """`radiance` (the sum, over the environment) and `image` (tone mapped sRGB)."""
    summands = {name: buffers[name] for name in ("viewZ", "direct", "ambient")}
    optional = {name: buffers.get(name, buffers["ambient"]) for name in ("indirect", "emission")}
    given = [
        Bindings("the frame", {**summands, **optional}),
        *_shown(environment, view, display),
    ]
    has = {f"has_{name}": name in buffers for name in optional}
    return runner.run(replace(_COMPOSE, constants=has), given, view.size)
