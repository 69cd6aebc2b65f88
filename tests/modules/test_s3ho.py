"""S3HO: exact coefficients, the reference's projection, light as a dot product, senders that know no light yet."""

from dataclasses import replace

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import S3HO, DirectionalLight, Environment, Lab, ParameterError, PointLight, Scene
from aolab.maths.harmonics import clamped_cosine, evaluate, hanning, irradiance, light_lobe, rotate, zonal_lobe
from aolab.maths.sampling import influence
from aolab.modules.occluders import Layers
from aolab.modules.passes import Pass

pytestmark = pytest.mark.filterwarnings("ignore:.* meshes are not closed:aolab.errors.Notice")  # nor is a floor
SUN = Environment.sky(sun_direction=(1.0, 0.6, 0.3), sun_radiance=(60, 40, 20), sun_angle=20)
SHARP = (256, 192)  # a pixel is 3 cm where floor and wall meet
LAMP = DirectionalLight((-0.3, -1.0, -0.4), (3.0, 2.0, 1.0), shadow=False)


class Plain(S3HO):
    """The basis function by basis function form."""

    def passes(self) -> list[Pass]:
        fast = super().passes()[0]
        return [Pass(fast.name, "s3ho.frag", fast.outputs, fast.constants)]


def coefficients(frame: aolab.Frame, raw: str = "") -> np.ndarray:
    """(H, W, 16)."""
    return np.concatenate([frame[f"sh{i}{raw}"] for i in range(4)], axis=-1)


def bounces(frame: aolab.Frame) -> np.ndarray:
    """(H, W, 3, 16): the senders' coefficients, in world space."""
    whole = [frame[f"bounce{i}"] for i in range(7)]
    rgb = [one[..., :3] for one in whole]
    rgb += [np.stack([one[..., 3] for one in whole[k : k + 3]], axis=-1) for k in (0, 3)]
    found = np.pad(np.stack(rgb, axis=-1).astype(np.float64), [(0, 0)] * 3 + [(0, 7)])
    return rotate(found, frame.camera.view_from_world[:3, :3].T)


def off_the_crease(frame: aolab.Frame, scene: Scene) -> np.ndarray:
    """(H, W) bool: the floor before the wall at x = 0, without texels that contain both."""
    with np.errstate(invalid="ignore"):
        across = small_scenes.world_positions(frame, scene.camera)[..., 0]
        return (frame.world_normal()[..., 1] > 0.9) & (across > 0.15)


def under(scene: Scene, environment: Environment, *lights) -> Scene:
    return scene.replace(environment=environment, lights=lights)


# --- coefficients


def test_an_open_surface_has_the_coefficients_of_the_clamped_cosine(lab, plane):
    """√π/2, √(π/3) along the normal, √(5π)/8, and 0 in band 3."""
    frame = lab.render(plane, "s3ho")
    found = coefficients(frame)[frame.mask]
    up = clamped_cosine(np.array([0.0, 1.0, 0.0]))
    np.testing.assert_allclose(found, np.broadcast_to(up, found.shape), atol=1e-3)  # of half-float normals
    by_band = [np.linalg.norm(found[0, band**2 : (band + 1) ** 2]) for band in range(4)]
    np.testing.assert_allclose(by_band, [0.886227, 1.023327, 0.495416, 0], atol=1e-3)


def test_visibility_is_that_of_ssao_with_the_same_samples(lab, boxes):
    for settings in ({}, {"directions": 13, "steps": 3, "falloff": 0.0}, {"occluders": "layers"}):
        ours, plain = (lab.render(boxes, name, radius=0.7, **settings) for name in ("s3ho", "ssao"))
        np.testing.assert_allclose(ours["visibility_raw"], plain["visibility_raw"], atol=1e-3)
        np.testing.assert_allclose(ours["visibility"], plain["visibility"], atol=3e-3)  # four filtered halves
        assert np.nanmin(ours["visibility"]) < 0.6


@pytest.mark.parametrize(
    "settings", [{}, {"strength": 3.0}, {"directions": 5, "steps": 1, "falloff": 0.0}, {"estimator": "plain"}]
)
def test_moments_give_what_the_plain_form_gives(lab, boxes, settings):
    fast, plain = (lab.render(boxes, kind(radius=1.0, filter="none", **settings)) for kind in (S3HO, Plain))
    for i in range(4):
        assert np.abs(plain[f"occlusion{i}"]).max() > 0.1
        np.testing.assert_allclose(fast[f"occlusion{i}"], plain[f"occlusion{i}"], atol=1e-3)


