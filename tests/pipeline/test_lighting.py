"""Light on surfaces, against radiometry; shadows, against geometry."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, DirectionalLight, Environment, Instance, Material, Mesh, PointLight, Scene, SpotLight, Texture
from aolab.pipeline.shadows import TILE_SIZES
from aolab.scene.lights import Light

DARK = Environment.constant(0.0)
ALBEDO = Material((0.8, 0.5, 0.25))
DOWN = Camera((0, 6, 0), (0, 0, 0), up=(0, 0, -1), fov=40)  # straight down on the floor: right is +x, up is -z


def floor_under(*lights, camera=DOWN, sky=DARK, material=ALBEDO, more=()) -> Scene:
    return small_scenes.of(small_scenes.floor(4, material), *more, camera=camera, lights=lights, sky=sky)


def kinds(shadow: bool = True) -> dict[str, Light]:
    """A light of each kind, from the upper left."""
    return {
        "directional": DirectionalLight((1, -2, 0.3), shadow=shadow),
        "point": PointLight((-2, 4, -0.6), (30, 30, 30), shadow=shadow),
        "spot": SpotLight((-2, 4, -0.6), (0.5, -1, 0.15), (30, 30, 30), inner=30, outer=45, shadow=shadow),
    }


def towards(light: Light, position: np.ndarray) -> np.ndarray:
    """(H, W, 3): from each position to the light, or far out of the scene towards a sun."""
    if isinstance(light, DirectionalLight):
        return np.broadcast_to(-20 * np.asarray(light.direction), position.shape)
    return np.asarray(light.position) - position


# --- irradiance


def test_a_sun_on_a_facing_plane(lab):
    """Radiance = albedo / π · E."""
    frame = lab.render(floor_under(DirectionalLight((0, -1, 0), (2.0, 1.0, 0.5))), "none")
    expected = np.array([0.8 * 2.0, 0.5 * 1.0, 0.25 * 0.5]) / np.pi
    np.testing.assert_allclose(frame["direct"], np.broadcast_to(expected, frame["direct"].shape), rtol=1e-3)


@pytest.mark.parametrize("degrees", [0, 30, 60, 85])
def test_a_sun_falls_off_with_the_cosine(lab, degrees):
    angle = np.radians(degrees)
    sun = DirectionalLight((3 * np.sin(angle), -3 * np.cos(angle), 0))  # its length means nothing
    frame = lab.render(floor_under(sun), "none")
    np.testing.assert_allclose(frame["direct"][..., 0], 0.8 / np.pi * np.cos(angle), rtol=2e-3)


def test_a_light_from_below_does_not_reach(lab):
    for light in (DirectionalLight((0, 1, 0)), PointLight((0, -1, 0), shadow=False)):
        assert not lab.render(floor_under(light), "none")["direct"].any()


def test_a_bulb_falls_off_with_the_squared_distance(lab):
    height, intensity = 3.0, 9.0
    scene = floor_under(PointLight((0, height, 0), (intensity, 0, 0)))
    frame = lab.render(scene, "none")
    x, _, z = np.moveaxis(small_scenes.world_positions(frame, DOWN), -1, 0)
    squared = x**2 + z**2 + height**2
    expected = 0.8 / np.pi * intensity / squared * height / np.sqrt(squared)
    np.testing.assert_allclose(frame["direct"][..., 0], expected, rtol=3e-3)
    assert not frame["direct"][..., 1:].any()


def test_a_spot_is_a_bulb_inside_its_inner_cone_and_nothing_outside_the_outer(lab):
    height = 3.0
    lamp = {"position": (0, height, 0), "intensity": (9.0, 9.0, 9.0)}
    spot = SpotLight(direction=(0, -2, 0), inner=15, outer=25, **lamp)  # type: ignore[arg-type]
    spotted, bulb = (lab.render(floor_under(light), "none") for light in (spot, PointLight(**lamp)))  # type: ignore[arg-type]
    x, _, z = np.moveaxis(small_scenes.world_positions(spotted, DOWN), -1, 0)
    angle = np.degrees(np.arctan2(np.hypot(x, z), height))
    inside, outside = angle < 14.9, angle > 25.1
    assert inside.sum() > 50
    assert outside.sum() > 50
    np.testing.assert_allclose(spotted["direct"][inside], bulb["direct"][inside], rtol=2e-3)
    assert not spotted["direct"][outside].any()
    # KHR_lights_punctual: the square of a ramp over the cosine
    between = ~inside & ~outside
    low, high = np.cos(np.radians([25, 15]))
    ramp = np.clip((np.cos(np.radians(angle)) - low) / (high - low), 0, 1) ** 2
    share = spotted["direct"][..., 0] / bulb["direct"][..., 0]
    np.testing.assert_allclose(share[between], ramp[between], atol=0.01)


def test_lights_add_up(lab):
    lights = kinds()
    together = lab.render(floor_under(*lights.values()), "none")["direct"]
    alone = sum(lab.render(floor_under(light), "none")["direct"] for light in lights.values())
    np.testing.assert_allclose(together, alone, rtol=3e-3, atol=1e-4)


# --- ambient


def test_a_constant_sky_reflects_albedo_times_visibility(lab, boxes):
    """ambient = albedo / π · π L · visibility."""
    frame = lab.render(boxes.replace(environment=Environment.constant((0.5, 1.0, 2.0))), "ssao")
    expected = frame["albedo"] * (0.5, 1.0, 2.0) * np.nan_to_num(frame["visibility"])[..., None]
    np.testing.assert_allclose(frame["ambient"], expected, atol=2e-3)
    assert frame["visibility"][frame.mask].min() < 0.9  # the boxes do shade each other


def test_a_gradient_sky_lights_each_side_by_its_irradiance(lab):
    sky = Environment.sky()
    for normal, camera in (((0, 1, 0), DOWN), ((0, -1, 0), Camera((0, -6, 0), (0, 0, 0), up=(0, 0, 1)))):
        frame = lab.render(floor_under(camera=camera, sky=sky), "none")
        expected = np.array(ALBEDO.base_color) / np.pi * sky.irradiance(np.array(normal, float))
        np.testing.assert_allclose(frame["ambient"][24, 32], expected, rtol=2e-3)


def test_occlusion_never_darkens_direct_light(lab, boxes):
    scene = boxes.replace(lights=tuple(kinds().values()))
    without, within = lab.render(scene, "none"), lab.render(scene, "ssao", radius=2.0)
    np.testing.assert_array_equal(within["direct"], without["direct"])
    assert within["ambient"].sum() < without["ambient"].sum()


def test_radiance_is_the_sum_and_exposure_multiplies_it_before_the_tone_map(lab, boxes):
    scene = boxes.replace(lights=(DirectionalLight((1, -2, -1)),))
    frame = lab.render(scene, "ssao", exposure=1.0, tone_map="linear")
    total = frame["direct"] + frame["ambient"]
    np.testing.assert_allclose(frame["radiance"][frame.mask], total[frame.mask], rtol=2e-3)

    half = lab.render(scene, "ssao", exposure=0.5, tone_map="linear")
    np.testing.assert_array_equal(half["radiance"], frame["radiance"])
    linear = np.clip(0.5 * frame["radiance"], 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(half.image, 255 * srgb, atol=1)


# --- shadows


@pytest.mark.parametrize("kind", kinds())
def test_a_boxs_shadow_is_the_shadow_of_its_geometry(lab, kind):
    """A post on the floor; a floor point is in shadow when the segment towards the light passes through the post."""
    low, high = np.array([-0.3, 0.0, -0.3]), np.array([0.3, 1.2, 0.3])
    light = kinds()[kind]
    scene = floor_under(light, more=[small_scenes.box(low, high)])
    frame = lab.render(scene, "none", size=(160, 120))
    position = small_scenes.world_positions(frame, DOWN)
    on_floor = np.abs(position[..., 1]) < 1e-3
    way = towards(light, position)

    def in_shadow(grow: float) -> np.ndarray:
        with np.errstate(divide="ignore", invalid="ignore"):
            a, b = (low - grow - position) / way, (high + grow - position) / way
        enter, leave = np.minimum(a, b).max(axis=-1), np.maximum(a, b).min(axis=-1)
        return (enter < leave) & (leave > 0) & (enter < 1)

    lit = lab.render(
        floor_under(kinds(shadow=False)[kind], more=[small_scenes.box(low, high)]), "none", size=(160, 120)
    )
    deep = on_floor & in_shadow(-0.03)  # a texel of these maps is 0.006 to 0.012 units, and 3.5 of them are blended
    free = on_floor & ~in_shadow(0.03)
    assert (lit["direct"][deep, 0] > 0.01).sum() > 200
    assert free.sum() > 2000
    assert (frame["direct"][deep] <= 0.02 * lit["direct"][deep]).all()
    np.testing.assert_array_equal(frame["direct"][free], lit["direct"][free])


@pytest.mark.parametrize("degrees", [0, 20, 45, 70, 80, 85])
@pytest.mark.parametrize("kind", ["directional", "point", "spot"])
def test_a_lit_plane_has_no_acne(lab, kind, degrees):
    """Every pixel of a plane, facing the light or nearly edge-on, is fully lit by its own shadow map."""
    angle = np.radians(degrees)
    way = np.array([np.sin(angle), -np.cos(angle), 0.1])
    position = tuple(-5 * way)

    def light(shadow: bool):
        if kind == "directional":
            return DirectionalLight(tuple(way), shadow=shadow)
        if kind == "point":
            return PointLight(position, (25, 25, 25), shadow=shadow)
        return SpotLight(position, tuple(way), (25, 25, 25), inner=20, outer=30, shadow=shadow)

    for camera in (DOWN, Camera((0, 1, 5), (0, 0, 0))):
        with_map, without = (
            lab.render(floor_under(light(on), camera=camera), "none")["direct"] for on in (True, False)
        )
        assert without.any()
        np.testing.assert_array_equal(with_map, without)


@pytest.mark.parametrize("kind", kinds())
def test_a_closed_sphere_has_no_acne_where_it_is_lit(lab, kind):
    """Curved and facing every way: wrong shadows only within a few degrees of the terminator."""
    ball = small_scenes.sphere(1, (0, 1.5, 0), subdivisions=5)
    camera = Camera((-3, 4, 2), (0, 1.5, 0), fov=40)
    frames = [lab.render(floor_under(k[kind], camera=camera, more=[ball]), "none") for k in (kinds(True), kinds(False))]
    position = small_scenes.world_positions(frames[0], camera)
    normal = position - (0, 1.5, 0)
    on_ball = np.abs(np.linalg.norm(normal, axis=-1) - 1) < 1e-2
    way = towards(kinds()[kind], position)
    cosine = (normal * way).sum(axis=-1) / np.linalg.norm(way, axis=-1)
    facing = on_ball & (cosine > 0.15)
    assert facing.sum() > 200
    # where two of the triangles meet, the blended comparisons reach over the edge: 2 %
    np.testing.assert_allclose(frames[0]["direct"][facing], frames[1]["direct"][facing], rtol=0.03)


@pytest.mark.parametrize("kind", kinds())
def test_a_light_without_shadow_shines_through(lab, kind):
    post = small_scenes.box((-0.3, 0, -0.3), (0.3, 1.2, 0.3))
    shaded, through = (lab.render(floor_under(kinds(on)[kind], more=[post]), "none")["direct"] for on in (True, False))
    assert (shaded == 0).sum() > (through == 0).sum()


def test_shadows_follow_the_lights_and_the_geometry(lab):
    """Shadow maps are kept between frames; they must not be kept too long."""
    post, moved = (small_scenes.box((x - 0.3, 0, -0.3), (x + 0.3, 1.2, 0.3)) for x in (0.0, 1.0))
    sun, evening = DirectionalLight((1, -2, 0.3)), DirectionalLight((-1, -2, 0.3))
    first = lab.render(floor_under(sun, more=[post]), "none")["direct"]
    for scene in (floor_under(evening, more=[post]), floor_under(sun, more=[moved])):
        assert not np.array_equal(lab.render(scene, "none")["direct"], first)
        np.testing.assert_array_equal(
            lab.render(scene, "none")["direct"], aolab.Lab((64, 48)).render(scene, "none")["direct"]
        )
    np.testing.assert_array_equal(lab.render(floor_under(sun, more=[post]), "none")["direct"], first)


def test_a_shadows_edge_is_a_ramp_over_two_and_a_half_texels(lab):
    """Four comparisons 1.5 texels apart, each interpolated over one (glsl/lib/light.glsl): 1.5 + 1 texels together."""
    edge = 0.0031  # off a texel's border
    roof = small_scenes.box((-4, 1, -4), (edge, 1.2, 4))
    scene = floor_under(DirectionalLight((0, -1, 0)), more=[roof])
    texel = 2 * scene.radius / TILE_SIZES[4]
    away = 0.4 * np.sqrt(2)
    # 8 texels across, seen from under the roof's edge
    camera = Camera((edge + 0.4, 0.4, 0), (edge, 0, 0), up=(0, 0, -1), fov=np.degrees(8 * texel / away))
    shadowed, open = (
        lab.render(
            floor_under(DirectionalLight((0, -1, 0), shadow=on), camera=camera, more=[roof]), "none", size=(96, 96)
        )
        for on in (True, False)
    )
    across = (small_scenes.world_positions(shadowed, camera)[..., 0] - edge) / texel
    share = shadowed["direct"][..., 0] / open["direct"][..., 0]
    assert across[share < 0.98].max() - across[share > 0.02].min() == pytest.approx(2.5, abs=0.3)
    steps = np.diff(share[48][np.argsort(across[48])])
    assert steps.min() > -0.01  # it only rises, without a jump: a pixel is an eighth of a texel
    assert steps.max() < 0.15


def test_holes_of_a_cut_out_texture_let_light_through(lab):
    pixels = np.full((1, 2, 4), 255, np.uint8)
    pixels[0, 0, 3] = 0
    leaf = Material((1.0, 1.0, 1.0), Texture(pixels), alpha_cutoff=0.5)
    roof = small_scenes.quad((-1, 2, 1), (2, 0, 0), (0, 0, -2), leaf)
    camera = Camera((0, 0.5, 3), (0, 0, 0), fov=60)
    frame = lab.render(floor_under(DirectionalLight((0, -1, 0)), camera=camera, more=[roof]), "none", size=(96, 72))
    x, y, z = np.moveaxis(small_scenes.world_positions(frame, camera), -1, 0)
    under = (np.abs(y) < 1e-3) & (np.abs(z) < 0.9)
    assert (frame["direct"][under & (x > 0.1) & (x < 0.9), 0] == 0).all()
    assert (frame["direct"][under & (x < -0.1) & (x > -0.9), 0] > 0.2).all()


def test_too_many_shadow_tiles_are_refused_with_the_way_out(lab):
    lights = tuple(PointLight((x, 2, 0)) for x in range(43))
    message = r"43 lights \(43 of them points.*258 shadow tiles.*limit is 256.*shadow=False"
    with pytest.raises(aolab.SceneError, match=message):
        lab.render(floor_under(*lights), "none").complete()


def test_more_lights_than_a_uniform_array_has_matrices_for_cast_their_own_shadows(lab):
    """70 lamps, 70 tiles: the shadow of the post from each lamp lies where it lies without the other lamps."""
    post = small_scenes.box((-0.3, 0, -0.3), (0.3, 1.2, 0.3))
    angles = np.linspace(0, 2 * np.pi, 70, endpoint=False)
    lamps = [SpotLight((2 * np.cos(a), 3, 2 * np.sin(a)), (-np.cos(a), -1.5, -np.sin(a)), (5, 5, 5)) for a in angles]
    together = lab.render(floor_under(*lamps, more=[post]), "none")["direct"]
    few = [lab.render(floor_under(*lamps[i::5], more=[post]), "none")["direct"] for i in range(5)]
    difference = np.abs(together - sum(few))
    assert np.quantile(difference, 0.95) < 0.01 * together.max()  # 512 pixels a tile, against 1024: at shadows' edges
    assert difference.mean() < 0.002 * together.mean()
    without = lab.render(floor_under(*lamps), "none")["direct"]
    assert (together < 0.9 * without).mean() > 0.02


def test_a_scene_without_light_gets_a_sun_and_a_sky(lab):
    frame = lab.render(Scene((Instance(small_scenes.floor(4)),), camera=DOWN), "none")
    assert (frame["direct"] > 0.1).all()
    assert (frame["ambient"] > 0.1).all()


def test_a_mirrored_instance_is_lit_and_shaded_like_its_mirror_image(lab):
    post = small_scenes.box((0.5, 0, -0.3), (1.0, 1.2, 0.3))
    mirror = np.diag([-1.0, 1, 1, 1])

    def scene(side: int, *posts: Instance) -> Scene:
        return Scene((Instance(small_scenes.floor(4, ALBEDO)), *posts), (DirectionalLight((side, -2, 0)),), DARK, DOWN)

    right = lab.render(scene(1, Instance(post)), "none")["direct"]
    left = lab.render(scene(-1, Instance(post, mirror)), "none")["direct"]
    np.testing.assert_allclose(left, right[:, ::-1], atol=0.02)


def test_lights_refuse_what_cannot_shine():
    for make, message in (
        (lambda: DirectionalLight((0, 0, 0)), r"DirectionalLight: direction = \(0, 0, 0\) has no length"),
        (lambda: PointLight((0, np.nan, 0)), r"PointLight: position = .* is not three finite numbers"),
        (lambda: PointLight((0, 1, 0), (1, -1, 1)), r"PointLight: intensity = .* is negative"),
        (lambda: SpotLight((0, 1, 0), (0, -1, 0), inner=40, outer=30), r"inner = 40, outer = 30 are not 0 <= inner"),
    ):
        with pytest.raises(aolab.SceneError, match=message):
            make()


def test_meshes_of_one_face_each_way_are_lit_from_the_viewers_side(lab):
    """A two-sided sheet: seen from below, the side that faces the viewer is what light must reach."""
    sheet = small_scenes.floor(2, ALBEDO)
    below = Camera((0, -6, 0), (0, 0, 0), up=(0, 0, 1))
    lit, unlit = (
        lab.render(
            Scene((Instance(Mesh(sheet.vertices, sheet.faces)),), (DirectionalLight((0, y, 0)),), DARK, below), "none"
        )
        for y in (1, -1)
    )
    assert lit["direct"][24, 32, 0] > 0.1
    assert not unlit["direct"].any()


@pytest.mark.parametrize("module", ["ssdo", "s3ho"])
def test_light_beyond_half_precision_is_not_clipped(lab, wall, module):
    """A sun of 10⁷ gives 10⁷ times the light of a sun of 1, in every buffer of radiance."""
    bounce = {"ssdo": {"bounces": 1}, "s3ho": {"indirect": True, "lights": "sharp"}}[module]
    suns = [DirectionalLight((-1, -1, 0), (power,) * 3, shadow=False) for power in (1.0, 1e7)]
    dim, bright = (
        lab.render(wall.replace(lights=(sun,), environment=DARK), module, radius=1.0, **bounce) for sun in suns
    )
    for name in ("direct", "indirect", "radiance"):
        largest = dim[name].max()
        assert bright[name].max() > 65504, name
        np.testing.assert_allclose(bright[name] / 1e7, dim[name], rtol=0.01, atol=1e-3 * largest, err_msg=name)
