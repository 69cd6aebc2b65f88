"""Holes, blending and single sides: the part of a surface that is drawn, near and far, and that rays meet."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, Instance, Material, Mesh, Scene
from aolab.pipeline.textures import covering_levels
from aolab.scene.mesh import Texture

SIDE = 96


def blades(texels: int = 128) -> Texture:
    """Bars, a quarter of the area: four texels of sixteen in each row."""
    pixels = np.full((texels, texels, 4), 255, np.uint8)
    pixels[..., 3] = np.where(np.arange(texels) % 16 < 4, 255, 0)
    return Texture(pixels, "blades")


def sheet(material: Material, camera: Camera) -> Scene:
    """A square of two units that faces the camera."""
    mesh = small_scenes.quad((-1, -1, 0), (2, 0, 0), (0, 2, 0), material)
    return Scene((Instance(mesh),), (), small_scenes.SKY, camera)


def from_afar(texels_a_pixel: float, texels: int = 128) -> Camera:
    """A camera to which the square is texels / texels_a_pixel pixels wide."""
    return Camera((0, 0, 50), (0, 0, 0), ortho=2 * SIDE * texels_a_pixel / texels)


def share(frame: aolab.Frame, texels_a_pixel: float, texels: int = 128) -> float:
    """Of the square's pixels, how many are drawn."""
    return float(frame.mask.sum()) / (texels / texels_a_pixel) ** 2


@pytest.mark.parametrize("texels_a_pixel", [2, 3, 6, 12])
def test_a_cut_out_keeps_its_area_at_a_distance(lab, texels_a_pixel):
    material = Material((1, 1, 1), blades(1024), alpha_cutoff=0.5)
    frame = lab.render(sheet(material, from_afar(texels_a_pixel, 1024)), "none", size=(SIDE, SIDE))
    seen = min(SIDE, 1024 / texels_a_pixel) ** 2
    assert frame.mask.sum() / seen == pytest.approx(0.25, abs=0.04)  # drivers choose levels a little differently


@pytest.mark.filterwarnings("ignore:nothing is drawn:aolab.Notice")
@pytest.mark.parametrize(("alpha", "drawn"), [(0.7, 0.25), (0.3, 0.0)])
@pytest.mark.parametrize("where", ["material", "vertices"])
def test_the_alpha_of_the_rest_of_a_material_cuts_at_a_distance_as_it_does_from_near(lab, alpha, drawn, where):
    """Alphas of 1 and 0 times 0.7 are over and under a cutoff of 0.5: no less of the blades is seen."""
    material = Material((1, 1, 1), blades(1024), alpha_cutoff=0.5, alpha=alpha if where == "material" else 1.0)
    scene = sheet(material, from_afar(6, 1024))
    if where == "vertices":
        mesh = scene.instances[0].mesh
        colors = np.tile((1, 1, 1, alpha), (len(mesh.vertices), 1))
        mesh = Mesh(mesh.vertices, mesh.faces, mesh.normals, mesh.uv, colors, material)
        scene = scene.replace(instances=(Instance(mesh),))
    frame = lab.render(scene, "none", size=(SIDE, SIDE))
    assert frame.mask.mean() == pytest.approx(drawn, abs=0.03 if drawn else 0)


@pytest.mark.parametrize("cutoff", [0.2, 0.9])
def test_a_texture_without_smaller_levels_is_cut_at_its_cutoff_at_a_distance(lab, cutoff):
    """A ramp of alpha: without mip levels, a pixel shows a texel, which is cut or not."""
    pixels = np.full((256, 256, 4), 255, np.uint8)
    pixels[..., 3] = np.random.default_rng(1).permutation(np.arange(256 * 256) % 256).reshape(256, 256)
    material = Material((1, 1, 1), Texture(pixels, nearest=True, mipmaps=False), alpha_cutoff=cutoff)
    frame = lab.render(sheet(material, from_afar(2.7, 256)), "none", size=(SIDE, SIDE))
    assert frame.mask.sum() / (256 / 2.7) ** 2 == pytest.approx(1 - cutoff, abs=0.03)