@pytest.mark.slow
def test_converged_coefficients_are_the_references(lab):
    """Within 3 % of c_0 on `boxes`, whose surfaces all lie in four peeled layers."""
    module = S3HO(directions=16, steps=16, filter="none", occluders="layers")
    names = ("sh0", "sh1", "sh2", "sh3")
    truth = aolab.reference("boxes", size=(160, 90), like=module, rays=256, buffers=names, cache=False)
    frame = lab.render("boxes", module, size=(160, 90), accumulate=4)
    error = (coefficients(frame) - coefficients(truth))[truth.mask]
    c_0 = truth["sh0"][truth.mask][:, 0].mean()
    assert np.sqrt((error**2).mean(axis=0)).max() < 0.03 * c_0  # of every single one


def test_coefficients_turn_with_the_camera(lab, wall):
    """In world space, the coefficients of a spot do not depend on the camera."""
    spot = np.array([0.3, 0.0, 0.2])
    found = []
    for eye in ((4.0, 3.0, 3.0), (3.0, 4.0, -2.0)):
        camera = aolab.Camera(eye, tuple(spot), fov=20)
        module = S3HO(radius=1.0, directions=16, steps=16)
        frame = lab.render(wall, module, camera=camera, size=(65, 65), accumulate=4)
        assert np.linalg.norm(small_scenes.world_positions(frame, camera)[32, 32] - spot) < 0.05
        found.append(coefficients(frame)[32, 32])
    np.testing.assert_allclose(found[0], found[1], atol=0.05)
    assert np.linalg.norm(found[0] - clamped_cosine(np.array([0.0, 1.0, 0.0]))) > 0.2


def test_the_plain_sum_has_the_same_mean_and_more_noise(lab, boxes):
    sets = {kind: [] for kind in ("blocked", "plain")}
    for seed in range(8):
        for kind, found in sets.items():
            frame = lab.render(boxes, "s3ho", radius=0.7, estimator=kind, seed=seed, filter="none")
            found.append(coefficients(frame)[frame.mask])
    blocked, plain = (np.stack(found) for found in sets.values())
    assert np.abs(blocked.mean(axis=(0, 1)) - plain.mean(axis=(0, 1))).max() < 0.02
    assert blocked.std(axis=0).mean() < 0.5 * plain.std(axis=0).mean()


def test_bands_are_no_longer_than_those_of_a_function_that_is_nowhere_negative(lab, wall):
    """|c_l| ≤ √(2l + 1) |c_0| in shader and Python; before a wall, the sums over three directions exceed it."""
    frame = lab.render(under(wall, SUN), "s3ho", radius=2.0, directions=3, filter="none", size=SHARP)
    found = coefficients(frame)[frame.mask]
    assert found[:, 0].min() >= 0
    atop = 0.0
    for band in range(1, 4):
        lengths = np.linalg.norm(found[:, band**2 : (band + 1) ** 2], axis=1)
        bound = np.sqrt(2 * band + 1) * found[:, 0]
        assert (lengths <= bound + 1e-5).all()
        atop = max(atop, (lengths > bound - 1e-5).mean())
    assert atop > 0.02
    arriving = np.maximum(found @ SUN.radiance_sh, 0)
    np.testing.assert_allclose(frame["ambient"][frame.mask], arriving / np.pi, rtol=0.01, atol=0.02)


def test_deep_trenches_converge_with_sets_of_few_directions(lab):
    """At a visibility of 0.1, 64 sets of four directions and four sets of 64 have the same mean."""
    sides = [small_scenes.box((low, 0, -5), (low + 4.9, 1, 5)) for low in (-5, 0.1)]
    trench = small_scenes.of(small_scenes.floor(9), *sides, camera=aolab.Camera((0, 2.5, 2.5), (0, 0, 0), fov=15))
    few, many = (
        lab.render(
            trench, "s3ho", radius=2.0, thickness=10.0, directions=n, steps=8, accumulate=256 // n, filter="none"
        )
        for n in (4, 64)
    )
    deep = many["visibility"] < 0.15
    assert deep.sum() > 20
    assert few["ambient"][deep].mean() == pytest.approx(many["ambient"][deep].mean(), rel=0.1)


