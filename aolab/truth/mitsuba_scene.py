"""A scene in Mitsuba's terms: arrays, and a description in JSON, for `mitsuba_worker.py` to make objects of."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..errors import SceneError
from ..pictures.images import linear_from_srgb
from ..scene.environment import Environment
from ..scene.lights import DirectionalLight, Light, PointLight, SpotLight
from ..scene.mesh import Mesh, Texture
from ..scene.scene import Instance, Scene
from ..scene.view import View

# Mitsuba lifts rays off a surface by 9e-5 × (1 + the largest coordinate). With a scene of this radius the 1 does not
# matter, and the lift is the same share of every scene, whatever its unit.
RADIUS = 1000.0
SURFACES = -1
APART = 1e-5 * RADIUS
SPOT_TEXELS = 1024  # across a spot's cone; between them its falloff is interpolated


class Image(NamedTuple):
    """One rendering: a single emitter (an index of the description's), and paths of at most `max_depth` edges.

    The emitter `SURFACES` is the emission of all surfaces.
    """

    emitter: int
    max_depth: int
    background: bool  # whether the environment shows behind the surfaces

    @property
    def name(self) -> str:
        emitter = "surfaces" if self.emitter == SURFACES else f"emitter{self.emitter}"
        return f"{emitter}.depth{self.max_depth}" + ".background" * self.background


@dataclass
class Description:
    """The worker's input: `arrays` by name, and `scene`, as JSON holds it."""

    arrays: dict[str, np.ndarray] = field(default_factory=dict)
    scene: dict[str, Any] = field(default_factory=dict)


def describe(scene: Scene, view: View, images: list[Image], samples: int, seed: int) -> Description:
    """The worker's input. Emitters are the scene's lights, in order, and then its environment.

    Raises `SceneError` for parts without counterpart in Mitsuba: a light without shadow, vertex colours × texture, the
    emission of a surface with holes.
    """
    assert scene.environment is not None  # Scene fills it in
    centre, scale = scene.bounds.mean(axis=0), RADIUS / scene.radius
    materials = [instance.mesh.material for instance in scene.instances]
    cut_out = any(material.alpha_cutoff is not None or material.blend for material in materials)
    made = Description()
    shapes: dict[str, dict[str, Any]] = {}
    for i, instance in enumerate(scene.instances):
        name, mesh = f"shape{i}", instance.mesh
        _shape(made.arrays, name, instance, centre, scale)
        shapes[name] = _material(made.arrays, name, mesh)
        if _glow(made.arrays, name, mesh) and mesh.material.double_sided and not mesh.is_solid:
            shapes[_with_back(made.arrays, name)] = shapes[name]
    made.scene = {
        "shapes": shapes,
        "emitters": [
            *(_light(made.arrays, f"light{i}", light, centre, scale) for i, light in enumerate(scene.lights)),
            _environment(made.arrays, scene.environment),
        ],
        "camera": _camera(view, scene.bounds, centre, scale),
        "size": view.size,
        "images": {image.name: image._asdict() for image in images},
        # `path` takes holes for surfaces: they would cast shadows, and count as a bounce
        "integrator": "volpath" if cut_out else "path",
        "samples": samples,
        "seed": seed,
    }
    return made


def _camera(view: View, bounds: np.ndarray, centre: np.ndarray, scale: float) -> dict[str, Any]:
    camera = view.camera
    near, far = camera.clip_planes(bounds)
    return {
        "origin": ((np.asarray(camera.eye) - centre) * scale).tolist(),
        "target": ((np.asarray(camera.target) - centre) * scale).tolist(),
        "up": camera.up,
        **(
            {"fov": 2 * np.degrees(np.arctan(camera.half_extent(view.size)[1])).item()}
            if camera.ortho is None
            else {"half_width": camera.half_extent(view.size)[0] * scale}
        ),
        "near_clip": near * scale,
        "far_clip": far * scale,
    }


def _shape(arrays: dict[str, np.ndarray], name: str, instance: Instance, centre: np.ndarray, scale: float) -> None:
    """Its triangles in Mitsuba's world: `centre` is 0, a scene unit is `scale`."""
    mesh = instance.mesh
    assert mesh.normals is not None  # Mesh makes them
    linear, translation = instance.world_from_local[:3, :3], instance.world_from_local[:3, 3]
    normals = mesh.normals.astype(np.float64) @ np.linalg.inv(linear)  # surfaces have two sides: any sign will do
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    vertices = (mesh.vertices.astype(np.float64) @ linear.T + translation - centre) * scale
    arrays[f"{name}.vertices"] = vertices.astype(np.float32)
    arrays[f"{name}.normals"] = normals.astype(np.float32)
    arrays[f"{name}.faces"] = mesh.faces
    if mesh.material.texture is not None or mesh.material.emission_texture is not None:
        uv = np.zeros((len(vertices), 2), np.float32) if mesh.uv is None else mesh.uv
        arrays[f"{name}.uv"] = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)  # Mitsuba's v grows from the first row down


