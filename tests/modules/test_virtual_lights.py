"""Virtual lights: an environment's and a lamp's bounce against rays; batches; the near field; bad inputs."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, DirectionalLight, Environment, Material, PointLight, Scene, SpotLight
from aolab.errors import ParameterError
from aolab.gl import context
from aolab.gl.loops import LOOP_STEPS, check_loops
from aolab.pipeline import virtual_lights

SIZE = (64, 48)
DARK = Environment.constant(0.0)
SPOT = SpotLight((0, 5.4, -2.8), (0, -1, 0), (36, 28, 18), inner=50, outer=60)


@pytest.fixture(scope="module")
def room() -> Scene:
    """The Cornell box in the light of a spot under its ceiling."""
    return aolab.load("cornell", daylight=0.0).replace(lights=(SPOT,))


def relative(values: np.ndarray, truth: np.ndarray, mask: np.ndarray) -> float:
    return float(np.sqrt(np.mean((values - truth)[mask] ** 2)) / truth[mask].mean())


# --- an environment


@pytest.mark.slow
def test_more_lights_of_an_environment_come_nearer_to_rays(lab):
    """Below 5 % of the mean with 256 lights and filled shadows."""
    scene = aolab.load("coins")
    size = (160, 120)
    truth = aolab.reference(scene, size=size, buffers=("ambient",), rays=256)
    errors = [
        relative(
            lab.render(scene, "environment_vpl", environment_lights=count, fill=8, size=size)["ambient"],
            truth["ambient"],
            truth.mask,
        )
        for count in (4, 32, 256)
    ]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.05


def test_a_facing_plane_has_the_irradiance_of_the_environment(lab):
    sky = Environment.sky()
    scene = small_scenes.plane().replace(environment=sky)
    frame = lab.render(scene, "environment_vpl", size=SIZE)
    expected = sky.irradiance(np.array((0.0, 1.0, 0.0))) / np.pi
    np.testing.assert_allclose(frame["ambient"][frame.mask].mean(axis=0), expected, rtol=0.03)


def test_the_batches_add_up_to_the_same_light(lab, boxes, monkeypatch):
    frames = []
    for batch in (3, 32):
        monkeypatch.setattr(virtual_lights, "BATCH", batch)
        frames.append(lab.render(boxes, "environment_vpl", environment_lights=20, size=SIZE, vpl_resolution=32))
    np.testing.assert_allclose(*(frame["ambient"] for frame in frames), rtol=1e-4, atol=1e-6)


@pytest.mark.filterwarnings("ignore:.* meshes are not closed:aolab.Notice")
def test_a_module_keeps_its_bounce_under_virtual_lights(lab, boxes):
    """SSDO's senders have the light of the virtual lights; hidden senders the environment's."""
    sky = {"environment_lights": 16, "vpl_resolution": 32, "size": SIZE, "radius": 1.0}
    for occluders in ("depth", "layers"):
        frame = lab.render(boxes, "ssdo+environment_vpl", bounces=1, occluders=occluders, **sky)
        assert frame["indirect"].sum() > 0


# --- instant radiosity


@pytest.mark.slow
@pytest.mark.parametrize(("clamp", "count", "most"), [(1.0, 256, 0.25), ("auto", 64, 0.31)])
def test_the_near_field_brings_the_clamped_light_back(lab, room, clamp, count, most):
    """Against rays, near the corners where floor and walls meet and everywhere."""
    truth = aolab.reference(room, size=(96, 72), buffers=("indirect",), rays=512)["indirect"]
    settings = {"bounce_lights": count, "fill": 8, "size": (96, 72), "vpl_clamp": clamp, "radius": 1.0}
    settings |= {"directions": 16, "steps": 8}
    frames = {on: lab.render(room, "instant_radiosity", near_field=on, **settings) for on in (False, True)}
    mask = frames[True].mask
    error = {on: relative(frame["indirect"], truth, mask) for on, frame in frames.items()}
    lost = {on: (truth - frame["indirect"])[mask].mean() for on, frame in frames.items()}
    assert error[True] < 0.9 * error[False] < most
    assert 0 < lost[True] < 0.8 * lost[False]


def test_without_a_clamp_the_bounce_has_the_flux_of_the_maps(lab):
    """On a ceiling far over a small lit floor, every virtual light is a point at about the same place."""
    floor = small_scenes.quad((-0.1, 0, 0.1), (0.2, 0, 0), (0, 0, -0.2), Material((0.5, 0.5, 0.5)))
    ceiling = small_scenes.quad((-3, 3, -3), (6, 0, 0), (0, 0, 6), name="ceiling")
    sun = DirectionalLight((0, -1, 0), (np.pi, np.pi, np.pi), shadow=False)
    scene = small_scenes.of(floor, ceiling, camera=Camera((0, 0.5, 0.01), (0, 3, 0)), lights=(sun,), sky=DARK)
    low = small_scenes.of(floor, camera=Camera((0, 0.5, 0.01), (0, 3, 0)), lights=(sun,), sky=DARK)
    assert low.radius < scene.radius
    spot = SpotLight((0, 1, 0), (0, -1, 0), (np.pi, np.pi, np.pi), inner=20, outer=21)
    scene = scene.replace(lights=(spot,))
    frame = lab.render(scene, "instant_radiosity", bounce_lights=16, vpl_clamp=0.01, size=SIZE, rsm_resolution=512)
    position = small_scenes.world_positions(frame, scene.camera)
    over = np.hypot(position[..., 0], position[..., 2]) < 0.2
    # Φ = ρ E A = 0.5 π 0.04, up to the squares of small angles; E = Φ/π / h²; white reflects E/π
    expected = 0.5 * np.pi * 0.04 / np.pi / 9 / np.pi
    np.testing.assert_allclose(frame["indirect"][over][:, 0], expected, rtol=0.05)


PATCH = 1.0, 4.0  # x from 0, z around 0
RADIOSITY = 0.8 * np.pi
BOUNDS = {"auto": np.pi / 4 / 4, 2.0: 1 / 2.0**2}  # of the geometry term: a quarter of the radiosity is π / (4 area)


@pytest.fixture(scope="module")
def patch() -> Scene:
    """A white wall in the plane x = 0 at the side of a patch of the floor, which the sun lights from straight above."""
    width, length = PATCH
    lit = small_scenes.quad((0, 0, length / 2), (width, 0, 0), (0, 0, -length), Material((0.8, 0.8, 0.8)), "patch")
    wall = small_scenes.quad((0, 0, 3), (0, 0, -6), (0, 4, 0), name="wall")
    sun = DirectionalLight((0, -1, 0), (np.pi, np.pi, np.pi), shadow=False)
    return small_scenes.of(lit, wall, camera=Camera((4, 3, 0), (0.3, 0.5, 0)), lights=(sun,), sky=DARK)


@pytest.mark.parametrize("clamp", BOUNDS)
def test_near_a_single_light_its_irradiance_is_the_bound(lab, patch, clamp):
    """It is Φ/π times the bound; `auto`: a quarter of the patch's radiosity. Farther away the clamp changes nothing."""
    settings = {"bounce_lights": 1, "size": SIZE, "rsm_resolution": 512}
    free, clamped = (
        lab.render(patch, "instant_radiosity", vpl_clamp=c, **settings)["indirect"][..., 0] for c in (1e-3, clamp)
    )
    most = RADIOSITY * np.prod(PATCH) / np.pi * BOUNDS[clamp] / np.pi  # white reflects E/π
    np.testing.assert_allclose(clamped, np.minimum(free, most), rtol=0.02, atol=1e-6)
    assert (free > 1.1 * most).sum() > 10


