"""The scenes of checks: some with exact answers, and hidden ones that a seed makes. Scene units, y up, a white sky."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ..pipeline.frame import Frame
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..scene.lights import DirectionalLight
from ..scene.mesh import Material, Mesh
from ..scene.scene import Instance, Scene
from ..scene.shapes import block, placed
from ..scene.view import View

WHITE = Material((1.0, 1.0, 1.0))
FAR = 100.0  # half the side of a floor

Answer = Callable[[np.ndarray, np.ndarray, float], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class ExactScene:
    """A scene, and the visibility that is exact there.

    `answer` is a function of world positions (H, W, 3), world normals (H, W, 3) and the radius; it returns the
    visibility (H, W) and where it holds (H, W). None: the answer is a constant, at every surface.
    """

    make: Callable[[], Scene]
    answer: Answer | None = None


def _quad(corner: Sequence[float], along: Sequence[float], across: Sequence[float], material: Material = WHITE) -> Mesh:
    start, u, v = (np.asarray(vector, float) for vector in (corner, along, across))
    return Mesh(
        np.array([start, start + u, start + u + v, start + v]), np.array([(0, 1, 2), (0, 2, 3)]), material=material
    )


def _floor() -> Mesh:
    return _quad((-FAR, 0, FAR), (2 * FAR, 0, 0), (0, 0, -2 * FAR))


def _of(*meshes: Mesh, camera: Camera) -> Scene:
    return Scene(tuple(map(Instance, meshes)), (), Environment.constant((1.0, 1.0, 1.0)), camera)


def plane() -> Scene:
    """An open plane: visibility 1."""
    return _of(_floor(), camera=Camera(eye=(1, 3, 6), target=(0.3, 0, 0)))


def wall() -> Scene:
    """A floor, and a wall without end in the plane x = 0."""
    floor = _quad((0, 0, FAR), (FAR, 0, 0), (0, 0, -2 * FAR))
    upright = _quad((0, 0, FAR), (0, 0, -2 * FAR), (0, 40, 0))
    return _of(floor, upright, camera=Camera(eye=(4, 3, 0), target=(0.5, 0.3, 0), fov=60))


def ball() -> Scene:
    """A sphere of radius 1, whose centre is 1.5 above a floor."""
    from trimesh.creation import icosphere  # trimesh takes 0.5 s to import

    shape = icosphere(4, 1.0)
    sphere = Mesh(shape.vertices + np.array((0, 1.5, 0)), shape.faces, normals=shape.vertices, material=WHITE)
    return _of(_floor(), sphere, camera=Camera((0, 1.0, 4.2), (0, 0.8, 0), fov=75))


def furnace() -> Scene:
    """A white floor, wall and box under a sky of radiance 1: no surface sends more than 1."""
    base = wall()
    box = Instance(block((0.7, 0.7, 0.8), WHITE), placed(0.65, 0, -0.1))
    return replace(base, instances=(*base.instances, box))


def _wall_answer(position: np.ndarray, normal: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Of a floor at the distance x from a wall without end: with c = x / radius, a segment of the unit disc is blocked,
    (arccos c - c √(1 - c²)) / π (Nusselt's analogue)."""
    x, y, z = np.moveaxis(position, -1, 0)
    c = np.clip(x / radius, 0, 1)
    holds = (np.abs(y) < 1e-3) & (np.abs(z) < 0.5) & (x > 0.05) & (x < 1.2 * radius)
    return 1 - (np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi, holds


def _ball_answer(position: np.ndarray, normal: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Of a floor under a sphere of radius r at the height c: occlusion = c r² / (c² + s²)^{3/2}."""
    x, y, z = np.moveaxis(position, -1, 0)
    occlusion = 1.5 / (1.5**2 + x * x + z * z) ** 1.5
    return 1 - occlusion, (np.abs(y) < 1e-3) & (np.abs(x) < 0.5) & (z > 1.9)


EXACT = {
    "plane": ExactScene(plane),
    "wall": ExactScene(wall, _wall_answer),
    "ball": ExactScene(ball, _ball_answer),
    "furnace": ExactScene(furnace),
}


def hidden(seed: int, number: int) -> Scene:
    """A floor with boxes, lit by a sun, from a camera of its own: the hidden scene `number` of a seed."""
    random = np.random.default_rng((seed, number))
    parts = [Instance(_quad((-6, 0, 6), (12, 0, 0), (0, 0, -12), Material((0.7, 0.7, 0.7))))]
    for _ in range(8):
        width, height, depth = random.uniform((0.4, 0.3, 0.4), (1.4, 1.6, 1.4))
        x, z = random.uniform(-2, 2, 2)
        material = Material(tuple(random.uniform(0.2, 0.9, 3)))
        parts.append(Instance(block((width, height, depth), material), placed(x, 0, z, turn=random.uniform(0, 90))))
    angle, up = random.uniform(0, 2 * np.pi), random.uniform(2, 4.5)
    eye = (5.5 * np.cos(angle), up, 5.5 * np.sin(angle))
    sun = DirectionalLight(
        direction=tuple(random.uniform((-0.6, -1, -0.6), (0.6, -0.7, 0.6))), irradiance=(2.0, 1.9, 1.7)
    )
    sky = Environment.constant((0.8, 0.9, 1.0))
    return Scene(tuple(parts), (sun,), sky, Camera(eye, (0, 0.5, 0), fov=float(random.uniform(35, 55))))


@cache
def named(name: str) -> Scene:
    """A scene of a check: an exact scene, or a scene by its name."""
    from ..loading import load

    return EXACT[name].make() if name in EXACT else load(name)


def places(frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """(H, W, 3) each: world positions and world normals of the pixels' surfaces; positions not finite elsewhere."""
    camera = frame.camera
    view = View(camera, frame.size, np.array([[-1.0] * 3, [1.0] * 3]))
    width, height = frame.size
    pixels = np.stack(np.meshgrid(np.arange(width) + 0.5, height - np.arange(height) - 0.5), axis=-1)
    world_from_view = np.linalg.inv(camera.view_from_world)
    with np.errstate(invalid="ignore"):
        position = view.positions(pixels, frame["viewZ"]) @ world_from_view[:3, :3].T + world_from_view[:3, 3]
    return position, frame.world_normal()
