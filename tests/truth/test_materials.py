"""Albedo at hits, against what the rasteriser drew; holes let rays through."""

import numpy as np

import aolab
from aolab.truth import reference
from aolab.truth.world import World

from .rooms import quad, scene

SIZE = (64, 48)
CAMERA = aolab.Camera(eye=(0.2, 0.3, 4), target=(0, 0, 0), fov=35)


def hits_through_pixels(world, size):
    tan_x, tan_y = CAMERA.half_extent(size)
    x = (2 * (np.arange(size[0]) + 0.5) / size[0] - 1) * tan_x
    y = (1 - 2 * (np.arange(size[1]) + 0.5) / size[1]) * tan_y
    rays = np.stack([*np.meshgrid(x, y), np.full((size[1], size[0]), -1.0)], axis=-1).reshape(-1, 3)
    rays = rays @ CAMERA.view_from_world[:3, :3]
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    eye = np.broadcast_to(np.asarray(CAMERA.eye) - world.centre, rays.shape)
    return world.first_hit(eye.astype(np.float32), rays.astype(np.float32), np.inf)


def coarse_texture(alpha=255):
    pixels = np.random.default_rng(1).integers(0, 256, (4, 8, 4), np.uint8)
    pixels[..., 3] = alpha
    return aolab.Texture(pixels)


def test_albedo_at_hits_is_what_the_rasteriser_draws():
    """Base colour, vertex colours, and a texture whose corners and directions differ."""
    textured = aolab.Material(base_color=(0.9, 0.8, 0.7), texture=coarse_texture())
    left = quad((-0.8, 0, 0), (0.7, 0, 0), (0, 0.8, 0), material=textured)
    colors = np.random.default_rng(2).random((4, 4))
    plain = quad((0.8, 0, 0), (0.7, 0, 0), (0, 0.8, 0))
    right = aolab.Mesh(plain.vertices, plain.faces, colors=colors, material=plain.material)
    both = scene(left, right, camera=CAMERA)
    frame = aolab.render(both, "none", size=SIZE)
    world = World(both)
    hits = hits_through_pixels(world, SIZE)
    seen = np.flatnonzero((hits.triangle >= 0) & frame.mask.reshape(-1))
    assert len(seen) > 500
    albedo = world.albedo(hits.triangle[seen], hits.u[seen], hits.v[seen])
    drawn = frame["albedo"].reshape(-1, 3)[seen]
    assert drawn.std() > 0.1
    np.testing.assert_allclose(albedo, drawn, atol=0.02)  # a driver's bilinear weights have 8 bits


def test_holes_of_a_cut_out_texture_let_rays_through():
    """A sheet over the floor, its left half cut out: under that half the sky is open, under the other it is not."""
    pixels = np.full((1, 2, 4), 255, np.uint8)
    pixels[0, 0, 3] = 0
    sheet = aolab.Material(texture=aolab.Texture(np.repeat(pixels, 64, axis=1)), alpha_cutoff=0.5)
    floor = quad((0, 0, 0), (0, 0, 9), (9, 0, 0))
    camera = aolab.Camera(eye=(0, 0.08, 0), target=(0, 0, 0), up=(0, 0, -1), fov=170)
    sheets = [quad((0, height, 0), (20, 0, 0), (0, 0, 20), material=sheet) for height in (0.1, 0.3)]
    frame = reference(scene(floor, *sheets, camera=camera), size=(65, 9), rays=64, buffers=("visibility", "indirect"))
    row = frame["visibility"][4]
    assert row[:20].min() > 0.95
    assert row[-20:].max() < 0.05
    occlusion = reference(scene(floor, *sheets, camera=camera), size=(65, 9), rays=64, buffers="visibility")
    np.testing.assert_array_equal(occlusion["visibility"], frame["visibility"])


def test_a_world_without_holes_never_looks_at_materials():
    world = World(scene(quad((0, 0, 0), (1, 0, 0), (0, 1, 0))))
    o, d = np.float32([[0.1, 0.1, 1]]), np.float32([[0, 0, -1]])
    assert world.occluded(o, d, np.inf).all()
    assert not world.occluded(o, d, 0.9).any()
