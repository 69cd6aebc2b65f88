"""Points lie where rays meet the surface of the G-buffer: in front of everything, at edges and silhouettes too."""

import numpy as np
import pytest
from scipy.ndimage import minimum_filter

import aolab
from aolab.scene.view import View
from aolab.truth import reference
from aolab.truth.integrals import integrate
from aolab.truth.points import Surface, window
from aolab.truth.sample import Setting, randoms
from aolab.truth.sky import Sky
from aolab.truth.world import World

NEIGHBOURS = np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]], bool)


def surface_of(name, size):
    scene = aolab.load(name)
    frame = aolab.render(scene, "none", size=size)
    return Surface(frame, scene, View(scene.camera, size, scene.bounds), World(scene)), frame


@pytest.mark.slow
@pytest.mark.parametrize("name", ["colonnade", "skyscrapers"])
def test_no_pixel_is_black_among_bright_ones(name):
    """A point inside a solid sees nothing at all. Rays from the G-buffer's own positions left 3 and 2 such pixels."""
    size = (480, 270)
    visibility = np.nan_to_num(reference(name, size=size, rays=16, buffers="visibility")["visibility"], nan=1)
    suspects = (visibility == 0) & (minimum_filter(visibility, footprint=NEIGHBOURS) > 0.1)
    surface, _ = surface_of(name, size)
    points = surface.points(np.flatnonzero(suspects.reshape(-1)[surface.pixel]))
    setting = Setting(surface._world, Sky(aolab.Environment.constant(0.0)), (), aolab.Question(), 1024)
    assert integrate(setting, points, ["open"], (), randoms(0)).mean("open").min(initial=1) > 0


def test_points_are_seen_by_the_eye_and_lie_on_the_pixels_ray():
    surface, frame = surface_of("skyscrapers", (240, 135))
    points = surface.points(np.arange(len(surface)))
    towards = points.position - surface._eye.astype(np.float32)
    distance = np.linalg.norm(towards, axis=1)
    towards /= distance[:, None]
    eye = np.broadcast_to(surface._eye.astype(np.float32), towards.shape)
    hidden = surface._world.occluded(np.ascontiguousarray(eye), towards, distance * np.float32(1 - 1e-5))
    assert hidden.mean() < 1e-4
    rays = surface.view.sights(window(surface.view, surface.pixel)) @ surface._world_from_view[:3, :3].T
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    pixel_width = distance * 2 * np.tan(np.radians(frame.camera.fov) / 2) / 135
    beside = np.linalg.norm(np.cross(rays, towards), axis=1) * distance / pixel_width
    assert np.percentile(beside, 99.9) < 0.01
    assert beside.max() < 1.1


def test_normals_are_those_of_the_g_buffer_and_never_face_away_from_what_is_met():
    surface, frame = surface_of("toasters", (480, 270))
    points = surface.points(np.arange(len(surface)))
    drawn = frame.world_normal()[frame.mask]
    agree = (points.normal * drawn).sum(axis=1)
    assert (agree > 0.999).mean() > 0.999
    _, geometric, same = surface._meet(surface.pixel, (0.0, 0.0))
    assert same.mean() > 0.999
    assert ((points.normal * geometric).sum(axis=1)[same] > -0.011).all()
