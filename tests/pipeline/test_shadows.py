"""Shadow maps' resolution and bias, and the gap of the bias filled in image space, against geometry."""

from dataclasses import replace

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, DirectionalLight, Environment, Material, Module, PointLight, Scene, SpotLight
from aolab.gl import context
from aolab.pipeline import lighting
from aolab.pipeline.shadows import ShadowSettings
from aolab.scene.lights import Light

DARK = Environment.constant(0.0)
GREY = Material((0.8, 0.8, 0.8))
LOW, HIGH = np.array([-0.3, 0.0, -0.3]), np.array([0.3, 0.12, 0.3])  # a tile on the floor, lower than the bias is long
CAMERA = Camera((0.6, 2.6, 1.6), (0.1, 0, 0), fov=30)
COARSE = {"size": (160, 120), "shadow_resolution": 64}
KINDS = ["directional", "spot", "point"]
pytestmark = pytest.mark.filterwarnings("ignore:.* meshes are not closed:aolab.errors.Notice")  # nor is a floor


def light(kind: str, shadow: bool = True) -> Light:
    """From the left, 27° above the floor."""
    if kind == "directional":
        return DirectionalLight((1, -0.5, 0.1), shadow=shadow)
    if kind == "point":
        return PointLight((-4, 2, -0.4), (40, 40, 40), shadow=shadow)
    return SpotLight((-4, 2, -0.4), (1, -0.5, 0.1), (40, 40, 40), inner=24, outer=25, shadow=shadow)


def scene(kind: str, shadow: bool = True, *, tile: bool = True) -> Scene:
    more = [small_scenes.box(LOW, HIGH, GREY)] if tile else []
    return small_scenes.of(small_scenes.floor(3, GREY), *more, camera=CAMERA, lights=(light(kind, shadow),), sky=DARK)


def shaded_share(lab, kind: str, **settings) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The share of the light that arrives, (H, W); and where the geometry shades the floor for sure, and where not."""
    frame, open = (lab.render(scene(kind, on), "none", **COARSE, **(settings if on else {})) for on in (True, False))
    position = small_scenes.world_positions(frame, CAMERA)
    one = light(kind)
    way = -20 * np.asarray(one.direction) if isinstance(one, DirectionalLight) else np.asarray(one.position) - position

    def shaded(grow: float) -> np.ndarray:
        with np.errstate(divide="ignore", invalid="ignore"):
            a, b = (LOW - grow - position) / way, (HIGH + grow - position) / way
        enter, leave = np.minimum(a, b).max(axis=-1), np.maximum(a, b).min(axis=-1)
        return (enter < leave) & (leave > 0)

    floor = np.abs(position[..., 1]) < 1e-3
    share = frame["direct"][..., 0] / np.maximum(open["direct"][..., 0], 1e-9)
    return share, floor & shaded(-0.02), floor & ~shaded(0.02)


@pytest.mark.parametrize("occluders", ["depth", "layers", "views"])
@pytest.mark.parametrize("kind", KINDS)
def test_samples_on_the_screen_find_the_shadow_that_the_bias_loses(lab, kind, occluders):
    lost, shaded, _ = shaded_share(lab, kind)
    found, _, _ = shaded_share(lab, kind, fill=16, occluders=occluders)
    assert shaded.sum() > 100
    assert lost[shaded].mean() > 0.3  # the shadow map alone leaves much light there
    assert found[shaded].mean() < 0.5 * lost[shaded].mean()
    assert (found <= lost + 1e-3).all()  # the fill only takes light away


@pytest.mark.parametrize("kind", KINDS)
def test_the_contact_shadow_begins_at_the_contact(lab, kind):
    """The floor beside the tile's far side is dark in the very first pixels."""
    share, _, _ = shaded_share(lab, kind, fill=16)
    classic, _, _ = shaded_share(lab, kind)
    position = small_scenes.world_positions(lab.render(scene(kind), "none", **COARSE), CAMERA)
    x, y, z = np.moveaxis(position, -1, 0)
    contact = (np.abs(y) < 1e-3) & (x > 0.3) & (x < 0.3 + 2 * 0.012) & (np.abs(z) < 0.2)  # a pixel is 0.012 wide
    assert contact.sum() > 20
    assert share[contact].mean() < 0.1
    assert classic[contact].mean() > 0.5


