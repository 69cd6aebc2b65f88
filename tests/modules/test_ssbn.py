"""SSBN: the mean open direction by rays and by hand, cones whose width is exact, and one colour in a corner."""

import numpy as np
import pytest
import small_scenes
import trimesh

import aolab
from aolab import Camera, Environment
from aolab.scene.environment import averaged

SUN = Environment.sky(sun_direction=(1.0, 0.6, 0.3), sun_radiance=(60, 40, 20), sun_angle=20)


def test_an_open_plane_has_its_normal_with_the_length_of_the_hemispheres_mean(lab, plane):
    frame = lab.render(plane, "ssbn")
    bent = frame["bent_normal"][frame.mask]
    np.testing.assert_allclose(bent, np.broadcast_to((0, 2 / 3, 0), bent.shape), atol=1e-3)
    assert (frame["blocked_direction"] == 0).all()


def test_visibility_is_that_of_ssao_with_the_same_samples(lab, boxes):
    ours, plain = (lab.render(boxes, name, radius=0.7) for name in ("ssbn", "ssao"))
    np.testing.assert_allclose(ours["visibility_raw"], plain["visibility_raw"], atol=1e-3)
    np.testing.assert_allclose(ours["visibility"], plain["visibility"], atol=3e-3)


def test_uniform_directions_count_alike(lab, plane, boxes):
    """An open hemisphere's mean is half a unit long, and its cone is the hemisphere; ∫ V cosθ is the same as ever."""
    open = lab.render(plane, "ssbn", weighting="uniform")
    assert np.linalg.norm(open["bent_normal"][open.mask], axis=-1) == pytest.approx(0.5, abs=1e-3)
    settings = {"radius": 0.7, "directions": 64, "filter": "none"}
    uniform = lab.render(boxes, "ssbn", weighting="uniform", **settings)
    for name in ("visibility", "ambient"):
        plain = lab.render(boxes, "ssao", **settings)[name][uniform.mask]
        np.testing.assert_allclose(uniform[name][uniform.mask], plain, atol=5e-3)
    cosine = lab.render(boxes, "ssbn", **settings)
    assert np.abs(uniform["bent_normal"] / 0.5 - cosine["bent_normal"] / (2 / 3)).max() > 0.2


def test_no_bent_normal_is_longer_than_1(lab, boxes):
    for settings in ({"directions": 1}, {"directions": 1, "weighting": "uniform"}, {"filter": "none"}):
        frame = lab.render(boxes, "ssbn", radius=2.0, **settings)
        assert np.linalg.norm(frame["bent_normal"], axis=-1).max() < 1.001


@pytest.mark.slow
def test_bent_normals_are_the_references(lab):
    module = aolab.SSBN(directions=16, steps=16, filter="none", occluders="layers")
    truth = aolab.reference("boxes", size=(160, 90), like=module, rays=128, buffers=("bent_normal",), cache=False)
    frame = lab.render("boxes", module, size=(160, 90), accumulate=4)
    error = (frame["bent_normal"] - truth["bent_normal"])[truth.mask]
    assert np.sqrt((error**2).mean()) < 0.02
    flat = np.abs(truth["bent_normal"] - 2 / 3 * truth.world_normal())[truth.mask]
    assert flat.max() > 0.3  # there is something to bend


def test_an_open_ball_gets_exactly_the_environments_irradiance(lab):
    """The widest cone, in all directions: the table's addresses, borders and interpolation are in here."""
    values, directions, solid_angles = averaged(SUN.radiance, (64, 128))
    ball = small_scenes.of(small_scenes.sphere(1.0, (0, 0, 0)), camera=Camera((0, 0, 4), (0, 0, 0)), sky=SUN)
    for eye in ((0, 0, 4), (0, -4, 0.1), (-3, 0, -3)):
        frame = lab.render(ball, "ssbn", camera=Camera(eye, (0, 0, 0)))
        cosine = np.maximum(frame.world_normal()[frame.mask] @ directions.reshape(-1, 3).T, 0)
        expected = cosine @ (values * solid_angles[..., None]).reshape(-1, 3) / np.pi
        np.testing.assert_allclose(frame["ambient"][frame.mask], expected, atol=0.03 * expected.max())