@pytest.mark.slow
def test_strength_lets_light_through_occluders(lab, wall):
    """Before a wall, which blocks directions with d_x < 0 at the distance x / -d_x: against the formula."""
    radius, strength = 2.0, 3.0
    module = S3HO(radius=radius, directions=32, steps=32, falloff=0.5, filter="none", thickness=10.0)
    hard, soft = (
        lab.render(wall, module, size=SHARP, accumulate=2, strength=value)["visibility"] for value in (0.0, strength)
    )
    seen = lab.render(wall, "none", size=SHARP)
    across = small_scenes.world_positions(seen, wall.camera)[..., 0]
    u, v = np.meshgrid((np.arange(400) + 0.5) / 400, (np.arange(400) + 0.5) / 400)
    towards_wall = -np.sqrt(u) * np.cos(2 * np.pi * v)  # Malley's method: density cosθ/π
    for x in (0.3, 0.8):
        there = (np.abs(across - x) < 0.03) & (seen.world_normal()[..., 1] > 0.9)
        d = np.where(towards_wall > 1e-9, x / np.maximum(towards_wall, 1e-9), np.inf) / radius
        reached = influence(d**2, 0.5)
        assert 1 - hard[there].mean() == pytest.approx(reached.mean(), abs=0.03)
        assert 1 - soft[there].mean() == pytest.approx((reached / (1 + strength * d)).mean(), abs=0.03)


def test_closed_points_are_black(lab, wall):
    """The sum over a single blocked direction is far from the clamped cosine; the difference makes no light."""
    frame = lab.render(under(wall, SUN, LAMP), "s3ho", radius=2.0, directions=1, filter="none", size=SHARP)
    closed = frame["visibility"] < 2e-3  # of half floats
    assert closed.sum() > 100
    assert max(frame["ambient"][closed].max(), frame["direct"][closed].max()) < 5e-3
    assert np.abs(coefficients(frame)[closed]).max() < 5e-3
    open = frame["visibility"] > 0.9
    assert frame["ambient"][open].mean() > 0.1


# --- light


def test_a_constant_sky_gives_visibility_without_truncation(lab, boxes):
    """E = L ∫ V cosθ dω: y_0 is constant, and no higher band contributes."""
    frame = lab.render(under(boxes, Environment.constant((0.5, 1.0, 2.0))), "s3ho", radius=1.0)
    expected = frame["albedo"] * np.nan_to_num(frame["visibility"])[..., None] * (0.5, 1.0, 2.0)
    np.testing.assert_allclose(frame["ambient"], expected, atol=4e-3)
    assert np.nanmin(frame["visibility"]) < 0.6


def test_the_environments_light_is_the_dot_product(lab, boxes):
    frame = lab.render(under(boxes, SUN), "s3ho", radius=1.0)
    arriving = np.maximum(coefficients(frame) @ SUN.radiance_sh, 0)
    np.testing.assert_allclose(frame["ambient"], frame["albedo"] / np.pi * arriving, atol=5e-3)
    grey = lab.render(under(boxes, SUN), "ssao", radius=1.0)
    assert np.abs(frame["ambient"] - grey["ambient"]).max() > 0.1  # and not the visibility times the mean


def test_an_open_ball_gets_the_environments_irradiance(lab):
    ball = small_scenes.of(small_scenes.sphere(1.0, (0, 0, 0)), camera=aolab.Camera((0, 0, 4), (0, 0, 0)), sky=SUN)
    frame = lab.render(ball, "s3ho")
    expected = evaluate(irradiance(SUN.radiance_sh), frame.world_normal())[frame.mask] / np.pi
    np.testing.assert_allclose(frame["ambient"][frame.mask], np.maximum(expected, 0), atol=5e-3)


