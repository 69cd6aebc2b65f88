"""Reflective shadow maps: the maps against geometry, the gathered bounce against the sum over all pixel lights."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import DirectionalLight, Environment, Material, PointLight, Scene, SpotLight
from aolab.gl import context
from aolab.maths.sampling import disc

DARK = Environment.constant(0.0)
RED, GREY = Material((0.8, 0.2, 0.1)), Material((0.5, 0.5, 0.5))
SIZE = (64, 48)
LIGHTS = {
    "spot": SpotLight((2, 2.5, 0.5), (-1, -0.4, -0.1), (6, 6, 6), inner=15, outer=25),
    "directional": DirectionalLight((-1, -0.3, 0.1), (2, 2, 2)),
}


def corner(*lights) -> Scene:
    """A grey floor, 4 × 4, and a red wall at its left side, x = 0."""
    floor = small_scenes.quad((0, 0, 2), (4, 0, 0), (0, 0, -4), GREY, "floor")
    wall = small_scenes.quad((0, 0, 2), (0, 0, -4), (0, 2, 0), RED, "wall")
    camera = aolab.Camera((4, 2.5, 3), (0.8, 0.3, 0), fov=45)
    return small_scenes.of(floor, wall, camera=camera, lights=lights, sky=DARK)


def all_pixel_lights(frame: aolab.Frame, scene: Scene) -> np.ndarray:
    """(H, W, 3): the irradiance by a sum over all pixels of the map, each a disc of its area; the shader's twin."""
    position, normal, flux = (frame.channels(name) for name in ("rsm_position", "rsm_normal", "rsm_flux"))
    lit = flux[..., 3] > 0
    x_p, n_p, phi, area = position[lit][:, :3], normal[lit][:, :3], flux[lit][:, :3], position[lit][:, 3]
    assert scene.camera is not None
    points = small_scenes.world_positions(frame, scene.camera)
    result = np.zeros((*points.shape[:2], 3))
    for row, column in np.argwhere(frame.mask):
        way = points[row, column] - x_p
        squared = (way**2).sum(axis=1)
        n = frame.world_normal()[row, column]
        cosines = np.maximum((n_p * way).sum(axis=1), 0) * np.maximum(-(way @ n), 0)
        result[row, column] = (phi / np.pi * (cosines / (squared * (squared + area / np.pi) + 1e-20))[:, None]).sum(0)
    return result


# --- the maps


@pytest.mark.parametrize("kind", LIGHTS)
def test_the_maps_flux_is_the_light_that_the_surfaces_reflect(lab, kind):
    """Σ Φ = ∫ ρ E dA over the lit surfaces: by positions and areas of the map, against the light's own formula."""
    scene = corner(LIGHTS[kind])
    frame = lab.render(scene, "rsm", size=SIZE, rsm_resolution=256)
    position, flux = frame.channels("rsm_position"), frame["rsm_flux"]
    seen = np.isfinite(frame["rsm_depth"])
    points, normals = position[seen][:, :3], frame["rsm_normal"][seen]
    red = np.abs(points[:, 0]) < 1e-3
    np.testing.assert_allclose(normals[red], np.broadcast_to((1, 0, 0), normals[red].shape), atol=1e-2)
    np.testing.assert_allclose(normals[~red], np.broadcast_to((0, 1, 0), normals[~red].shape), atol=1e-2)
    albedo = np.where(red[:, None], RED.base_color, GREY.base_color)
    if kind == "directional":
        light = LIGHTS[kind]
        assert isinstance(light, DirectionalLight)
        to_light = -np.asarray(light.direction) / np.linalg.norm(light.direction)
        irradiance = 2 * np.maximum(normals @ to_light, 0)
        # all of the wall, and of the floor, is lit: their areas are known
        assert position[seen][red, 3].sum() == pytest.approx(4 * 2, rel=0.03)
    else:
        light = LIGHTS[kind]
        assert isinstance(light, SpotLight)
        way = np.asarray(light.position) - points
        distance = np.linalg.norm(way, axis=1)
        inside = (-(way / distance[:, None]) @ light.direction) / np.linalg.norm(light.direction)
        low, high = np.cos(np.radians((light.outer, light.inner)))
        cone = np.clip((inside - low) / (high - low), 0, 1) ** 2
        irradiance = 6 * cone * np.maximum((normals * way).sum(axis=1), 0) / distance**3
        np.testing.assert_allclose(
            frame["rsm_depth"][seen], -(way @ light.direction) / np.linalg.norm(light.direction), rtol=1e-3
        )
    steep = position[seen][:, 3] < np.inf
    expected = albedo * (irradiance * position[seen][:, 3])[:, None]
    np.testing.assert_allclose(flux[seen][steep], expected[steep], rtol=0.02, atol=1e-6)