@pytest.mark.parametrize("occluders", ["depth", "layers", "views"])
@pytest.mark.parametrize("kind", KINDS)
def test_a_lit_plane_stays_lit(lab, kind, occluders):
    with_map, without = (lab.render(scene(kind, on, tile=False), "none", **COARSE) for on in (True, False))
    filled = lab.render(scene(kind, tile=False), "none", **COARSE, fill=16, occluders=occluders)
    np.testing.assert_array_equal(with_map["direct"], without["direct"])
    np.testing.assert_allclose(filled["direct"], without["direct"], rtol=1 - small_scenes.OPEN)


@pytest.mark.parametrize("kind", KINDS)
def test_without_a_bias_a_plane_shades_itself(lab, kind):
    none, without = (
        lab.render(scene(kind, on, tile=False), "none", shadow_bias="none", **COARSE)["direct"] for on in (True, False)
    )
    lit = without[..., 0] > 0.02
    assert 0.2 < (none[lit] / without[lit]).mean() < 0.9
    # without a gap there is nothing to fill
    filled = lab.render(scene(kind, tile=False), "none", shadow_bias="none", fill=16, **COARSE)["direct"]
    np.testing.assert_allclose(filled, none, rtol=1 - small_scenes.OPEN)


@pytest.mark.parametrize("bias", [6.0, 12.0])
@pytest.mark.parametrize("degrees", [45, 60])
def test_the_gap_is_the_bias_times_half_a_texel_times_the_slope(lab, degrees, bias):
    """A sheet over the floor shades it if the way along the light is longer than b = bias (p/2) tan α, else not."""
    angle = np.radians(degrees)
    sun = DirectionalLight((np.sin(angle), -np.cos(angle), 0))
    shares = []
    for way in (0.35, 1.65):  # as multiples of b: comparisons 1.75 texels away see 1.75 texels of slope less or more
        height = 0.0
        for _ in range(20):  # the texels' width depends on the scene's size, and so on the height
            bare = small_scenes.of(small_scenes.floor(3), small_scenes.quad((-3, height, 3), (6, 0, 0), (0, 0, -6)))
            texel = 2 * bare.radius / 64
            height = way * bias * texel / 2 * np.tan(angle) * np.cos(angle)
        sheet = small_scenes.quad((-3, height, 3), (6, 0, 0), (0, 0, -6))
        eye = Camera((-0.5, height / 2, 0.5), (0, 0, 0))
        roofed = small_scenes.of(small_scenes.floor(3), sheet, camera=eye, lights=(sun,), sky=DARK)
        frame = lab.render(roofed, "none", shadow_resolution=64, shadow_bias=bias)
        position = small_scenes.world_positions(frame, eye)
        near = (np.abs(position[..., 1]) < 1e-3) & (np.linalg.norm(position, axis=-1) < 0.4)
        assert near.sum() > 50
        shares.append(frame["direct"][near, 0].mean() * np.pi / np.cos(angle))
    assert shares[0] > 0.9
    assert shares[1] < 0.1


def test_the_settings_of_a_module():
    assert ShadowSettings.of(Module(shadow_bias=4.0, shadow_resolution=128)) == ShadowSettings(128, 2.0)
    assert ShadowSettings.of(Module()) == ShadowSettings(None, 3.0)
    assert ShadowSettings.of(Module(shadow_bias="none")).slope_bias == 0


