"""Pictures of functions of direction, as lobes and as spheres. A separate small lab draws them."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import trimesh
from PIL import Image

from ..gl.texture import Size
from ..maths.harmonics import evaluate
from ..pipeline.lab import Lab
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..scene.lights import DirectionalLight
from ..scene.mesh import Material, Mesh
from ..scene.scene import Instance, Scene

SUBDIVISIONS = 5  # of the icosahedron: 10242 directions, 2° apart; the fourth band's waves are 120° long
EXTENT = 1.25  # half the picture's height; ring and sphere have radius 1, the lobe of an open surface has length 1.06
FOV = 16.0  # degrees: a long lens, so that a lobe's size hardly depends on its direction
SUPERSAMPLING = 2
PAPER = np.array((236, 236, 233), np.uint8)  # sRGB, light grey
RED, BLUE, GRAY = (0.62, 0.07, 0.05), (0.06, 0.2, 0.62), (0.3, 0.3, 0.3)  # linear RGB
WHITE = Material((1.0, 1.0, 1.0))


@dataclass(frozen=True, eq=False)
class Lobe:
    """A function of direction: `values` (n,), or (n, 3) for RGB, at unit world-space `directions` (n, 3).

    `mesh` has one vertex per direction, at the distance |value| from the origin (RGB: the largest of the three). The
    vertex colour shows the value.
    """

    directions: np.ndarray
    values: np.ndarray
    mesh: Mesh


@cache
def _sphere() -> trimesh.Trimesh:
    return trimesh.creation.icosphere(SUBDIVISIONS)


def _mesh(shape: trimesh.Trimesh, colors: np.ndarray | tuple[float, float, float], name: str) -> Mesh:
    """A smooth mesh with linear RGB `colors`: one colour (3,), or a colour per vertex (n, 3)."""
    rgba = np.ones((len(shape.vertices), 4))
    rgba[:, :3] = colors
    return Mesh(shape.vertices, shape.faces, normals=shape.vertex_normals, colors=rgba, material=WHITE, name=name)


def lobe(coefficients: np.ndarray) -> Lobe:
    """The lobe of the function with `coefficients` (16,), or (16, 3) for RGB."""
    directions = np.asarray(_sphere().vertices)
    values = evaluate(coefficients, directions)
    if values.ndim == 1:
        size, colors = np.abs(values), np.where(values[:, None] > 0, RED, BLUE)
    else:
        size = np.abs(values).max(axis=1)
        colors = np.clip(values, 0, None) / np.maximum(size, 1e-9)[:, None]
        colors = np.where(values.max(axis=1, keepdims=True) > 0, colors, BLUE)
    # triangles at a length of 0 would have no area
    shape = trimesh.Trimesh(directions * np.maximum(size, 1e-3)[:, None], _sphere().faces, process=False)
    return Lobe(directions, values, _mesh(shape, colors, "lobe"))


def brightest(light: np.ndarray) -> float:
    """The largest value, over all directions and colours, of the function with coefficients `light` (16, 3)."""
    return float(evaluate(light, np.asarray(_sphere().vertices)).max())


def draw_lobe(lobe: Lobe, normal: np.ndarray, camera: Camera, size: Size) -> np.ndarray:
    """The lobe under soft light, with a ring in the tangent plane and a pin along `normal`: (H, W, 3) uint8."""
    turned = trimesh.geometry.align_vectors((0, 0, 1), normal)
    ring = trimesh.creation.torus(1.0, 0.012).apply_transform(turned)
    pin = trimesh.creation.cylinder(0.012, segment=np.outer((0, 1.2), normal))
    # the light comes over the viewer's left shoulder
    sun = DirectionalLight(tuple(np.array((0.5, -0.8, -0.7)) @ camera.view_from_world[:3, :3]), (2.2, 2.2, 2.2), False)
    meshes = (lobe.mesh, _mesh(ring, GRAY, "tangent plane"), _mesh(pin, GRAY, "normal"))
    extent = max(EXTENT, 1.1 * float(np.abs(lobe.values).max()))  # a strong bounce must fit into the picture
    return _drawn(meshes, Environment.constant(0.35), (sun,), camera, size, extent)


def draw_light(light: np.ndarray, camera: Camera, size: Size) -> np.ndarray:
    """A sphere with the colours of the light, coefficients (16, 3), without shading: (height, width, 3) uint8."""
    shape = _sphere()
    radiance = np.clip(evaluate(light, np.asarray(shape.vertices)), 0, None)
    colors = radiance / max(radiance.max(), 1e-9)
    # under a constant radiance of 1, a surface reflects its own albedo
    return _drawn((_mesh(shape, colors, "light"),), Environment.constant(1.0), (), camera, size)


@cache
def _lab() -> Lab:
    """A separate lab, so that small pictures do not push the textures of large frames out of the shared lab."""
    return Lab((480, 480))


def _drawn(
    meshes: tuple[Mesh, ...],
    environment: Environment,
    lights: tuple[DirectionalLight, ...],
    camera: Camera,
    size: Size,
    extent: float = EXTENT,
) -> np.ndarray:
    """Meshes around the origin, seen from the direction of `camera`: (height, width, 3) uint8."""
    width, height = size
    backward, up = camera.view_from_world[2, :3], camera.view_from_world[1, :3]
    half_height = extent * max(1, height / width)
    eye = backward * half_height / np.sin(np.radians(FOV / 2))
    scene = Scene(
        tuple(Instance(mesh) for mesh in meshes), lights, environment, Camera(tuple(eye), (0, 0, 0), tuple(up), FOV)
    )
    large = (SUPERSAMPLING * width, SUPERSAMPLING * height)
    frame = _lab().render(scene, "none", size=large, tone_map="linear")
    image = np.where(frame.mask[..., None], frame.image, PAPER)
    return np.asarray(Image.fromarray(image).reduce(SUPERSAMPLING))