@pytest.mark.parametrize("clamp", BOUNDS)
def test_the_near_field_is_the_light_beyond_the_bound(lab, patch, clamp):
    """At the wall: the radiance of the patch, integrated over its area with the weight max(G - bound, 0)."""
    settings = {"bounce_lights": 1, "size": (160, 120), "rsm_resolution": 512, "vpl_clamp": clamp, "near_field": True}
    settings |= {"radius": 1.2, "falloff": 0, "directions": 32, "steps": 32, "accumulate": 2, "filter": "none"}
    frame = lab.render(patch, "instant_radiosity", **settings)
    position = small_scenes.world_positions(frame, patch.camera)
    near = (abs(position[..., 0]) < 0.01) & (abs(position[..., 1] - 0.5) < 0.1) & (abs(position[..., 2]) < 0.1)
    width, length = PATCH
    x, z = np.meshgrid((np.arange(200) + 0.5) / 200 * width, ((np.arange(400) + 0.5) / 400 - 0.5) * length)
    height = position[near][:, 1, None, None]
    geometry = height * x / (x**2 + (z - position[near][:, 2, None, None]) ** 2 + height**2) ** 2
    cell = width * length / x.size
    expected = RADIOSITY / np.pi * np.maximum(geometry - BOUNDS[clamp], 0).sum(axis=(1, 2)) * cell
    assert near.sum() > 5
    np.testing.assert_allclose(frame["bounce"][near][:, 0].mean(), expected.mean(), rtol=0.08)


def test_the_clamp_bounds_the_light_of_each_virtual_light(lab, room):
    frames = [lab.render(room, "instant_radiosity", vpl_clamp=c, size=SIZE)["indirect"] for c in (0.1, 0.5, 2.0)]
    assert (frames[0] >= frames[1] - 1e-4).all()
    assert (frames[1] >= frames[2] - 1e-4).all()
    assert frames[0].sum() > 1.02 * frames[2].sum()


def test_shadows_of_virtual_lights_are_filled(lab):
    """Fig. 11: small shadows are back. The fill takes light away, and only near contacts."""
    scene = aolab.load("coins")
    lost, found = (lab.render(scene, "environment_vpl", fill=fill, size=SIZE)["ambient"] for fill in (0, 8))
    assert (found <= lost + 1e-4).all()
    assert found.sum() < 0.99 * lost.sum()


