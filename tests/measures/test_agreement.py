"""`compare` looks at what two frames say of themselves: views, questions, scenes, lights, and the truth's own noise."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

import aolab
from aolab.errors import Notice
from aolab.measures import compare, relight
from aolab.truth import reference

SIZE = (48, 36)
SUN = aolab.Environment.sky(sun_direction=(1, 1, 0))


@pytest.fixture(scope="module")
def frame(lab, boxes):
    return lab.render(boxes, "ssao", size=SIZE, radius=0.3, falloff=0.3)


def truth(boxes, buffers="visibility", **question):
    return reference(boxes, size=SIZE, rays=128, buffers=buffers, **question)


def test_equal_questions_pass_without_a_word(frame, boxes):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compare(frame, truth(boxes, like=frame), flip=False)
        compare(frame, truth(boxes, radius=0.3, falloff=0.3), "visibility", flip=False)


def test_another_question_is_told_with_what_differs(frame, boxes):
    with pytest.warns(
        Notice, match=r"ssao has radius = 0\.3, falloff = 0\.3, reference has radius = 1\.0, falloff = 0\.0"
    ):
        compare(frame, truth(boxes, radius=1.0), flip=False)
    with pytest.warns(Notice, match=r"ssao has falloff = 0\.3, reference has falloff = 0\.0; .*like=frame"):
        compare(frame, truth(boxes, radius=0.3), flip=False)


def test_a_buffer_that_a_question_does_not_change_is_compared_all_the_same(frame, boxes):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compare(frame, truth(boxes, "direct", radius=1.0, falloff=0), "direct", flip=False)
        # a bounce would depend on it, visibility does not
        compare(frame, truth(boxes, like=aolab.Question(0.3, 0.3)), "visibility", flip=False)


def test_senders_of_another_reach_matter_to_a_bounce(lab, boxes):
    bounced = lab.render(boxes, "ssdo", size=SIZE, radius=0.3, falloff=0.3, bounces=1)
    with pytest.warns(Notice, match=r"ssdo has limited_senders = True, reference has limited_senders = False"):
        compare(bounced, truth(boxes, "indirect", like=aolab.Question(0.3, 0.3)), "indirect", flip=False)


def test_a_module_without_radius_may_be_held_against_any(lab, boxes):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compare(lab.render(boxes, "none", size=SIZE), truth(boxes, radius=0.5, falloff=0), "visibility", flip=False)


def test_another_camera_is_refused(frame, boxes):
    moved = replace(boxes.camera, eye=(0.6, 2.5, 5.0))
    with pytest.raises(aolab.ParameterError, match=r"different cameras: eye = \(0\.5, 2\.5, 5\.0\) against \(0\.6"):
        compare(frame, truth(boxes, like="ssao", camera=moved), flip=False)


def test_another_light_is_told_where_light_is_compared(lab, frame, boxes):
    sunny = truth(boxes.replace(environment=SUN), ("visibility", "ambient"), like=frame)
    with pytest.warns(Notice, match="the environments of ssao and reference differ"):
        compare(frame, sunny, "ambient", flip=False)
    lit = truth(boxes.replace(lights=(aolab.PointLight((0, 3, 0)),)), ("visibility", "direct"), like=frame)
    with pytest.warns(Notice, match="the lights of ssao and reference differ"):
        compare(frame, lit, "direct", flip=False)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compare(frame, lit, "visibility", flip=False)
        warnings.filterwarnings("ignore", "buffer 'ambient': the reference's own standard error")
        compare(lab.relight(frame, environment=SUN), sunny, "ambient", flip=False)


def test_another_scene_is_told(lab):
    camera = aolab.Camera((0, 3, 8), (0, 1, 0))
    a, b = (lab.render(aolab.load(name), "none", size=SIZE, camera=camera) for name in ("boxes", "cornell"))
    with (
        pytest.warns(Notice, match="the scenes differ: none shows boxes, none shows cornell"),
        pytest.warns(Notice, match="pixels, background in one"),
    ):
        compare(a, b, "visibility", flip=False)


def edited(scene, **changes):
    """The scene with another last mesh."""
    *others, last = scene.instances
    mesh = replace(last.mesh, **changes)
    return scene.replace(instances=(*others, replace(last, mesh=mesh)))


def test_a_surface_that_was_moved_or_removed_is_told(frame, boxes):
    *others, last = boxes.instances
    aside = last.world_from_local.copy()
    aside[0, 3] += 0.1
    moved = boxes.replace(instances=(*others, replace(last, world_from_local=aside)))
    vertices = last.mesh.vertices.copy()
    vertices[0] += 0.01
    for other in (moved, boxes.replace(instances=tuple(others)), edited(boxes, vertices=vertices)):
        with pytest.warns(Notice, match="the surfaces of ssao and reference differ"):
            compare(frame, truth(other, like=frame, camera=frame.camera), "visibility", flip=False)


def test_another_material_is_told_where_light_is_compared(frame, boxes):
    material = replace(boxes.instances[-1].mesh.material, base_color=(0.9, 0.1, 0.1))
    red = truth(edited(boxes, material=material), ("visibility", "ambient"), like=frame)
    with pytest.warns(Notice, match="the materials of ssao and reference differ"):
        compare(frame, red, "ambient", flip=False)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compare(frame, red, "visibility", flip=False)


def test_equal_surfaces_pass_whatever_their_names(frame, boxes):
    material = replace(boxes.instances[-1].mesh.material, name="renamed")
    again = edited(boxes, vertices=boxes.instances[-1].mesh.vertices.copy(), material=material)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compare(frame, truth(again, like=frame), "visibility", flip=False)


def noisy_pair(noise):
    """A result that is the truth, and a truth of that standard error."""
    random = np.random.default_rng(1)
    exact = random.uniform(0.2, 0.8, (60, 80)).astype(np.float32)
    seen = exact + random.normal(0, noise, exact.shape).astype(np.float32)
    return exact, {"visibility": seen, "standard_error": np.full(exact.shape, noise, np.float32)}


def test_noise_of_the_truth_that_is_not_small_is_told():
    exact, seen = noisy_pair(0.05)
    with pytest.warns(Notice, match=r"'visibility': the reference's own standard error, 0\.05, is .* of the RMSE"):
        found = compare({"visibility": exact + np.float32(0.05)}, seen, flip=False)
    assert found["visibility"].noise == pytest.approx(0.05)
    assert found["visibility"].rmse == pytest.approx(0.05 * np.sqrt(2), rel=0.03)
    assert "without it the RMSE is about 0.05" in str(found)
    assert found.to_dict()["buffers"]["visibility"]["all"]["noise"] == pytest.approx(0.05)


def test_noise_that_is_small_is_not():
    exact, seen = noisy_pair(0.01)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = compare({"visibility": exact + np.float32(0.05)}, seen, flip=False)
        unknown = compare({"visibility": exact}, {"visibility": seen["visibility"]}, flip=False)
    assert "note" not in str(found)
    assert np.isnan(unknown["visibility"].noise)


def test_harmonics_have_the_noise_of_their_coefficients():
    random = np.random.default_rng(2)
    parts = {f"sh{i}": random.random((8, 8, 4)).astype(np.float32) for i in range(4)}
    errors = {f"sh{i}_standard_error": np.full((8, 8, 4), 0.01 * (i + 1), np.float32) for i in range(4)}
    off = {name: values + 1 for name, values in parts.items()}
    found = compare(off, {**parts, **errors})
    assert found["sh"].noise == pytest.approx(0.01 * np.sqrt((1 + 4 + 9 + 16) / 4))
    assert found["sh_band0"].noise == pytest.approx(0.01)
    assert set(found.buffers) == {"sh", *(f"sh_band{i}" for i in range(4))}


def test_noise_in_relighting_is_one_notice():
    exact, seen = noisy_pair(0.05)
    buffers = {"ambient": np.repeat(seen["visibility"][..., None], 3, axis=2)}
    buffers["ambient_standard_error"] = np.full_like(buffers["ambient"], 0.05)
    result = {"ambient": np.repeat(exact[..., None], 3, axis=2)}
    with pytest.warns(Notice, match="relighting error of 'ambient'.*more `rays`") as told:
        relight(lambda light: result, lambda light: buffers, SUN, k=4)
    assert len(told) == 1
