"""Baked occlusion: exact answers at vertices and texels, seams, and files that come back as they were."""

from itertools import pairwise

import numpy as np
import pytest
import trimesh
from small_scenes import box, floor, of, quad

import aolab
from aolab import Instance, Material, Mesh, Texture
from aolab.baking import write_glb
from aolab.baking.texels import filled, texels_of
from aolab.errors import FileError, Notice, ParameterError


def corner(height: float = 40.0) -> aolab.Scene:
    """A floor of strips beside a wall at x = 0: the visibility is ½ (1 + x / √(x² + h²))."""
    x = np.linspace(0.5, 8, 16)
    strips = [quad((a, 0, 60), (b - a, 0, 0), (0, 0, -120), name="floor") for a, b in pairwise(x)]
    return of(*strips, quad((0, 0, 60), (0, 0, -120), (0, height, 0), name="wall"))


def test_vertices_of_a_floor_beside_a_wall_have_the_exact_visibility():
    height = 3.0
    scene = aolab.bake(corner(height), rays=2048, radius=None, falloff=0.0, texels=16)
    for instance in scene.instances[:-1]:
        mesh = instance.mesh
        assert mesh.visibility is not None
        assert mesh.visibility.shape == (len(mesh.vertices), 1)
        x = mesh.vertices[:, 0]
        middle = (x + x.mean() * 0.05) / 1.05  # the corners are inset
        expected = 0.5 * (1 + middle / np.hypot(middle, height))
        np.testing.assert_allclose(mesh.visibility[:, 0], expected, atol=0.03)


def test_an_open_floor_is_open_and_a_sealed_room_is_closed():
    open_ = aolab.bake(of(floor(4.0)), rays=64, texels=8)
    assert (open_.instances[0].mesh.visibility == 1).all()
    room = aolab.bake(of(box((-1, -1, -1), (1, 1, 1)), camera=aolab.Camera((0, 0, 0.9), (0, 0, 0))), rays=64)
    outside = room.instances[0].mesh  # its normals point outwards
    assert (outside.visibility == 1).all()
    inner = Mesh(outside.vertices, outside.faces[:, ::-1], name="inner")
    assert (aolab.bake(of(inner), rays=64, radius=None).instances[0].mesh.visibility == 0).all()


def test_each_instance_has_the_occlusion_of_its_place():
    block = box((-0.5, 0, -0.5), (0.5, 1, 0.5))
    lifted = np.eye(4)
    lifted[:3, 3] = 5, 4, 0
    scene = aolab.Scene((Instance(floor(20.0)), Instance(block), Instance(block, lifted)))
    baked = aolab.bake(scene, rays=64, radius=1.0)
    standing, floating = (one.mesh.visibility for one in baked.instances[1:])
    assert standing is not None
    assert floating is not None
    assert floating.min() > 0.99
    assert standing.min() < 0.8
    assert baked.instances[1].mesh is not baked.instances[2].mesh


def test_a_texture_has_the_occlusion_between_the_vertices():
    """A block stands in the middle of a floor of two triangles: its vertices are open, its texels are not."""
    scene = of(floor(4.0), box((-0.5, 0, -0.5), (0.5, 1, 0.5)))
    baked = aolab.bake(scene, rays=128, radius=1.0, texels=32)
    material = baked.instances[0].mesh.material
    assert material.occlusion_texture is not None
    grey = material.occlusion_texture.pixels[..., 0]
    assert grey.shape == (32, 32)
    assert (grey[:6] == 255).all()
    assert grey[15, 13] < 200  # beside the block
    assert baked.instances[0].mesh.visibility.min() > 0.95
    assert baked.instances[1].mesh.material.occlusion_texture is None  # no UV