def test_a_finer_map_leaves_a_smaller_gap(lab):
    errors = []
    for resolution in (32, 128, 512):
        frame, open = (
            lab.render(scene("directional", on), "none", size=(160, 120), shadow_resolution=resolution)["direct"]
            for on in (True, False)
        )
        _, shaded, _ = shaded_share(lab, "directional")
        errors.append(frame[shaded].mean() / open[shaded].mean())
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.05


@pytest.mark.parametrize("module", ["none", "ssao", "ssdo", "s3ho", "ssbn"])
def test_every_module_may_fill(lab, module):
    """Also where a method has a direct light of its own, and where lights are sampled on the screen already."""
    size = {"radius": 0.05} if module != "none" else {}
    lost, found = (lab.render(scene("spot"), module, **COARSE, **size, fill=fill)["direct"] for fill in (0, 16))
    assert found.sum() < 0.99 * lost.sum()
    if module == "ssdo":
        sampled = {"light_steps": 2, **size}
        lost, found = (lab.render(scene("spot"), module, **COARSE, **sampled, fill=fill)["direct"] for fill in (0, 16))
        assert found.sum() < 0.99 * lost.sum()


@pytest.mark.parametrize(("lights", "columns", "rows"), [(1, 1, 1), (2, 2, 1), (3, 2, 2), (5, 3, 2), (7, 3, 3)])
def test_the_atlas_has_no_more_rows_than_its_maps_need(lab, lights, columns, rows):
    frame = lab.render(scene("spot").replace(lights=(light("spot"),) * lights), "none", **COARSE)
    frame.complete()
    assert frame.lit.lights.lamps.textures["shadow_atlas"].size == (64 * columns, 64 * rows)


def test_maps_that_the_driver_has_no_room_for_are_refused_with_the_largest_that_fit(lab):
    lights = tuple(PointLight((x, 2, 0)) for x in range(40))
    crowd = scene("spot").replace(lights=lights)
    limit = context.get().info["GL_MAX_TEXTURE_SIZE"]
    tile = limit // 8
    message = rf"240 shadow maps of {tile} pixels a side need an atlas of {16 * tile}x{15 * tile}.*At most \d+ such"
    with pytest.raises(aolab.ParameterError, match=message):
        lab.render(crowd, "none", shadow_resolution=tile).complete()
    with pytest.raises(aolab.ParameterError, match="shadow_resolution = 8 is not valid"):
        lab.render(crowd, "none", shadow_resolution=8)
    with pytest.raises(aolab.ParameterError, match="shadow_bias = 'slope' is not valid"):
        lab.render(crowd, "none", shadow_bias="slope")


@pytest.mark.parametrize("kind", ["directional", "spot"])
def test_one_tile_in_uniforms_is_the_row_of_the_table(kind, monkeypatch):
    """Scenes with one tile, and with suns alone, have shorter shaders: the light is that of the plain ones."""
    short = aolab.Lab((96, 72)).render(scene(kind), "none")["direct"]
    lamps = lighting.lamps

    def plain(*given):
        made = lamps(*given)
        assert made.constants["one_tile"]
        assert made.constants["suns_alone"] == (kind == "directional")
        return replace(made, constants={**made.constants, "one_tile": False, "suns_alone": False})

    monkeypatch.setattr(lighting, "lamps", plain)
    np.testing.assert_array_equal(short, aolab.Lab((96, 72)).render(scene(kind), "none")["direct"])


def test_lights_of_several_tiles_or_kinds_read_the_table(monkeypatch):
    lamps, seen = lighting.lamps, []
    monkeypatch.setattr(lighting, "lamps", lambda *given: seen.append(lamps(*given)) or seen[-1])
    both = scene("directional").replace(lights=(light("directional"), light("spot")))
    for one in (scene("point"), both):
        assert aolab.Lab((32, 24)).render(one, "none")["direct"].any()
    assert [(made.constants["one_tile"], made.constants["suns_alone"]) for made in seen] == [(False, False)] * 2