def _material(arrays: dict[str, np.ndarray], name: str, mesh: Mesh) -> dict[str, Any]:
    """`reflectance`: RGB, the name of an image, or "vertex_color"; `opacity`: the name of an image, or None."""
    material, texture = mesh.material, mesh.material.texture
    base = np.array((*material.base_color, material.alpha), np.float32)
    colors = np.ones((1, 4), np.float32) if mesh.colors is None else mesh.colors
    if (colors == colors[0]).all():
        base, colors = base * colors[0], colors[:1]
    cut_out = material.alpha_cutoff is not None and (texture is not None or base[3] < material.alpha_cutoff)
    if len(colors) > 1 and (texture is not None or material.alpha_cutoff is not None):
        raise SceneError(
            f"mesh '{mesh.name}': engine = 'mitsuba' has no product of vertex colours and texture, nor cut-out vertex "
            "alpha; leave out one of them"
        )
    description: dict[str, Any] = {"reflectance": base[:3].clip(0, 1).tolist(), "opacity": None, "holes": "nearest"}
    description |= {
        "wrap": _wrap(texture),
        "filter": "nearest" if texture is not None and texture.nearest else "bilinear",
    }
    if len(colors) > 1:
        arrays[f"{name}.colors"] = (colors * base)[:, :3].clip(0, 1)
        description["reflectance"] = "vertex_color"
    if texture is not None:
        key = f"{name}.reflectance"
        arrays[key] = (linear_from_srgb(texture.pixels[..., :3]) * base[:3]).clip(0, 1)
        description["reflectance"] = key
    if material.blend and (texture is not None or base[3] < 1):
        key = f"{name}.opacity"
        alpha = np.full((1, 1), 255, np.uint8) if texture is None else texture.pixels[..., 3]
        arrays[key] = (alpha[..., None] / 255 * base[3]).astype(np.float32)
        description |= {"opacity": key, "holes": description["filter"]}
    if cut_out:
        key = f"{name}.opacity"
        alpha = np.full((1, 1), 255, np.uint8) if texture is None else texture.pixels[..., 3]
        arrays[key] = (alpha[..., None] / 255 * base[3] >= material.alpha_cutoff).astype(np.float32)
        description["opacity"] = key
    return description


def _wrap(texture: Texture | None) -> str:
    """Mitsuba's word for how a texture goes on outside [0, 1]; it has one for both axes."""
    if texture is None:
        return "repeat"
    if texture.wrap[0] != texture.wrap[1]:
        raise SceneError(
            f"texture '{texture.name}': engine = 'mitsuba' has one wrap for both axes, not {' and '.join(texture.wrap)}"
        )
    return texture.wrap[0]


def _glow(arrays: dict[str, np.ndarray], name: str, mesh: Mesh) -> bool:
    """Whether the surface emits; then the array `NAME.radiance` is (1, 1, 3), or (H, W, 3) as the texture."""
    material = mesh.material
    if not any(material.emission):
        return False
    if material.alpha_cutoff is not None or material.blend:
        raise SceneError(f"mesh '{mesh.name}': engine = 'mitsuba' has no emission of a surface with holes, or blended")
    emission = np.array(material.emission, np.float32)[None, None]
    if material.emission_texture is not None:
        _wrap(material.emission_texture)
        emission = emission * linear_from_srgb(material.emission_texture.pixels[..., :3])
    arrays[f"{name}.radiance"] = emission
    return True


def _with_back(arrays: dict[str, np.ndarray], name: str) -> str:
    """The name of a copy of the shape, turned round and a little behind it: Mitsuba's surfaces emit to one side."""
    back = f"{name}_back"
    for part in ("uv", "colors", "radiance"):
        if f"{name}.{part}" in arrays:
            arrays[f"{back}.{part}"] = arrays[f"{name}.{part}"]
    normals = arrays[f"{name}.normals"]
    arrays[f"{back}.normals"] = -normals
    arrays[f"{back}.faces"] = arrays[f"{name}.faces"][:, ::-1].copy()
    arrays[f"{back}.vertices"] = arrays[f"{name}.vertices"] - np.float32(APART) * normals
    return back


def _light(arrays: dict[str, np.ndarray], name: str, light: Light, centre: np.ndarray, scale: float) -> dict[str, Any]:
    if not light.shadow:
        raise SceneError(f"{type(light).__name__} without shadow: engine = 'mitsuba' has no such light")
    if isinstance(light, DirectionalLight):
        return {"type": "directional", "direction": light.direction, "irradiance": light.irradiance}
    position = (np.asarray(light.position) - centre) * scale
    intensity = (np.asarray(light.intensity) * scale**2).tolist()
    if isinstance(light, PointLight):
        return {"type": "point", "position": position.tolist(), "intensity": intensity}
    arrays[f"{name}.falloff"] = _falloff(light)
    return {
        "type": "spot",
        "origin": position.tolist(),
        "direction": (np.asarray(light.direction) / np.linalg.norm(light.direction)).tolist(),
        "intensity": intensity,
        "cutoff_angle": light.outer,
        "beam_width": light.outer * 0.9999,  # Mitsuba's own falloff, linear in the angle, is left no room
        "texture": f"{name}.falloff",
    }


def _falloff(light: SpotLight) -> np.ndarray:
    """(n, n, 1) float32: KHR_lights_punctual's falloff, projected along the axis to the square around the cone."""
    side = ((np.arange(SPOT_TEXELS) + 0.5) / SPOT_TEXELS * 2 - 1) * np.tan(np.radians(light.outer))
    cosine = 1 / np.sqrt(1 + side[:, None] ** 2 + side**2)
    inner, outer = np.cos(np.radians([light.inner, light.outer]))
    return (((cosine - outer) / (inner - outer)).clip(0, 1) ** 2).astype(np.float32)[..., None]


def _environment(arrays: dict[str, np.ndarray], environment: Environment) -> dict[str, Any]:
    radiance = environment.radiance
    if (radiance == radiance[0, 0]).all():
        return {"type": "constant", "radiance": radiance[0, 0].tolist()}
    # Mitsuba's first and last row lie at the poles, ours half a row away from them, and ours goes on evenly from
    # there: a row at every half row of ours is the same function
    rows = np.repeat(np.pad(radiance, ((1, 1), (0, 0), (0, 0)), "edge"), 2, axis=0)
    arrays["environment"] = (rows[1:-2] + rows[2:-1]) / 2
    return {"type": "envmap", "image": "environment"}
