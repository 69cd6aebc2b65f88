"""The reference answers a module's whole question: radius, falloff, measure, cone, and how far senders see."""

import warnings

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Question
from aolab.maths.fading import openness
from aolab.truth import reference

from .rooms import CEILING, ceiling_scene, quad, scene, wall_scene

SIZE = (48, 32)
K = 0.3  # (ceiling / radius)²
RADIUS = CEILING / np.sqrt(K)


def under_a_ceiling(fading, spread=1.0, sigma=1.0):
    """cos²θ = s is uniform over the cone under cosθ, and the ceiling is at d = c / cosθ: a quadrature over s."""
    least = np.cos(spread * np.pi / 2) ** 2
    s = least + (1 - least) * (np.arange(100_000) + 0.5) / 100_000
    return openness(np.sqrt(K / s), fading, sigma).mean()


def assert_mean(frame, name, expected, least=1e-3):
    error = frame[f"{'' if name == 'visibility' else f'{name}_'}standard_error"][frame.mask]
    allowed = float(4 * np.sqrt((error**2).mean() / error.size)) + least
    assert frame[name][frame.mask].mean() == pytest.approx(expected, abs=allowed)


@pytest.mark.parametrize("spread", [0.25, 0.5, 0.75, 1.0])
def test_a_cone_under_a_ceiling(spread):
    """With a hard edge, (K - cos²θ) / sin²θ of the cone is open, θ its half-angle; nothing for a narrow cone."""
    cosine = np.cos(spread * np.pi / 2)
    expected = max(K - cosine**2, 0) / (1 - cosine**2)
    question = Question(RADIUS, spread=spread)
    frame = reference(ceiling_scene(), size=SIZE, like=question)
    assert_mean(frame, "visibility", expected)
    assert expected == pytest.approx(under_a_ceiling(0.0, spread), abs=1e-4)


@pytest.mark.parametrize("spread", [0.5, 1.0])
def test_an_open_cone_is_open_and_its_sky_is_that_of_the_hemisphere(spread):
    camera = aolab.Camera(eye=(0, 3, 1), target=(0, 0, 0))
    plane = scene(quad((0, 0, 0), (0, 0, 9), (9, 0, 0)), camera=camera, environment=aolab.Environment.constant(2.0))
    frame = reference(plane, size=SIZE, rays=64, spread=spread)
    assert (frame["visibility"][frame.mask] == 1).all()
    np.testing.assert_allclose(frame["ambient"], 2 * frame["albedo"], rtol=1e-5)
    cosine = np.cos(spread * np.pi / 2)
    mean_height = 2 / 3 * (1 - cosine**3) / (1 - cosine**2)  # ∫ cos²θ dω / ∫ cosθ dω over the cone
    np.testing.assert_allclose(frame["bent_normal"].mean(axis=(0, 1)), (0, mean_height, 0), atol=1e-3)


@pytest.mark.parametrize(("spread", "fading"), [(1.0, "wendland"), (0.5, "wendland"), (1.0, "linear"), (1.0, "sqrt")])
def test_visibility_with_the_fading_of_a_paper(spread, fading):
    frame = reference(ceiling_scene(), size=SIZE, like=Question(RADIUS, fading, spread=spread))
    assert_mean(frame, "visibility", under_a_ceiling(fading, spread))


def test_a_closed_cap_fades_by_its_distance_alone():
    """Inside a ball of radius r, seen from its centre, every direction is closed at r: openness(r / R), any cone."""
    ball = small_scenes.sphere(0.6, (0, 0, 0), subdivisions=5)
    post = quad((0, 0, 0), (0.01, 0, 0), (0, 0, 0.01))
    camera = aolab.Camera(eye=(0, 0.3, 0.001), target=(0, 0, 0), fov=2)
    for fading in ("wendland", "exponential", 0.8):
        for spread in (0.5, 1.0):
            question = Question(1.0, fading, "wendland", spread=spread, sigma=3.0)
            frame = reference(
                scene(post, ball, camera=camera),
                size=(8, 8),
                rays=64,
                like=question,
                buffers=("visibility", "obscurance"),
            )
            expected = openness(np.float32([0.6]), fading, 3.0)[0]
            np.testing.assert_allclose(frame["visibility"], expected, atol=0.02)
            np.testing.assert_allclose(frame["obscurance"], openness(np.float32([0.6]), "wendland")[0], atol=0.02)


@pytest.mark.parametrize(
    ("measure", "sigma"), [("linear", 1.0), ("exponential", 1.0), ("exponential", 4.0), ("wendland", 1.0)]
)
def test_obscurance_with_the_measure_and_its_sigma(measure, sigma):
    question = Question(RADIUS, measure=measure, sigma=sigma)
    frame = reference(ceiling_scene(), size=SIZE, like=question, buffers="obscurance")
    assert_mean(frame, "obscurance", under_a_ceiling(measure, sigma=sigma), least=3e-3)