def test_under_a_constant_sky_it_is_ssao(lab, boxes):
    ours, plain = (lab.render(boxes, name, radius=0.7) for name in ("ssbn", "ssao"))
    np.testing.assert_allclose(ours["ambient"], plain["ambient"], atol=5e-3)


@pytest.mark.parametrize(("weighting", "tolerance"), [("cosine", 0.015), ("uniform", 0.06)])
def test_the_cone_is_as_wide_as_the_opening(lab, weighting, tolerance):
    """At the bottom of a round pit a cap of the sky is open, of half angle α; V = sin²α.

    Where the sky's radiance is sin²θ at the polar angle θ, E = ∫ sin²θ cosθ dω = π sin⁴α / 2, so that E / π = V² / 2.
    """
    half_angle = np.radians(35)
    height = 1 / np.tan(half_angle)
    wall = trimesh.creation.annulus(1.0, 1.2, height, sections=64)
    wall.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, (1, 0, 0)))
    wall.apply_translation((0, height / 2, 0))
    polar = (np.arange(64) + 0.5) / 64 * np.pi
    radiance = np.sin(polar)[:, None, None] ** 2 * np.ones((1, 128, 3))
    scene = small_scenes.of(
        small_scenes.floor(0.9),
        aolab.Mesh(wall.vertices, wall.faces, material=small_scenes.WHITE),
        camera=Camera((0, 6, 0), (0, 0, 0), up=(0, 0, -1), fov=30),
        sky=Environment(radiance.astype(np.float32)),
    )
    # uniform directions need many samples: those near the horizon weigh the most, and all of them are blocked
    settings = {"radius": 4.0, "directions": 64, "steps": 32, "falloff": 0.0, "filter": "none", "accumulate": 16}
    frame = lab.render(scene, "ssbn", size=(33, 33), weighting=weighting, **settings)
    middle = slice(15, 18), slice(15, 18)
    visibility = frame["visibility"][middle].mean()
    assert visibility == pytest.approx(np.sin(half_angle) ** 2, abs=0.08)  # the rim is a pixel wide
    assert frame["ambient"][middle].mean() == pytest.approx(visibility**2 / 2, rel=tolerance)


def test_both_sides_of_a_corner_get_one_colour(lab):
    """The S3HO paper on bent normals: light from the right is the same on the wall as on the floor."""
    two = np.ones((64, 128, 3), np.float32) * 0.1
    two[:20, :, 0] = 3.0  # red from above
    two[24:40, 85:107, 2] = 3.0  # blue from the right, along the floor
    corner = small_scenes.of(
        small_scenes.quad((0, 0, 100), (100, 0, 0), (0, 0, -200)),
        small_scenes.quad((0, 0, 100), (0, 0, -200), (0, 50, 0)),
        camera=Camera(eye=(1.2, 1.0, 0), target=(0.0, 0.1, 0), fov=40),
        sky=Environment(two),
    )
    redness = {}
    for name, settings in {"ssbn": {"weighting": "uniform"}, "s3ho": {}}.items():
        frame = lab.render(corner, name, radius=2.0, directions=32, steps=8, size=(128, 96), **settings)
        x, y, _ = np.moveaxis(small_scenes.world_positions(frame, corner.camera), -1, 0)
        floor = (np.abs(y) < 1e-3) & (x > 0.03) & (x < 0.12)
        wall = (np.abs(x) < 1e-3) & (y > 0.03) & (y < 0.12)
        means = [frame["ambient"][where].mean(axis=0) for where in (floor, wall)]
        redness[name] = [mean[0] / mean[2] for mean in means]
    apart = {name: floor / wall for name, (floor, wall) in redness.items()}
    assert apart["ssbn"] < 2.5 < 4 < apart["s3ho"]  # by rays it is 7