@pytest.mark.parametrize("width", [2.0, 4.0, 64.0])
def test_a_light_is_a_windowed_lobe_that_gives_a_facing_surface_its_irradiance(lab, width):
    ball = small_scenes.of(small_scenes.sphere(1.0, (0, 0, 0)), camera=aolab.Camera((0, 0, 4), (0, 0, 0)))
    frame = lab.render(under(ball, Environment.constant(0), LAMP), "s3ho", light_window=width)
    normal = frame.world_normal()[frame.mask]
    towards = -np.array(LAMP.direction) / np.linalg.norm(LAMP.direction)
    lobe = zonal_lobe(light_lobe(hanning(width)), towards)
    expected = np.maximum(clamped_cosine(normal) @ lobe, 0)
    facing = normal @ towards
    assert expected[facing > 0.999] == pytest.approx(1, abs=0.01)
    share = frame["direct"][frame.mask] * np.pi / LAMP.irradiance
    np.testing.assert_allclose(share, np.repeat(expected[:, None], 3, axis=1), atol=0.01)


def test_lights_add_up(lab, boxes):
    bulb = PointLight((1.0, 2.0, 2.0), (5.0, 4.0, 3.0), shadow=False)
    both, one, other = (
        lab.render(under(boxes, Environment.constant(0), *lights), "s3ho", radius=1.0)["direct"]
        for lights in ((LAMP, bulb), (LAMP,), (bulb,))
    )
    np.testing.assert_allclose(both, one + other, atol=5e-3)
    assert one.max() > 0.2
    assert other.max() > 0.2


def test_occlusion_shades_a_light_on_its_side(lab, wall):
    """The wall at x = 0 blocks the light from its side, and little of the light from the other side."""
    shares = []
    for side in (-1.0, 1.0):
        lamp = DirectionalLight((-side, -0.5, 0.0), shadow=False)
        scene = under(wall, Environment.constant(0), lamp)
        near = lab.render(scene, "s3ho", radius=1.5)
        open = lab.render(scene, "s3ho", radius=1e-3)
        floor = near.mask & (near.world_normal()[..., 1] > 0.9) & (np.nan_to_num(near["visibility"], nan=1) < 0.7)
        assert floor.sum() > 20
        shares.append(near["direct"][floor].sum() / open["direct"][floor].sum())
    behind_the_wall, before_it = shares
    assert behind_the_wall < 0.55
    assert before_it > 0.85


def test_a_light_with_a_shadow_map_is_dark_in_it_and_on_what_faces_away(lab, boxes):
    lamp = DirectionalLight((-1.0, -1.0, -0.6))
    scene = under(boxes, Environment.constant(0), lamp)
    lobes, sharp = (lab.render(scene, "s3ho", lights=kind, size=(160, 120)) for kind in ("lobes", "sharp"))
    np.testing.assert_array_equal(sharp["direct"], lab.render(scene, "ssao", size=(160, 120))["direct"])
    dark = lobes.mask & ~sharp["direct"].any(axis=-1)
    assert dark.sum() > 300
    assert lobes["direct"][dark].max() < 0.02
    lit = sharp["direct"][..., 0] > 0.15
    assert lobes["direct"][lit].max(axis=-1).min() > 0.05


def test_a_shadow_sets_in_where_light_grazes(lab):
    """At 90° a lobe has a fifth of its light, and the shadow map of a ball is rough; the roughness must not appear."""
    ball = small_scenes.of(small_scenes.sphere(1.0, (0, 0, 0)), camera=aolab.Camera((0, 0, 4), (0, 0, 0)))
    found = {}
    for shadow in (True, False):
        lamp = DirectionalLight((-1.0, 0.0, 0.0), (np.pi, np.pi, np.pi), shadow=shadow)
        frame = lab.render(under(ball, Environment.constant(0), lamp), "s3ho", size=(128, 96))
        facing = frame.world_normal()[..., 0]
        found[shadow] = frame["direct"][frame.mask & (np.abs(facing) < 0.04), 0]
    assert found[True].max() < 0.03
    assert found[False].min() > 0.15


# --- relighting


