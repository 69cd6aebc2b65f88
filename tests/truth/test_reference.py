"""The function itself: its pixels, arguments, errors, seeds."""

import re
import sys

import numpy as np
import pytest

import aolab
from aolab.errors import ParameterError
from aolab.truth import reference
from aolab.truth.tracing import CHUNK

from .rooms import ceiling_scene, quad, scene, wall_scene

SIZE = (64, 48)


def test_pixels_are_those_of_a_render():
    frame, render = reference(wall_scene(), size=SIZE, rays=2), aolab.render(wall_scene(), "none", size=SIZE)
    for name in ("viewZ", "viewNormal", "albedo"):
        np.testing.assert_array_equal(frame[name], render[name])
    assert frame.size == render.size
    errors = ["standard_error", *(f"{name}_standard_error" for name in ("ambient", "bent_normal", "indirect"))]
    results = ["visibility", "ambient", "bent_normal", "indirect"]
    assert frame.buffers == sorted(["viewZ", "viewNormal", "albedo", *results, *errors])


def test_the_background_is_nan_in_scalars_and_black_in_light():
    small = scene(quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), camera=aolab.Camera((0, 0, 9), (0, 0, 0)))
    frame = reference(small, size=SIZE, rays=2)
    background = ~frame.mask
    assert 0 < background.mean() < 1
    assert np.isnan(frame["visibility"][background]).all()
    assert np.isnan(frame["standard_error"][background]).all()
    assert (frame["ambient"][background] == 0).all()
    assert np.isnan(frame["ambient_standard_error"][background]).all()


@pytest.mark.filterwarnings("ignore:nothing is drawn")
def test_a_camera_that_sees_nothing_gets_a_frame_all_the_same():
    away = scene(quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), camera=aolab.Camera((0, 0, 9), (0, 0, 20)))
    frame = reference(away, size=SIZE, rays=2)
    assert not frame.mask.any()
    assert np.isnan(frame["visibility"]).all()


def test_the_seed_decides_and_threads_do_not():
    size = (200, 150)
    assert size[0] * size[1] > CHUNK  # several chunks, in whatever order
    one, same, other = (
        reference(wall_scene(), size=size, rays=4, seed=seed, cache=False)["visibility"] for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(one, same)
    assert (one != other).mean() > 0.05


def test_chunks_do_not_repeat_each_others_noise():
    noise = reference(ceiling_scene(), size=(2 * CHUNK // 128, 128), rays=16, radius=1.9, buffers="visibility")
    first, second = np.split(noise["visibility"].reshape(-1), 2)
    assert (first != second).mean() > 0.3


def test_like_takes_radius_and_falloff_from_the_module():
    module = aolab.SSAO(radius=0.7, falloff=0.4)
    like = reference(wall_scene(), size=SIZE, rays=16, like=module, buffers="visibility")
    given = reference(wall_scene(), size=SIZE, rays=16, radius=0.7, falloff=0.4, buffers="visibility")
    np.testing.assert_array_equal(like["visibility"], given["visibility"])
    assert like.info["parameters"]["radius"] == 0.7


def test_like_by_name_resolves_auto():
    room = wall_scene()
    expected = aolab.SSAO().resolved(room)
    parameters = reference(room, size=SIZE, rays=2, like="ssao", buffers="visibility").info["parameters"]
    assert (parameters["radius"], parameters["falloff"]) == (expected.radius, expected.falloff)
    assert reference(room, size=SIZE, rays=2, like="none", buffers="visibility").info["parameters"]["radius"] is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"rays": 3}, r"rays = 3 is not an even whole number"),
        ({"radius": 0}, r"radius = 0 is not a length above 0"),
        ({"radius": float("nan")}, r"radius = nan is not a length above 0"),
        ({"falloff": 1.5}, r"falloff = 1\.5 is outside \[0, 1\]"),
        ({"buffers": ["visiblity"]}, r"no buffer 'visiblity'; did you mean 'visibility'"),
        ({"like": "ssao", "radius": 1.0}, r"radius comes from `like`; give either radius or `like`"),
        ({"raduis": 1.0}, r"a question has no 'raduis'; did you mean 'radius'"),
        ({"error": 1.5}, r"error = 1\.5 is not a share in \(0, 1\)"),
        ({"falloff": "wendland"}, r"falloff = 'wendland' needs a radius"),
        ({"engine": "mitsuba", "error": 0.1}, r"'mitsuba' has no radius, falloff, like or error"),
        ({"measure": "cubic"}, r"measure = 'cubic' is unknown"),
        ({"bounces": -1}, r"bounces = -1 is not a whole number"),
        ({"engine": "optix"}, r"engine = 'optix' is unknown"),
        ({"seed": -1}, r"seed = -1 is not a whole number"),
    ],
)
def test_wrong_arguments_are_named_before_any_work(arguments, message):
    with pytest.raises(ParameterError, match=message):
        reference(wall_scene(), **arguments)


def test_a_bar_is_shown_when_asked_for(capfd, monkeypatch):
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)  # tests of notebooks import it into this process
    reference(wall_scene(), size=SIZE, rays=2, cache=False, progress=True)
    assert "reference" in capfd.readouterr().err
    reference(wall_scene(), size=SIZE, rays=2, cache=False)
    assert capfd.readouterr().err == ""


def test_the_bar_advances_while_all_points_are_in_hand(capfd, monkeypatch):
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    reference(wall_scene(), size=SIZE, rays=2048, cache=False, progress=True)  # fewer points than a chunk has
    percentages = {int(one) for one in re.findall(r"(\d+)%", capfd.readouterr().err)}
    assert len(percentages - {0, 100}) >= 2


def test_a_curved_surface_is_seen_right_up_to_its_edges():
    """A convex body hides nothing from itself, but for what its facets and smooth normals disagree on."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=5)
    frame = reference(scene(aolab.Mesh(ball.vertices, ball.faces)), size=SIZE, rays=64, buffers="visibility")
    assert frame["visibility"][frame.mask].mean() > 0.999
    assert frame["visibility"][frame.mask].min() > 0.95