def test_the_maps_of_several_lights_stand_side_by_side(lab):
    both = lab.render(corner(*LIGHTS.values()), "rsm", size=SIZE, rsm_resolution=64)
    assert both["rsm_flux"].shape == (64, 128, 3)
    for number, light in enumerate(LIGHTS.values()):
        alone = lab.render(corner(light), "rsm", size=SIZE, rsm_resolution=64)
        for name in ("rsm_position", "rsm_normal", "rsm_flux", "rsm_depth"):
            np.testing.assert_allclose(
                both[name][:, 64 * number : 64 * (number + 1)], alone[name], rtol=1e-3, atol=1e-5
            )


def test_a_pixel_light_is_packed_into_four_words(glsl):
    """Position, area, normal and flux come back as exact as glsl/lib/pixel_light.glsl states."""
    rng = np.random.default_rng(1)
    count, box = 200, (1.0, -2.0, 3.0, 5.0)
    place = rng.uniform(-5, 5, (count, 3)) + box[:3]
    normal = rng.normal(size=(count, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    flux = 10 ** rng.uniform(-12, 4, (count, 1)) * rng.uniform(0, 1, (count, 3))
    flux[:3] = 0
    area = rng.uniform(0, 0.5, count) ** 2

    def returned(light: str, member: str) -> np.ndarray:
        statement = f"result.xyz = vec3(pixelLightOf(wordsOf(PixelLight({light}), box), box).{member});"
        return glsl("lib/pixel_light.glsl", statement, x, box=box)

    x = np.column_stack([place, area])
    np.testing.assert_allclose(returned("x.xyz, x.w, vec3(0, 1, 0), vec3(0)", "worldPos")[:, :3], place, atol=8e-5)
    root = np.sqrt(returned("x.xyz, x.w, vec3(0, 1, 0), vec3(0)", "area")[:, 0])
    np.testing.assert_allclose(root, np.sqrt(area), atol=4e-5)
    x = np.column_stack([normal, area])
    np.testing.assert_allclose(returned("vec3(0), 0.0, x.xyz, vec3(0)", "normal")[:, :3], normal, atol=1e-3)
    x = np.column_stack([flux, area])
    error = np.abs(returned("vec3(0), 0.0, vec3(0, 1, 0), x.xyz", "flux")[:, :3] - flux)
    assert (error <= 0.004 * flux.max(axis=1, keepdims=True)).all()


def test_the_maps_are_kept_while_scene_and_lights_stay(lab):
    scene = corner(LIGHTS["spot"])
    first, second = (lab.render(scene, "rsm", size=SIZE, seed=seed) for seed in (0, 1))
    assert "reflective shadow maps" in first.complete().timings
    assert "reflective shadow maps" not in second.complete().timings
    moved = SpotLight((2, 2.5, 1.5), (-1, -0.4, -0.1), (6, 6, 6), inner=15, outer=25)
    third = lab.relight(second, lights=(moved,))
    assert np.abs(third["rsm_position"] - first["rsm_position"]).max() > 0.1
    assert "reflective shadow maps" in third.timings
    np.testing.assert_array_equal(first["rsm_position"], second["rsm_position"])


# --- the gathered bounce


@pytest.mark.parametrize("gather", ["full", "low", "rotated"])
@pytest.mark.parametrize("kind", LIGHTS)
def test_the_bounce_is_the_sum_over_all_pixel_lights(lab, kind, gather):
    scene = corner(LIGHTS[kind])
    frame = lab.render(scene, "rsm", gather=gather, rsm_resolution=64, size=SIZE, accumulate=4)
    exact = all_pixel_lights(frame, scene)
    mean = exact[frame.mask].mean()
    error = (frame["rsm_irradiance"] - exact)[frame.mask]
    assert np.sqrt((error**2).mean()) < {"full": 0.1, "low": 0.2, "rotated": 0.3}[gather] * mean
    assert abs(error.mean()) < 0.1 * mean
    reflected = frame["albedo"] / np.pi * frame["rsm_irradiance"]
    np.testing.assert_allclose(frame["indirect"][frame.mask], reflected[frame.mask], rtol=1e-3, atol=1e-6)
    assert frame["indirect"][..., 0].sum() > 2 * frame["indirect"][..., 2].sum()  # the wall is red


def test_points_beyond_the_maps_sides_gather_from_all_of_it(lab):
    """A wall beside and above a narrow cone of light, and a ceiling behind the lamp: no stripes, no loss."""
    lamp = SpotLight((0, 5.4, -2.8), (0, -1, 0), (36, 28, 18), inner=50, outer=60)
    scene = aolab.load("cornell", daylight=0.0).replace(lights=(lamp,), environment=DARK)
    frame = lab.render(scene, "rsm", size=(96, 54), rsm_resolution=64)
    exact = all_pixel_lights(frame, scene)
    assert scene.camera is not None
    points = small_scenes.world_positions(frame, scene.camera)
    for part in (points[..., 2] < -5.5) & (points[..., 1] > 3.9), points[..., 1] > 5.45:
        error = (frame["rsm_irradiance"] - exact)[part & frame.mask]
        mean = exact[part & frame.mask].mean()
        assert np.sqrt((error**2).mean()) < 0.2 * mean
        assert abs(error.mean()) < 0.05 * mean


def test_two_lights_bounce_as_much_as_each_of_them(lab):
    settings = {"gather": "full", "size": SIZE}
    both = lab.render(corner(*LIGHTS.values()), "rsm", **settings)["indirect"]
    alone = sum(lab.render(corner(light), "rsm", **settings)["indirect"] for light in LIGHTS.values())
    np.testing.assert_allclose(both, alone, rtol=1e-3, atol=1e-6)


def test_low_resolution_gathers_at_edges_and_interpolates_elsewhere(lab):
    scene = corner(LIGHTS["spot"])
    low, full = (lab.render(scene, "rsm", gather=gather, size=(128, 96)) for gather in ("low", "full"))
    interpolated = low.channels("rsm_irradiance")[..., 3] > 0.5
    assert 0.6 < interpolated[low.mask].mean() < 0.98
    by_itself = low.mask & ~interpolated
    np.testing.assert_allclose(low["rsm_irradiance"][by_itself], full["rsm_irradiance"][by_itself], rtol=1e-3)
    error = (low["rsm_irradiance"] - full["rsm_irradiance"])[interpolated & low.mask]
    assert np.sqrt((error**2).mean()) < 0.15 * full["rsm_irradiance"][low.mask].mean()


def test_the_mean_of_four_by_four_pixels_is_nearer_to_the_sum(lab):
    scene = corner(LIGHTS["spot"])
    frame = lab.render(scene, "rsm", rsm_resolution=64, size=SIZE)
    exact = all_pixel_lights(frame, scene)
    raw, filtered = (
        np.sqrt(((frame[name] - exact)[frame.mask] ** 2).mean()) for name in ("rsm_irradiance_raw", "rsm_irradiance")
    )
    assert filtered < 0.5 * raw


def test_many_seeds_converge_without_a_filter(lab):
    """A pixel's line turns with the seed, so that the pattern vanishes."""
    scene = corner(LIGHTS["spot"])
    settings = {"rsm_resolution": 64, "size": SIZE, "filter": "none"}
    frames = [lab.render(scene, "rsm", accumulate=count, **settings) for count in (1, 64)]
    exact = all_pixel_lights(frames[0], scene)
    one, many = (
        np.sqrt(((frame["rsm_irradiance"] - exact)[frame.mask] ** 2).mean()) / exact.mean() for frame in frames
    )
    assert many < 0.3 * one


@pytest.mark.parametrize("seed", [0, 3])
def test_the_shares_of_a_disc_are_those_of_its_area(seed):
    kernel = disc(512, seed)
    assert kernel[:, 2].sum() == pytest.approx(1, abs=0.01)
    radius = np.linalg.norm(kernel[:, :2], axis=1)
    assert (kernel[:, 2] * radius**2).sum() == pytest.approx(0.5, abs=0.01)
    assert (kernel[:, 2][:, None] * kernel[:, :2]).sum(axis=0) == pytest.approx((0, 0), abs=0.02)


# --- with other modules


@pytest.mark.parametrize(
    "name", ["ssao", "ssdo", "s3ho", "ssbn", "ssbn?weighting=uniform", "ambient_transfer", "rotated_ssao"]
)
def test_another_modules_visibility_shades_the_bounce(lab, name):
    scene = corner(LIGHTS["spot"])
    base, _, query = name.partition("?")
    combined = f"{base}+rsm" + (f"?{query}" if query else "")
    shaded, open = (lab.render(scene, combined, radius=0.5, shaded=on, size=SIZE) for on in (True, False))
    alone = lab.render(scene, name, radius=0.5, size=SIZE)
    np.testing.assert_array_equal(shaded["visibility"], alone["visibility"])
    own = alone["indirect"] if "indirect" in alone.buffers else 0
    expected = (open["indirect"] - own) * np.nan_to_num(shaded["visibility"])[..., None]
    np.testing.assert_allclose(shaded["indirect"] - own, expected, rtol=5e-3, atol=1e-5)
    assert shaded.info["module"] == f"{base}+rsm"


@pytest.mark.parametrize("name", ["ssdo", "s3ho"])
def test_a_bounce_on_the_screen_adds_to_it(lab, name):
    scene = corner(LIGHTS["directional"])
    settings = {"radius": 0.5, "size": SIZE, "shaded": False}
    on, off = {"ssdo": ({"bounces": 1}, {"bounces": 0}), "s3ho": ({"indirect": True}, {"indirect": False})}[name]
    both, alone = (lab.render(scene, f"{name}+rsm", **way, **settings)["indirect"] for way in (on, off))
    screen = lab.render(scene, name, **on, radius=0.5, size=SIZE)["indirect"]
    assert screen.sum() > 1
    np.testing.assert_allclose(both, alone + screen, rtol=1e-3, atol=1e-5)


def test_a_combined_module_is_described_and_refuses(lab):
    from aolab.modules import MODULES, find

    module = find("ssao+rsm", MODULES, radius=0.5, gather="full")
    assert (module.name, module.filter) == ("ssao+rsm", "box4")
    assert type(find("ssao+rsm", MODULES)) is type(module)
    assert "Dachsbacher" in type(module).paper
    for name, message in (
        ("ssao+rms", "'rms' is no part of a module; did you mean 'rsm'"),
        ("ssao+rsm+rsm", "'rsm' is there twice"),
        ("rsm+rsm", "'rsm' is there twice"),
        ("sao+rsm", "no module 'sao'"),
    ):
        with pytest.raises(aolab.ParameterError, match=message):
            find(name, MODULES)


# --- bad input


def test_a_point_light_has_no_map_and_a_notice_counts_it(lab):
    with pytest.warns(aolab.Notice, match="1 of its 2 lights are points, which have no reflective shadow map"):
        frame = lab.render(corner(PointLight((2, 2, 0)), LIGHTS["spot"]), "rsm", size=SIZE)
    alone = lab.render(corner(LIGHTS["spot"]), "rsm", size=SIZE)
    np.testing.assert_array_equal(frame["indirect"], alone["indirect"])


def test_without_a_light_or_with_a_dark_one_there_is_no_bounce(lab):
    dark = SpotLight((2, 2, 0), (-1, -1, 0), (0, 0, 0))
    inside = SpotLight((2, -0.5, 0), (0, -1, 0), (5, 5, 5))  # under the floor, looking away from it
    for lights in ((), (dark,), (inside,)):
        scene = corner(*lights)
        frame = lab.render(scene, "rsm", size=SIZE)
        assert not frame["indirect"].any()
        assert np.isfinite(frame["radiance"]).all()


def test_too_wide_a_row_of_maps_is_refused(lab):
    most = context.get().info["GL_MAX_TEXTURE_SIZE"] // 2048
    lights = tuple(SpotLight((2, 2, 0.01 * i), (-1, -1, 0)) for i in range(most + 1))
    with pytest.raises(aolab.ParameterError, match=f"At most {most} such maps fit, or {most + 1} with rsm_resolution"):
        lab.render(corner(*lights), "rsm", size=SIZE, rsm_resolution=2048)