def test_new_light_runs_the_lighting_alone(boxes):
    """Counted by the passes that were timed."""
    lab = Lab((64, 48))
    frame = lab.render(under(boxes, SUN, LAMP), "s3ho", indirect=True).complete()
    assert {"g_buffer", "s3ho", "s3ho senders"} < set(frame.timings)
    moved = [PointLight((1.0, 2.0, 2.0), (5.0, 4.0, 3.0)), DirectionalLight((0, -1, 0.2))]
    lit = lab.relight(frame, environment=SUN.rotated(120), lights=moved)
    assert list(lit.timings) == ["shadows", "direct", "ambient", "indirect", "compose"]
    fresh = lab.render(under(boxes, SUN.rotated(120), *moved), "s3ho", indirect=True)
    for name in ("direct", "ambient", "indirect", "radiance"):
        np.testing.assert_allclose(lit[name], fresh[name], atol=1e-3)
        assert np.abs(lit[name] - frame[name]).max() > 0.05
    np.testing.assert_array_equal(lit["sh1"], frame["sh1"])


# --- one bounce


def test_senders_do_not_depend_on_the_light(lab, boxes):
    dark, bright = (
        lab.render(under(boxes, *light), "s3ho", indirect=True, radius=1.0)
        for light in ((Environment.constant(0),), (SUN, LAMP))
    )
    for i in range(7):
        np.testing.assert_array_equal(dark[f"bounce{i}"], bright[f"bounce{i}"])
    assert dark["indirect"].max() == 0
    assert bright["indirect"].max() > 0.05


def test_a_sender_reflects_as_its_cosine_lobe(lab):
    """Before a wall of one normal and colour, the coefficients are those of its lobe, times albedo and a factor."""
    green = aolab.Material((0.5, 0.9, 0.7))
    scene = small_scenes.of(
        small_scenes.quad((0, 0, 100), (100, 0, 0), (0, 0, -200)),
        small_scenes.quad((0, 0, 100), (0, 0, -200), (0, 50, 0), green),
        camera=aolab.Camera(eye=(4, 3, 0), target=(0.5, 0.3, 0), fov=60),
    )
    frame = lab.render(scene, "s3ho", size=SHARP, indirect=True, radius=1.0, senders="rays", steps=8)
    floor = off_the_crease(frame, scene)
    found = bounces(frame)[floor]  # (n, 3, 16)
    lobe = clamped_cosine(np.array([1.0, 0.0, 0.0]))
    blocked = 1 - frame["visibility"][floor]  # times π, the form factor, times ρ/π
    expected = blocked[:, None, None] * np.array(green.base_color)[:, None] * lobe
    np.testing.assert_allclose(found, expected, atol=0.02)
    assert found[..., 0].max() > 0.1


def test_one_bounce_under_a_constant_sky_is_the_blocked_share_times_the_senders_albedo(lab, wall):
    """With rays, E = π L ρ (1 - visibility) where all senders face the receiver."""
    frame = lab.render(wall, "s3ho", size=SHARP, indirect=True, radius=1.0, senders="rays", steps=8)
    floor = off_the_crease(frame, wall)
    expected = 1 - frame["visibility"][floor]
    assert expected.max() > 0.25
    np.testing.assert_allclose(frame["indirect"][floor][:, 0], expected, atol=0.02)


def test_twelve_buffers_accumulate(lab, boxes):
    """These are more than a framebuffer takes. Rendered twice: textures that are not cleared show when used again."""
    once = [lab.render(under(boxes, SUN), "s3ho", indirect=True, radius=1.0, seed=seed) for seed in (0, 1)]
    for _ in range(2):
        both = lab.render(under(boxes, SUN), "s3ho", indirect=True, radius=1.0, accumulate=2)
        for name in ("occlusion2", "bounce0", "bounce6"):
            mean = (once[0][f"{name}_raw"] + once[1][f"{name}_raw"]) / 2
            np.testing.assert_allclose(both[f"{name}_raw"], mean, atol=2e-3)


@pytest.mark.parametrize("senders", ["rays", "patches"])
def test_it_bounces_like_ssdo_where_senders_are_open(lab, wall, senders):
    """Under lamps alone: only SSDO's senders have occlusion, which dims the sky."""
    lamp = DirectionalLight((-1.0, -0.8, 0.3), (3.0, 2.0, 0.5), shadow=False)
    scene = under(wall, Environment.constant(0), lamp)
    settings: dict = {"radius": 1.0, "filter": "none", "steps": 8, "senders": senders}
    ours = lab.render(scene, "s3ho", indirect=True, light_window=64.0, **settings)["indirect"]
    theirs = lab.render(scene, "ssdo", bounces=1, **settings)["indirect"]
    # a lobe is not a clamped cosine: of this light it has 1.04 on the wall, and 0.98 on the floor
    np.testing.assert_allclose(ours.sum(axis=(0, 1)), theirs.sum(axis=(0, 1)), rtol=0.1)
    assert np.corrcoef(ours.ravel(), theirs.ravel())[0, 1] > 0.98
    broad = lab.render(scene, "s3ho", indirect=True, light_window=1.5, **settings)["indirect"]
    assert np.abs(broad - ours).max() > 0.05 * ours.max()