def test_the_measure_leaves_visibility_alone():
    """The exponential measure sends rays beyond the radius, where nothing blocks visibility."""
    settings = {"size": SIZE, "rays": 32, "radius": 1.2, "cache": False}
    both = reference(ceiling_scene(), **settings, measure="exponential", buffers=("visibility", "obscurance"))
    alone = reference(ceiling_scene(), **settings, buffers="visibility")
    np.testing.assert_allclose(both["visibility"], alone["visibility"], atol=1e-6)


def test_a_module_of_ones_own_states_its_question():
    class Cone(aolab.SSAO):
        name = "cone"

        def question(self):
            return super().question().replace(falloff="wendland", spread=0.5)

    frame = reference(ceiling_scene(), size=SIZE, like=Cone(radius=RADIUS))
    assert frame.info["question"]["spread"] == 0.5
    assert_mean(frame, "visibility", under_a_ceiling("wendland", 0.5))


def test_like_a_frame_takes_its_question_size_and_camera(lab):
    room = wall_scene()
    camera = aolab.Camera(eye=(2, 2, 1), target=(1, 0, 0), fov=40)
    frame = lab.render(room, "ssao", size=SIZE, camera=camera, radius=0.7, falloff=0.4)
    truth = reference(room, like=frame, rays=4)
    np.testing.assert_array_equal(truth["viewZ"], frame["viewZ"])
    assert truth.info["question"] == frame.info["question"]
    again = reference(room, like=truth, rays=4)
    np.testing.assert_array_equal(again["visibility"], truth["visibility"])
    assert reference(room, like=frame, size=(24, 16), rays=4).size == (24, 16)
    nameless = aolab.Frame({"viewZ": frame["viewZ"]}, {}, {**frame.info, "question": None})
    del nameless.info["question"]
    with pytest.raises(aolab.ParameterError, match="a frame of ssao does not say its question"):
        reference(room, like=nameless)


def test_senders_under_a_ceiling_see_as_far_as_the_module():
    """Floor and ceiling see V = K of a sky of 1 within the radius; so the ceiling sends a K to the closed 1 - V."""
    room = ceiling_scene(environment=aolab.Environment.constant(1.0))
    limited = reference(room, size=SIZE, rays=128, like=Question(RADIUS, limited_senders=True), buffers="indirect")
    physical = reference(room, size=SIZE, rays=128, radius=RADIUS, buffers="indirect")
    assert_mean(limited, "indirect", 0.8 * (1 - K) * 0.8 * K)
    assert physical["indirect"].mean() < 0.02  # the planes end somewhere
    like = reference(room, size=SIZE, rays=128, like=aolab.SSDO(radius=RADIUS, falloff=0), buffers="indirect")
    np.testing.assert_array_equal(like["indirect"], limited["indirect"])


def sealed_room():
    x, y, z = 2 * np.eye(3)
    walls = [quad(side * a, b, c) for a, b, c in ((x, y, z), (y, z, x), (z, x, y)) for side in (1, -1)]
    camera = aolab.Camera(eye=(0, 0.3, 1.9), target=(0, -0.2, 0), fov=90)
    return scene(*walls, camera=camera, environment=aolab.Environment.constant(1.0))


def test_in_a_sealed_room_a_module_and_its_truth_bounce_alike(lab):
    """Measured: ambient .716 by rays, .724 by SSDO; indirect .043 by both. The physical answer has no bounce at all."""
    module = aolab.SSDO(
        radius=1.0, bounces=1, senders="rays", directions=16, steps=16, filter="none", thickness=10.0, bias=0.0
    )
    frame = lab.render(sealed_room(), module, size=(64, 48), accumulate=4)
    truth = reference(sealed_room(), like=frame, rays=64)
    for name, tolerance in (("ambient", 0.02), ("indirect", 0.12)):
        assert frame[name][frame.mask].mean() == pytest.approx(truth[name][truth.mask].mean(), rel=tolerance)
    assert truth["indirect"].mean() > 0.03
    physical = reference(sealed_room(), radius=1.0, falloff=module.falloff, size=(64, 48), rays=16, buffers="indirect")
    assert (physical["indirect"] == 0).all()


def test_a_radius_alone_is_answered_with_the_falloff_of_the_modules():
    scene = small_scenes.plane()
    with pytest.warns(aolab.Notice, match=r"the reference's falloff is 0.* that of modules is 0\.3 by default"):
        aolab.reference(scene, size=(8, 6), rays=2, radius=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        aolab.reference(scene, size=(8, 6), rays=2, radius=1.0, falloff=0)
        aolab.reference(scene, size=(8, 6), rays=2, like="ssao")
        aolab.reference(scene, size=(8, 6), rays=2)