def test_the_seed_draws_other_lights_and_the_maps_are_kept(lab, room):
    frames = [lab.render(room, "instant_radiosity", seed=seed, size=SIZE) for seed in (0, 0, 1)]
    np.testing.assert_array_equal(frames[0]["indirect"], frames[1]["indirect"])
    assert not np.array_equal(frames[0]["indirect"], frames[2]["indirect"])
    assert frames[1].timings.get("shadows", 0) == 0
    moved = room.replace(lights=(SpotLight((1, 5.4, -2.8), (0, -1, 0), (36, 28, 18), inner=50, outer=60),))
    assert not np.array_equal(lab.render(moved, "instant_radiosity", size=SIZE)["indirect"], frames[0]["indirect"])


# --- limits and bad input


def test_a_shaders_loops_stay_below_the_limit_of_software_drivers(lab, boxes):
    assert virtual_lights.BATCH * (virtual_lights.STEPS_A_LIGHT + 64) < LOOP_STEPS == 65535
    with pytest.raises(
        ParameterError, match="a test: 65535 steps of a shader's loops; software drivers end them after"
    ):
        check_loops(65535, "a test")


@pytest.mark.slow
def test_256_lights_with_maps_of_64_pixels_at_512_by_512(lab, room):
    for module in ("environment_vpl", "instant_radiosity"):
        count = {"environment_vpl": {"environment_lights": 256}, "instant_radiosity": {"bounce_lights": 256}}[module]
        bright = aolab.load("cornell").replace(lights=(SPOT,))
        frame = lab.render(bright, module, vpl_resolution=64, size=(512, 512), **count)
        assert np.isfinite(frame["radiance"]).all()
        assert frame["indirect" if module == "instant_radiosity" else "ambient"].sum() > 0


def test_more_lights_than_the_largest_atlas_holds_are_refused(lab, boxes):
    with pytest.raises(ParameterError, match=r"environment_lights = 257 is not valid: int, ≥ 1, ≤ 256"):
        lab.render(boxes, "environment_vpl", environment_lights=257)
    with pytest.raises(ParameterError, match=r"vpl_resolution = 513 is not valid: int, ≥ 16, ≤ 512, in pixels"):
        lab.render(boxes, "instant_radiosity", vpl_resolution=513)


@pytest.mark.parametrize("module", ["environment_vpl", "instant_radiosity"])
def test_an_atlas_beyond_the_driver_names_the_largest_that_fits(lab, room, monkeypatch, module):
    monkeypatch.setitem(context.get().info, "GL_MAX_TEXTURE_SIZE", 1024)
    count = {"environment_vpl": "environment_lights", "instant_radiosity": "bounce_lights"}[module]
    told = r"shadow maps of 256 pixels .* at most 1024x1024. At most 16 such maps fit, or \d+ of \d+ pixels"
    scene = room.replace(environment=Environment.constant(1.0))
    with pytest.raises(ParameterError, match=told):
        lab.render(scene, module, size=SIZE, vpl_resolution=256, shadow_resolution=64, **{count: 64}).complete()


def test_dark_lamps_lamps_in_solids_and_dark_skies_give_no_light(lab):
    block = small_scenes.box((-1, 0, -1), (1, 2, 1))
    camera = Camera((4, 3, 4), (0, 0.5, 0))
    inside = SpotLight((0, 1, 0), (0, -1, 0), (9, 9, 9))  # in the block: it lights the block's inner side
    dark = SpotLight((0, 4, 0), (0, -1, 0), (0, 0, 0))
    for lights in ((inside,), (dark,), ()):
        scene = small_scenes.of(small_scenes.floor(4), block, camera=camera, lights=lights, sky=DARK)
        frame = lab.render(scene, "instant_radiosity", size=SIZE)
        assert np.isfinite(frame["radiance"]).all()
        assert frame["indirect"].max() < 1e-3
        ambient = lab.render(scene, "environment_vpl", size=SIZE)["ambient"]
        assert not ambient.any()


def test_an_environment_with_a_burning_pixel_stays_finite(lab, boxes):
    radiance = np.full((16, 32, 3), 0.5, np.float32)
    radiance[3, 5] = 6e4
    frame = lab.render(boxes.replace(environment=Environment(radiance)), "environment_vpl", size=SIZE)
    assert np.isfinite(frame["radiance"]).all()
    assert frame["ambient"].max() > 1


def test_points_do_not_bounce_and_a_spot_is_narrower_than_a_half_space(lab):
    with pytest.warns(aolab.Notice, match="no reflective shadow map"):
        lab.render(small_scenes.boxes(lights=(PointLight((0, 3, 0)),)), "instant_radiosity", size=SIZE)
    with pytest.raises(aolab.SceneError, match="inner = 20, outer = 95 are not 0 <= inner < outer < 90"):
        SpotLight((0, 1, 0), (0, -1, 0), inner=20, outer=95)
