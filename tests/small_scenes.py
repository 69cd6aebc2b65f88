"""Small scenes with known answers, in scene units, y up. Every one is white and has a constant sky of radiance 1."""

import numpy as np
import trimesh

from aolab import Camera, Environment, Frame, Instance, Material, Mesh, Scene
from aolab.scene.lights import Light
from aolab.scene.view import View

# visibility that is 1, on any driver: where a filter divides inexactly and half floats are truncated, each of two
# passes loses a step of 2^-11
OPEN = 1 - 2**-10

WHITE = Material((1.0, 1.0, 1.0))
SKY = Environment.constant((1.0, 1.0, 1.0))


def quad(corner, along, across, material: Material = WHITE, name: str = "quad") -> Mesh:
    """The parallelogram at `corner`, spanned by two edges; its normal is along × across, uv runs with the edges."""
    corner, along, across = (np.asarray(vector, float) for vector in (corner, along, across))
    vertices = np.array([corner, corner + along, corner + along + across, corner + across])
    uv = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    return Mesh(vertices, np.array([(0, 1, 2), (0, 2, 3)]), uv=uv, material=material, name=name)


def box(low, high, material: Material = WHITE, name: str = "box") -> Mesh:
    """An axis-aligned box between two corners."""
    shape = trimesh.creation.box(bounds=[low, high])
    return Mesh(shape.vertices, shape.faces, material=material, name=name)


def sphere(radius: float, centre, material: Material = WHITE, subdivisions: int = 4) -> Mesh:
    """A sphere of 20 · 4^subdivisions triangles with its vertices on `radius`."""
    shape = trimesh.creation.icosphere(subdivisions, radius)
    return Mesh(shape.vertices + centre, shape.faces, normals=shape.vertices / radius, material=material, name="sphere")


def floor(half: float = 100.0, material: Material = WHITE) -> Mesh:
    """The plane y = 0, from -half to half in x and z."""
    return quad((-half, 0, half), (2 * half, 0, 0), (0, 0, -2 * half), material, "floor")


def of(*meshes: Mesh, camera: Camera | None = None, lights: tuple[Light, ...] = (), sky: Environment = SKY) -> Scene:
    """A scene of these meshes, where they are."""
    return Scene(tuple(Instance(mesh) for mesh in meshes), lights, sky, camera)


def plane(camera: Camera | None = None, half: float = 100.0, material: Material = WHITE) -> Scene:
    """An unoccluded plane: visibility is exactly 1 everywhere."""
    return of(floor(half, material), camera=camera or Camera(eye=(0, 3, 6), target=(0, 0, 0)))


def wall(height: float = 40.0, camera: Camera | None = None) -> Scene:
    """A floor, and a wall of `height` in the plane x = 0 that closes it on the left: AO = ½ (1 + x / √(x² + h²))."""
    floor_right = quad((0, 0, 100), (100, 0, 0), (0, 0, -200), name="floor")
    wall_left = quad((0, 0, 100), (0, 0, -200), (0, height, 0), name="wall")
    return of(floor_right, wall_left, camera=camera or Camera(eye=(4, 3, 0), target=(0.5, 0.3, 0), fov=60))


def ball(radius: float = 1.0, height: float = 1.5, camera: Camera | None = None) -> Scene:
    """A sphere whose centre is `height` over the plane y = 0: occlusion = c r² / (c² + s²)^{3/2}."""
    camera = camera or Camera(eye=(0, 4, 9), target=(0, 0.8, 0), fov=40)
    return of(floor(), sphere(radius, (0, height, 0)), camera=camera)


def boxes(camera: Camera | None = None, lights: tuple[Light, ...] = ()) -> Scene:
    """A floor and three boxes of different heights and colours, with depth gaps between them."""
    return of(
        floor(10, Material((0.7, 0.7, 0.7))),
        box((-1.6, 0, -0.5), (-0.6, 1.0, 0.5), Material((0.8, 0.2, 0.2)), "left"),
        box((-0.4, 0, -1.5), (0.6, 1.8, -0.5), Material((0.2, 0.8, 0.2)), "middle"),
        box((0.8, 0, 0.0), (1.8, 0.6, 1.0), Material((0.2, 0.2, 0.8)), "right"),
        camera=camera or Camera(eye=(0.5, 2.5, 5), target=(0, 0.5, 0), fov=45),
        lights=lights,
    )


def world_positions(frame: Frame, camera: Camera) -> np.ndarray:
    """(H, W, 3): where each pixel's surface is; not finite in the background."""
    view = View(camera, frame.size, np.array([[-1.0] * 3, [1.0] * 3]))
    width, height = frame.size
    pixels = np.stack(np.meshgrid(np.arange(width) + 0.5, height - np.arange(height) - 0.5), axis=-1)
    world_from_view = np.linalg.inv(camera.view_from_world)
    with np.errstate(invalid="ignore"):
        return view.positions(pixels, frame["viewZ"]) @ world_from_view[:3, :3].T + world_from_view[:3, 3]