def test_a_bounce_of_a_light_ends_where_its_shadow_begins(lab, wall):
    """A roof over floor and wall, in the sun: under the roof there is no light, neither direct nor by a bounce."""
    roof = small_scenes.box((-5, 4.0, -50), (50, 4.2, 50))
    sun = DirectionalLight((0.0, -1.0, 0.0), (3.0, 3.0, 3.0))
    covered = small_scenes.of(*(one.mesh for one in wall.instances), roof, camera=wall.camera)
    frame = lab.render(under(covered, Environment.constant(0), sun), "s3ho", indirect=True, radius=1.0)
    assert frame["indirect"].max() < 1e-3
    open = lab.render(under(wall, Environment.constant(0), sun), "s3ho", indirect=True, radius=1.0)
    assert open["indirect"].max() > 0.05


@pytest.mark.parametrize("direction", [(1.0, -1.0, 0.0), (0.0, -1.0, 0.0)], ids=["slanting", "from above"])
def test_surfaces_that_face_away_from_a_lamp_receive_its_bounce(lab, direction):
    """The underside of a shelf over a sunlit floor with the shelf's shadow, against SSDO and rays."""
    sun = DirectionalLight(direction, (np.pi, np.pi, np.pi))
    grey = aolab.Material((0.8, 0.8, 0.8))
    board = small_scenes.box((-0.6, 0.5, -1.5), (0.6, 0.6, 1.5), grey)
    camera = aolab.Camera((-3.2, 0.25, 2.2), (0, 0.3, 0), fov=36)
    scene = under(small_scenes.of(small_scenes.floor(8, grey), board, camera=camera), Environment.constant(0), sun)
    size = (96, 72)
    like = S3HO(radius=1.5, indirect=True)
    truth = aolab.reference(scene, size=size, like=like, rays=64, buffers="indirect", cache=False)["indirect"]
    ours = lab.render(scene, like, size=size)
    theirs = lab.render(scene, "ssdo", radius=1.5, bounces=1, size=size)["indirect"]
    below = ours.mask & (ours.world_normal()[..., 1] < -0.9)
    assert below.sum() > 100
    assert truth[below].mean() > 0.05
    assert ours["indirect"][below].mean() == pytest.approx(truth[below].mean(), rel=0.35)
    assert ours["indirect"][below].mean() == pytest.approx(theirs[below].mean(), rel=0.25)


def test_hidden_surfaces_send_in_their_own_colour(lab, boxes):
    """Layers behind the first one bounce with their own albedo; the boxes hide each other from the camera."""
    camera = aolab.Camera(eye=(-5.0, 1.2, 0.6), target=(0, 0.5, 0), fov=35)
    settings = {"indirect": True, "radius": 1.0, "steps": 8, "camera": camera, "filter": "none"}

    class ColouredAsTheFirst(Layers):
        def draw(self, drawing, view, surfaces, sends):
            drawn = super().draw(drawing, view, surfaces, sends)
            first = {f"sender{number}": surfaces["albedo"] for number in (1, 2, 3)}
            return replace(drawn, bindings=replace(drawn.bindings, textures={**drawn.bindings.textures, **first}))

    kinds = Layers(), ColouredAsTheFirst()
    whole, first = (lab.render(boxes, "s3ho", occluders=kind, **settings)["indirect"] for kind in kinds)
    assert np.abs(whole - first).max() > 0.05


def test_values_out_of_range_are_refused():
    with pytest.raises(ParameterError, match=r"s3ho: strength = -1 is not valid: float, ≥ 0, ≤ 100, in 1 / radii"):
        S3HO(strength=-1)
    with pytest.raises(ParameterError, match=r"s3ho: light_window = 1 is not valid"):
        S3HO(light_window=1)