def test_texels_are_those_of_the_triangles_with_the_right_weights():
    uv = np.array([[(0.1, 0.1), (0.9, 0.1), (0.1, 0.9)]])
    texels = texels_of(uv, 20)
    assert texels is not None
    x, y = texels.place % 20 + 0.5, 20 - (texels.place // 20 + 0.5)
    np.testing.assert_allclose(texels.weights @ uv[0], np.stack([x, y], axis=1) / 20, atol=1e-12)
    inside = (x > 2) & (y > 2) & (x + y < 20 + 1e-9)
    assert inside.all()
    assert len(texels.place) == pytest.approx(0.5 * 16 * 16, abs=16)


def test_values_continue_beyond_seams():
    uv = np.array([[(0.25, 0.25), (0.75, 0.25), (0.25, 0.75)]])
    texels = texels_of(uv, 16)
    assert texels is not None
    picture = filled(texels, np.full(len(texels.place), 0.3), 16)
    assert (picture == 0.3).all()


@pytest.mark.parametrize("move", [(0.0, 0.0), (0.6, 0.0)])
def test_overlapping_and_tiling_uv_are_noticed_and_vertices_are_baked(move):
    mesh = quad((-1, 0, 1), (2, 0, 0), (0, 0, -2), name="carpet")
    twice = np.concatenate([mesh.faces, mesh.faces + 4])
    vertices = np.concatenate([mesh.vertices, mesh.vertices + np.array((3, 0, 0))])
    assert mesh.uv is not None
    doubled = Mesh(vertices, twice, uv=np.concatenate([mesh.uv, mesh.uv + move]), name="carpet")
    with pytest.warns(Notice, match=r"1 meshes have UV that leave \[0, 1\] or overlap \(carpet\)"):
        baked = aolab.bake(of(doubled), rays=32)
    assert baked.instances[0].mesh.visibility is not None
    assert baked.instances[0].mesh.material.occlusion_texture is None


def test_a_file_comes_back_with_its_occlusion_colours_and_places(tmp_path):
    red = Material((0.8, 0.1, 0.1), Texture(np.full((4, 4, 4), 200, np.uint8), "paint"), name="red")
    painted = quad((-2, 0, 2), (4, 0, 0), (0, 0, -4), red, "floor")
    block = box((-0.5, 0, -0.5), (0.5, 1, 0.5))
    colors = np.random.default_rng(0).random((len(block.vertices), 4))
    block = Mesh(block.vertices, block.faces, block.normals, colors=colors, name="block")
    place = np.eye(4)
    place[:3, 3] = 0.3, 0, 0.2
    baked = aolab.bake(aolab.Scene((Instance(painted), Instance(block, place))), rays=64, texels=16)
    path = tmp_path / "baked.glb"
    write_glb(baked, path)
    with pytest.warns(Notice, match="materials.occlusionTexture"):  # which renders do not read
        again = aolab.load(path)
    assert again.triangles == baked.triangles
    np.testing.assert_allclose(again.bounds, baked.bounds, atol=1e-6)
    for before, after in zip(baked.instances, again.instances, strict=True):
        np.testing.assert_allclose(after.mesh.visibility, before.mesh.visibility, atol=1e-6)
    assert again.instances[0].mesh.colors is None
    np.testing.assert_allclose(again.instances[1].mesh.colors, block.colors, atol=1e-6)
    assert again.instances[0].mesh.material.texture is not None
    # another tool multiplies the colours and reads the occlusion texture
    other = trimesh.load_scene(path)
    seen = {name.rpartition(" ")[0]: geometry.visual for name, geometry in other.geometry.items()}
    occlusion = seen["floor"].material.occlusionTexture
    assert occlusion.size == (16, 16)
    assert np.asarray(occlusion)[..., 0].min() < 250
    expected = np.rint(255 * baked.instances[0].mesh.visibility[:, 0])
    np.testing.assert_array_equal(seen["floor"].vertex_attributes["color"][:, 0], expected)


def test_a_file_comes_back_with_its_camera_lights_and_materials(tmp_path, lab):
    """The picture of the file is that of the scene: emission of 3, a scaled normal map, lights of three kinds."""
    waves = np.full((16, 16, 4), 255, np.uint8)
    waves[..., 0] = 128 + 60 * np.sin(np.arange(16) / 16 * 2 * np.pi)
    waves[..., 1] = 128
    wavy = Material((0.6, 0.5, 0.4), normal_texture=Texture(waves, "waves"), normal_scale=0.5, name="wavy")
    glowing = Material((0.2, 0.2, 0.2), emission=(3.0, 1.5, 0.0), name="glowing")
    ground = quad((-2, 0, 2), (4, 0, 0), (0, 0, -4), wavy, "floor")
    ball = box((-0.5, 0.2, -0.5), (0.5, 1, 0.5))
    ball = Mesh(ball.vertices, ball.faces, ball.normals, material=glowing, name="lamp")
    lights = (
        aolab.DirectionalLight((1, -2, -0.5), (1.0, 0.9, 0.8)),
        aolab.PointLight((-1, 1.5, 1), (0, 2, 4)),
        aolab.SpotLight((1.5, 2, 1), (-1, -1.5, -0.5), (5, 4, 3), inner=12, outer=33),
    )
    camera = aolab.Camera((0.5, 2.5, 4), (0, 0.2, 0), (0.2, 1, 0), fov=40)
    scene = aolab.Scene((Instance(ground), Instance(ball)), lights, camera=camera)
    baked = aolab.bake(scene, rays=8, texels=8)
    write_glb(baked, tmp_path / "baked.glb")
    with pytest.warns(Notice, match="materials.occlusionTexture"):
        again = aolab.load(tmp_path / "baked.glb")
    assert again.camera is not None
    np.testing.assert_allclose(again.camera.view_from_world, camera.view_from_world, atol=1e-6)
    assert again.camera.fov == pytest.approx(40)
    assert again.instances[1].mesh.material.emission == pytest.approx((3.0, 1.5, 0.0), rel=1e-5)
    assert again.instances[0].mesh.material.normal_scale == 0.5
    np.testing.assert_allclose(again.instances[0].mesh.tangents, baked.instances[0].mesh.tangents, atol=1e-6)
    for before, after in zip(lights, again.lights, strict=True):
        for name in vars(before):
            value = np.asarray(getattr(after, name), float)
            wanted = np.asarray(getattr(before, name), float)
            if name == "direction":
                wanted = wanted / np.linalg.norm(wanted)
            np.testing.assert_allclose(value, wanted, rtol=1e-5, atol=1e-6, err_msg=name)
    first, second = (
        lab.render(one.replace(environment=aolab.Environment.constant(0.3)), "none") for one in (baked, again)
    )
    assert np.abs(first["radiance"] - second["radiance"])[first.mask].mean() < 2e-3


def test_an_orthographic_camera_comes_back(tmp_path):
    camera = aolab.Camera((3, 2, 4), (0, 0, 0), ortho=2.5, near=0.5, far=40)
    write_glb(of(floor(1.0), camera=camera), tmp_path / "scene.glb")
    again = aolab.load(tmp_path / "scene.glb").camera
    assert again is not None
    assert (again.ortho, again.near, again.far) == pytest.approx((2.5, 0.5, 40))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"rays": 33}, "rays = 33 is not an even"),
        ({"texels": 0}, "texels = 0 is not a whole number from 1"),
        ({"radius": -1.0}, "radius = -1.0 is not a length"),
    ],
)
def test_wrong_values_are_refused_before_the_work(options, words):
    with pytest.raises(ParameterError, match=words):
        aolab.bake(of(floor(1.0)), **options)


