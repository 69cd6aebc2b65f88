"""Functions of direction as pictures: lobes and spheres, drawn by a small lab of their own."""

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
EXTENT = 1.25  # half the picture's height; the ring and the sphere have radius 1, an open surface's lobe is 1.06 long
FOV = 16.0  # degrees: a long lens, so that the size of a lobe hardly depends on where it points
SUPERSAMPLING = 2
PAPER = np.array((236, 236, 233), np.uint8)  # sRGB, light grey
RED, BLUE, GRAY = (0.62, 0.07, 0.05), (0.06, 0.2, 0.62), (0.3, 0.3, 0.3)  # linear RGB
WHITE = Material((1.0, 1.0, 1.0))


@dataclass(frozen=True, eq=False)
class Lobe:
    """A function of direction: `values` (n,), or (n, 3) for RGB, at unit world-space `directions` (n, 3).

    `mesh`: at each direction, one vertex |value| away from the origin (of RGB the largest), coloured by its value.
    """

    directions: np.ndarray
    values: np.ndarray
    mesh: Mesh


@cache
def _sphere() -> trimesh.Trimesh:
    return trimesh.creation.icosphere(SUBDIVISIONS)


def _mesh(shape: trimesh.Trimesh, colors: np.ndarray | tuple[float, float, float], name: str) -> Mesh:
    """A smooth mesh with linear RGB `colors`, one for all or one a vertex."""
    rgba = np.ones((len(shape.vertices), 4))
    rgba[:, :3] = colors
    return Mesh(shape.vertices, shape.faces, normals=shape.vertex_normals, colors=rgba, material=WHITE, name=name)


def lobe(coefficients: np.ndarray) -> Lobe:
    """The function with `coefficients` (16,), or (16, 3) for RGB."""
    directions = np.asarray(_sphere().vertices)
    values = evaluate(coefficients, directions)
    if values.ndim == 1:
        size, colors = np.abs(values), np.where(values[:, None] > 0, RED, BLUE)
    else:
        size = np.abs(values).max(axis=1)
        colors = np.clip(values, 0, None) / np.maximum(size, 1e-9)[:, None]
        colors = np.where(values.max(axis=1, keepdims=True) > 0, colors, BLUE)
    # a length of 0 would leave triangles without area
    shape = trimesh.Trimesh(directions * np.maximum(size, 1e-3)[:, None], _sphere().faces, process=False)
    return Lobe(directions, values, _mesh(shape, colors, "lobe"))


def brightest(light: np.ndarray) -> float:
    """The largest value, over all directions and colours, of the function with coefficients `light` (16, 3)."""
    return float(evaluate(light, np.asarray(_sphere().vertices)).max())


def draw_lobe(lobe: Lobe, normal: np.ndarray, camera: Camera, size: Size) -> np.ndarray:
    """(height, width, 3) uint8: the lobe, softly lit, over a ring in the plane across `normal` and a pin along it."""
    turned = trimesh.geometry.align_vectors((0, 0, 1), normal)
    ring = trimesh.creation.torus(1.0, 0.012).apply_transform(turned)
    pin = trimesh.creation.cylinder(0.012, segment=np.outer((0, 1.2), normal))
    # over the viewer's left shoulder
    sun = DirectionalLight(tuple(np.array((0.5, -0.8, -0.7)) @ camera.view_from_world[:3, :3]), (2.2, 2.2, 2.2), False)
    meshes = (lobe.mesh, _mesh(ring, GRAY, "tangent plane"), _mesh(pin, GRAY, "normal"))
    extent = max(EXTENT, 1.1 * float(np.abs(lobe.values).max()))  # a strong bounce must fit
    return _drawn(meshes, Environment.constant(0.35), (sun,), camera, size, extent)


def draw_light(light: np.ndarray, camera: Camera, size: Size) -> np.ndarray:
    """(height, width, 3) uint8: a sphere in the colours of the light (16, 3), which are not lit themselves."""
    shape = _sphere()
    radiance = np.clip(evaluate(light, np.asarray(shape.vertices)), 0, None)
    colors = radiance / max(radiance.max(), 1e-9)
    # under a constant radiance of 1, what a surface reflects is its own colour
    return _drawn((_mesh(shape, colors, "light"),), Environment.constant(1.0), (), camera, size)


@cache
def _lab() -> Lab:
    """One of its own: the small pictures must not make the shared lab forget the textures of large ones."""
    return Lab((480, 480))


def _drawn(
    meshes: tuple[Mesh, ...],
    environment: Environment,
    lights: tuple[DirectionalLight, ...],
    camera: Camera,
    size: Size,
    extent: float = EXTENT,
) -> np.ndarray:
    """(height, width, 3) uint8: meshes around the origin, turned to the viewer as the camera turns its scene."""
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