def test_a_cut_out_is_sharp_from_near(lab):
    material = Material((1, 1, 1), blades(), alpha_cutoff=0.5)
    frame = lab.render(sheet(material, from_afar(0.25)), "none", size=(SIDE, SIDE))
    rows = frame.mask.reshape(SIDE, SIDE)
    assert (rows == rows[SIDE // 2]).all(), "a bar has a straight edge"


def test_mip_levels_hold_the_share_and_the_colour_that_is_seen():
    pixels = blades(16).pixels.copy()
    pixels[..., :3] = np.where(pixels[..., 3:] > 0, (200, 100, 50), (0, 0, 255))  # the holes are blue, and unseen
    levels = covering_levels(pixels, 0.5)
    assert [level.shape[:2] for level in levels] == [(8, 8), (4, 4), (2, 2), (1, 1)]
    assert levels[-1][0, 0, 3] == 64
    assert levels[0][0, :, 3].tolist() == [255, 255, 0, 0, 0, 0, 0, 0]
    np.testing.assert_allclose(levels[-1][0, 0, :3], (200, 100, 50), atol=1)


@pytest.mark.parametrize("alpha", [0.2, 0.5, 0.8])
def test_blending_is_a_share_of_the_pixels(lab, alpha):
    frame = lab.render(sheet(Material((1, 1, 1), alpha=alpha, blend=True), from_afar(2)), "none", size=(SIDE, SIDE))
    assert share(frame, 2) == pytest.approx(alpha, abs=0.03)


def test_blended_surfaces_behind_each_other_hide_other_pixels(lab):
    """Two of one half leave a quarter open, not a half: their patterns differ."""
    material = Material((1, 1, 1), alpha=0.5, blend=True)
    meshes = [small_scenes.quad((-1, -1, z), (2, 0, 0), (0, 2, 0), material) for z in (0, 1)]
    scene = Scene(tuple(map(Instance, meshes)), (), small_scenes.SKY, from_afar(2))
    assert share(lab.render(scene, "none", size=(SIDE, SIDE)), 2) == pytest.approx(0.75, abs=0.05)


def test_instances_of_a_blended_mesh_hide_other_pixels(lab):
    material = Material((1, 1, 1), alpha=0.5, blend=True)
    pane = small_scenes.quad((-1, -1, 0), (2, 0, 0), (0, 2, 0), material)
    deep = np.eye(4)
    instances = []
    for z in range(3):
        deep[2, 3] = z
        instances.append(Instance(pane, deep.copy()))
    scene = Scene(tuple(instances), (), small_scenes.SKY, from_afar(2))
    assert share(lab.render(scene, "none", size=(SIDE, SIDE)), 2) == pytest.approx(0.875, abs=0.05)


def test_both_walls_of_a_blended_solid_hide(lab):
    """A box of alpha 0.5: its near and its far wall leave a quarter open."""
    box = small_scenes.box((-1, -1, -1), (1, 1, 1), Material((1, 1, 1), alpha=0.5, blend=True))
    frame = lab.render(Scene((Instance(box),), (), small_scenes.SKY, from_afar(2)), "none", size=(SIDE, SIDE))
    assert share(frame, 2) == pytest.approx(0.75, abs=0.05)


@pytest.mark.parametrize(("alpha", "blend"), [(0.3, True), (1.0, False)])
def test_a_blended_roof_occludes_by_its_alpha_in_the_truth(alpha, blend):
    roof = small_scenes.quad((-50, 1, 50), (100, 0, 0), (0, 0, -100), Material((1, 1, 1), alpha=alpha, blend=blend))
    camera = Camera((0, 0.9, 0.1), (0, 0, 0))
    scene = small_scenes.of(small_scenes.floor(), roof, camera=camera)
    truth = aolab.reference(scene, size=(16, 12), rays=256, radius=1000.0, buffers="visibility", cache=False)
    assert np.nanmean(truth["visibility"]) == pytest.approx(1 - alpha, abs=0.02)


def turned(mesh: Mesh) -> Mesh:
    """The same triangles with their corners the other way round."""
    return Mesh(mesh.vertices, mesh.faces[:, ::-1], mesh.normals, material=mesh.material, name=mesh.name)


def test_a_single_sided_hull_shows_what_it_holds(lab):
    """A black hull, fronts inside, around a red box: an outline. Lights and rays pass its backs, too."""
    red = small_scenes.box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5), Material((0.9, 0.1, 0.1)))
    hull = small_scenes.box((-0.53, -0.53, -0.53), (0.53, 0.53, 0.53), Material((0, 0, 0), double_sided=False))
    scene = Scene(
        (Instance(red), Instance(turned(hull))),
        (aolab.DirectionalLight((0, 0, -1)),),
        small_scenes.SKY,
        Camera((0, 0, 4), (0, 0, 0)),
    )
    frame = lab.render(scene, "none", size=(64, 64))
    np.testing.assert_allclose(frame["albedo"][32, 32, :3], (0.9, 0.1, 0.1), atol=1e-3)
    assert frame["direct"][32, 32, 0] == pytest.approx(0.9 / np.pi, rel=0.02)  # the near side casts no shadow
    dark = frame.mask & (frame["albedo"][..., 0] < 0.1)
    assert 20 < dark.sum() < 400  # the outline