def test_another_suffix_is_refused(tmp_path):
    with pytest.raises(FileError, match=r"a baked scene is written as \.glb"):
        write_glb(of(floor(1.0)), tmp_path / "scene.obj")


@pytest.mark.slow
def test_outside_its_region_hao_has_the_baked_visibility(lab):
    """Inside the region rays decide; outside, the vertices' visibility, or 1 without the parameter."""
    stripes = [quad((a, 0, 3), (1, 0, 0), (0, 0, -6), name="floor") for a in range(-3, 3)]
    block = box((1.0, 0, -0.5), (2.0, 1.0, 0.5))
    scene = aolab.bake(of(*stripes, block, camera=aolab.Camera((0, 5, 5), (0, 0, 0))), rays=128, radius=1.0)
    region = {"voxel_region": ((-3, -0.1, -3), (0, 0.1, 3)), "radius": 1.0, "scale": 1.0, "filter": "none"}
    frames = {outside: lab.render(scene, "hao", outside=outside, **region) for outside in ("open", "baked")}
    vertical = lab.render(scene, "none")
    right = vertical.mask & (np.arange(vertical.size[0]) > vertical.size[0] // 2 + 1)
    left = vertical.mask & (np.arange(vertical.size[0]) < vertical.size[0] // 2 - 2)
    assert np.nanmin(frames["open"]["visibility"][right]) == 1
    assert np.nanmin(frames["baked"]["visibility"][right]) < 0.9
    np.testing.assert_array_equal(frames["baked"]["visibility"][left], frames["open"]["visibility"][left])
    with_rays = lab.render(scene, "hao", radius=1.0, scale=1.0, filter="none", accumulate=4)["visibility"]
    assert np.abs(frames["baked"]["visibility"] - with_rays)[right].mean() < 0.12
