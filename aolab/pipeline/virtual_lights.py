"""Virtual lights: chosen, each with a shadow map in one atlas, and added up in batches."""

from dataclasses import dataclass, replace

import moderngl
import numpy as np

from ..gl import context
from ..gl.bindings import Bindings
from ..gl.loops import check_loops
from ..gl.texture import make, read
from ..maths.cells import equal_energy_cells
from ..maths.transforms import look_along, orthographic, perspective
from ..modules.virtual_lights import VirtualLights
from ..scene.environment_lights import LUMINANCE, environment_lights
from ..scene.scene import Scene
from .pass_runner import Buffers
from .rasterizer import Rasterizer
from .reflective import ReflectiveMaps
from .shadows import draw_tiles
from .state import SurfaceState

BATCH = 32  # lights a pass
STEPS_A_LIGHT = 5  # of a shader's loops: the light's, and the four comparisons of its shadow
# a light's irradiance is at most this share of its surface's radiosity; docs/modules/instant_radiosity.md compares four
MOST_OF_RADIOSITY = 1 / 4
# half the opening of a virtual light's shadow map: a diffuse surface sends sin² 75° = 93 % of its light into it; the
# rest, which grazes, has no shadow
TAN_OPENING = float(np.tan(np.radians(75)))


@dataclass(frozen=True)
class VirtualLightMaps:
    """The rows of the lights, (3, count) texels, and their shadow maps: see glsl/virtual_lights.frag.

    `clamp`, of lights on surfaces, has `vpl_bound` for glsl/near_field.frag.
    """

    rows: moderngl.Texture
    atlas: moderngl.Texture
    table: moderngl.Texture
    count: int
    clamp: Bindings


def draw_virtual_lights(
    rasterizer: Rasterizer, step: VirtualLights, reflective: ReflectiveMaps | None, seed: int
) -> VirtualLightMaps:
    """Choose the lights and draw their shadow maps. Raises `ParameterError` for an atlas over the driver's limit."""
    scene = rasterizer.scene
    if step.source == "environment":
        assert scene.environment is not None  # Scene fills it in
        towards, sent = environment_lights(scene.environment, step.count)
        rows = np.stack([towards, np.zeros_like(towards), sent], axis=1)
        far, bounds, clamp = np.ones(len(rows)), np.zeros(len(rows)), {}
    else:
        assert reflective is not None  # the step's `samples` have it drawn
        rows, radiosity = _drawn(reflective.buffers, step.count, seed)
        constant, by_radiance = _bound(step, rows)
        far, bounds = np.zeros(len(rows)), constant + by_radiance * radiosity / np.pi
        clamp = {"vpl_bound": (constant, by_radiance)}
    padded = np.zeros((max(1, len(rows)), 3, 4), np.float32)  # GL has no empty texture
    padded[: len(rows), :, :3], padded[: len(rows), :2, 3] = rows, np.stack([bounds, far], axis=1)
    projections = [_projection(scene, row, is_far) for row, is_far in zip(rows, far, strict=True)]
    atlas, table, _ = draw_tiles(rasterizer, projections, step.resolution if projections else 1, step.slope_bias)
    texels = make((3, len(padded)), "RGBA32F", padded.tobytes())
    return VirtualLightMaps(texels, atlas, table, len(rows), Bindings("the clamp of virtual lights", uniforms=clamp))


def _bound(step: VirtualLights, rows: np.ndarray) -> tuple[float, float]:
    """(a, b): the geometry term of a light is at most a + b L, where its surface sends the luminance L.

    A clamp in scene units is the constant 1/clamp². Without a clamp, `MOST_OF_RADIOSITY` sets b: a light's irradiance
    is Φ/π times its geometry term, and the radiosity of its surface is πL.
    """
    if step.clamp is not None:
        return 1 / step.clamp**2, 0.0
    flux = (rows[:, 2] @ LUMINANCE).mean() if len(rows) else 1.0
    return 0.0, float(MOST_OF_RADIOSITY * np.pi**2 / flux)


def _drawn(maps: Buffers, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Up to `count` pixel lights: position, normal and flux (n, 3, 3), and the radiosity (n,) of their surfaces.

    Each cell of equal flux has a light. A cell's pixel is drawn by its flux, and has the whole cell's in its own
    colour. The radiosity is a luminance.
    """
    places, normal, flux = (read(maps[name]) for name in ("rsm_position", "rsm_normal", "rsm_flux"))
    position, area, normal, flux = places[..., :3], places[..., 3], normal[..., :3], flux[..., :3]
    energy = (flux @ LUMINANCE).astype(np.float64)
    random, rows, radiosity = np.random.default_rng(seed), [], []
    for top, bottom, left, right in equal_energy_cells(energy, count):
        part = np.s_[top:bottom, left:right]
        running = energy[part].ravel().cumsum()
        number = min(int(np.searchsorted(running, random.random() * running[-1], side="right")), len(running) - 1)
        color = flux[part].reshape(-1, 3)[number]
        sent = color / (color @ LUMINANCE) * running[-1]
        rows.append([position[part].reshape(-1, 3)[number], normal[part].reshape(-1, 3)[number], sent])
        radiosity.append(energy[part].ravel()[number] / area[part].ravel()[number])
    return np.reshape(np.asarray(rows, float), (-1, 3, 3)), np.array(radiosity)


def _projection(scene: Scene, row: np.ndarray, is_far: float) -> tuple[np.ndarray, np.ndarray]:
    """view_from_world and clip_from_view of a light's shadow map; the world is that of the shaders."""
    place, normal, _ = row
    centre, radius = scene.centre - scene.shader_origin, scene.radius * 1.001
    if is_far:
        return look_along(centre + place * radius, -place), orthographic(radius, radius, 0, 2 * radius)
    far = float(np.linalg.norm(place - centre)) + radius
    near = far * 1e-3
    return look_along(place, normal), perspective(TAN_OPENING, TAN_OPENING, near, far)


def irradiance(state: SurfaceState, step: VirtualLights, maps: VirtualLightMaps, given: list[Bindings]) -> Buffers:
    """The step's output: the lights in batches, whose results are added up by blending."""
    frame, view, runner = state.frame, state.frame.view, state.frame.runner
    check_loops(BATCH * (STEPS_A_LIGHT + frame.module.fill), "a batch of virtual lights")
    targets = runner.targets(step, view.size)
    runner.pool.framebuffer(list(targets.values())).clear()
    textures = {"light_rows": maps.rows, "shadow_atlas": maps.atlas, "shadow_table": maps.table}
    known = [Bindings("the view", uniforms=view.uniforms, constants=view.constants), state.occluders.bindings, *given]
    step = replace(step, constants={**step.constants, "batch": BATCH})
    gl = context.get()
    try:
        gl.enable_only(moderngl.BLEND)
        gl.blend_func = moderngl.ONE, moderngl.ONE
        for first in range(0, maps.count, BATCH):
            lights = Bindings(
                "the virtual lights", textures, {"first_light": first, "light_count": maps.count}, {"one_tile": False}
            )
            runner.run(step, [*known, lights], view.size, targets=targets)
    finally:
        gl.enable_only(moderngl.NOTHING)
    return targets