@pytest.mark.parametrize("mirrored", [1, -1])
def test_rays_pass_the_backs_of_single_sided_surfaces(mirrored):
    """A roof that is there only from above lets the sky through; turned round it closes it, mirrored or not."""
    roof = small_scenes.quad((-50, 1, 50), (100, 0, 0), (0, 0, -100), Material(double_sided=False))
    matrix = np.diag([mirrored, 1.0, 1.0, 1.0])
    for mesh, visibility in ((roof, 1.0), (turned(roof), 0.0)):
        instances = Instance(small_scenes.floor()), Instance(mesh, matrix)
        scene = Scene(instances, (), small_scenes.SKY, Camera((0, 0.9, 0.1), (0, 0, 0)))
        truth = aolab.reference(scene, size=(16, 12), rays=64, radius=1000.0, buffers="visibility", cache=False)
        assert np.nanmean(truth["visibility"]) == pytest.approx(visibility, abs=0.02)


@pytest.mark.parametrize("wrap", ["repeat", "mirror", "clamp"])
@pytest.mark.parametrize("nearest", [True, False])
def test_rays_see_a_texture_as_the_picture_does(lab, wrap, nearest):
    """The truth looks the albedo up at the points that rays meet: the light that a surface sends depends on it."""
    rng = np.random.default_rng(3)
    pixels = np.dstack([rng.integers(0, 256, (4, 4, 3), np.uint8), np.full((4, 4), 255, np.uint8)])
    texture = Texture(pixels, "noise", wrap=(wrap, wrap), nearest=nearest, mipmaps=False)
    mesh = small_scenes.quad((-1, -1, 0), (2, 0, 0), (0, 2, 0), Material((1, 1, 1), texture))
    mesh = Mesh(mesh.vertices, mesh.faces, mesh.normals, mesh.uv * 3 - 1, material=mesh.material)
    camera = Camera((0, 0, 50), (0, 0, 0), ortho=2)
    scene = Scene((Instance(mesh),), (), small_scenes.SKY, camera)
    frame = lab.render(scene, "none", size=(60, 60))
    from aolab.truth.world import World

    world = World(scene)
    x, y = np.meshgrid((np.arange(60) + 0.5) / 30 - 1, 1 - (np.arange(60) + 0.5) / 30)
    origins = np.stack([x, y, np.full_like(x, 5)], axis=-1).reshape(-1, 3).astype(np.float32)
    hits = world.first_hit(origins, np.tile(np.float32([0, 0, -1]), (3600, 1)), np.inf)
    seen = world.albedo(hits.triangle, hits.u, hits.v).reshape(60, 60, 3)
    differs = np.abs(seen - frame["albedo"][..., :3]).max(axis=2) > 0.02
    assert differs.mean() < 0.02  # texels' edges may fall on either side
