"""Scenes with known answers."""

import numpy as np

import aolab


def quad(centre, half1, half2, albedo=0.8, **options):
    """A parallelogram around `centre`, spanned by two half edges."""
    c, a, b = (np.asarray(v, float) for v in (centre, half1, half2))
    material = options.pop("material", None) or aolab.Material(base_color=(albedo,) * 3)
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    corners = np.array([c - a - b, c + a - b, c + a + b, c - a + b])
    return aolab.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]), uv=uv, material=material, **options)


def scene(*meshes, **options):
    """The meshes where they are; black environment unless given."""
    options.setdefault("environment", aolab.Environment.constant(0.0))
    return aolab.Scene(tuple(aolab.Instance(mesh) for mesh in meshes), **options)


WALL_HEIGHT = 1.0


def wall_scene(floor_albedo=0.8, wall_albedo=0.8, half_width=200, **options):
    """A floor (y = 0) seen from above, beside a wall (x = 0, facing +x) that is as good as infinitely wide."""
    floor = quad((2, 0, 0), (0, 0, half_width), (2, 0, 0), floor_albedo)
    wall = quad((0, WALL_HEIGHT / 2, 0), (0, WALL_HEIGHT / 2, 0), (0, 0, half_width), wall_albedo)
    options.setdefault("camera", aolab.Camera(eye=(1.6, 3, 0), target=(1.2, 0, 0), up=(0, 0, -1), fov=20))
    return scene(floor, wall, **options)


CEILING = 1.0


def ceiling_scene(albedo=0.8, **options):
    """A floor (y = 0) under a ceiling (y = 1), seen from between them; they reach 4 units beyond what is seen."""
    floor = quad((0, 0, 0), (0, 0, 5), (5, 0, 0), albedo)
    ceiling = quad((0, CEILING, 0), (0, 0, 5), (5, 0, 0), albedo)
    camera = aolab.Camera(eye=(0, 0.9, 0), target=(0, 0, 0), up=(0, 0, -1), fov=40)
    return scene(floor, ceiling, camera=camera, **options)


def world_positions(frame):
    """(n, 3): the surface points of the pixels that show one, world space."""
    camera = aolab.Camera(**frame.info["camera"])
    width, height = frame.size
    tan_x, tan_y = camera.half_extent(frame.size)
    x = (2 * (np.arange(width) + 0.5) / width - 1) * tan_x
    y = (1 - 2 * (np.arange(height) + 0.5) / height) * tan_y
    rays = np.stack([*np.meshgrid(x, y), np.full((height, width), -1.0)], axis=-1)
    view = (rays * -frame["viewZ"][..., None])[frame.mask]
    world_from_view = np.linalg.inv(camera.view_from_world)
    return view @ world_from_view[:3, :3].T + world_from_view[:3, 3]
