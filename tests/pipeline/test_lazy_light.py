"""The light of a frame is computed when its first buffer is read, and is then that of the frame's own time."""

import gc
import os
import pickle
from pathlib import Path

import numpy as np
import pytest

import aolab
from aolab.modules import MODULES
from aolab.pipeline.lab import Lab

LIGHT = {"direct", "ambient", "compose"}
OPTIONS = {"ssdo": {"bounces": 1, "light_steps": 2}, "s3ho": {"indirect": True}}


def buffers_of(frame: aolab.Frame) -> dict[str, np.ndarray]:
    return {name: frame[name].copy() for name in frame.buffers}


def same(frame: aolab.Frame, expected: dict[str, np.ndarray]) -> None:
    assert frame.buffers == sorted(expected)
    for name, values in expected.items():
        np.testing.assert_array_equal(frame[name], values, err_msg=name)


def test_reading_visibility_lights_nothing(lab, boxes):
    frame = lab.render(boxes, "ssao")
    frame["visibility"], frame["viewZ"], frame.mask, repr(frame)
    assert not LIGHT & set(frame.timings)
    before = frame.frame_ms
    frame["ambient"]
    assert set(frame.timings) >= LIGHT
    assert frame.frame_ms >= before + sum(frame.timings[name] for name in LIGHT)
    passes = dict(frame.timings)
    frame.image, frame["direct"]
    assert frame.timings == passes  # computed once
    frame.complete()
    assert set(frame.timings) - set(passes) == {"albedo"}  # no part of the light


OTHERS = [aolab.Environment(np.full((4, 8, 3), radiance)) for radiance in (0.5, 1.0, 2.0)]


@pytest.mark.parametrize("name", MODULES)
def test_the_buffers_are_listed_before_they_are_computed(lab, boxes, name):
    frame = lab.render(boxes, name, **OPTIONS.get(name, {}))
    listed = frame.buffers
    assert set(frame.complete().made) | set(frame.derived) == set(listed)


@pytest.mark.parametrize("name", MODULES)
def test_other_frames_in_between_change_nothing(lab, boxes, plane, name):
    options = OPTIONS.get(name, {})
    lit = boxes.replace(lights=(aolab.SpotLight((1, 3, 1), (0, -1, 0), (20.0, 20.0, 20.0)),))
    expected = buffers_of(lab.render(lit, name, **options).complete())
    frame = lab.render(lit, name, **options)
    for seed in range(3):  # other lights, sizes and environments; their textures go back to the pool
        lab.render(plane.replace(environment=OTHERS[seed]), "ssdo", seed=seed).complete()
        lab.render(boxes, name, size=(17, 9), exposure=2.0, **options).complete()
        lab.render(boxes, name, seed=seed + 1, **options)
        gc.collect()
    same(frame, expected)


def darken(file: Path) -> None:
    """The picture becomes black; the file's time of writing differs for certain."""
    text = file.read_text()
    assert text.count("return srgbFromLinear(") == 1
    file.write_text(text.replace("return srgbFromLinear(", "return 0.0 * srgbFromLinear("))
    os.utime(file, (2e9, 2e9))


@pytest.mark.parametrize("watch", [False, True])
def test_an_edit_of_the_lighting_leaves_frames_of_before(shaders, boxes, watch):
    lab = Lab((32, 24), watch=watch)
    expected = lab.render(boxes, "ssao").image
    frame = lab.render(boxes, "ssao")
    darken(shaders / "lib" / "display.glsl")
    if not watch:
        lab.reload()
    assert lab.render(boxes, "ssao").image.max() == 0
    np.testing.assert_array_equal(frame.image, expected)


def test_a_frame_that_follows_another_is_lit_at_once(lab, boxes):
    """Its passes may read the last frame, which may be dropped and drawn over."""
    first = lab.render(boxes, "ssao")
    assert first.later
    assert not lab.render(boxes, "ssao", last=first).later
    assert not first.later  # the second frame may read its light


def test_relit_and_stored_frames_are_whole(lab, boxes):
    frame = lab.render(boxes, "ssao")
    relit = lab.relight(frame, exposure=0.5)
    assert not relit.later
    assert frame.later
    same(pickle.loads(pickle.dumps(frame)), buffers_of(frame))


def test_an_error_of_the_lighting_comes_when_it_is_read(lab, boxes):
    class Dark(aolab.SSAO):
        def lighting(self):
            direct, ambient = super().lighting()
            return [
                direct,
                aolab.Pass("ambient", "out vec4 ambient;\nvoid main() { ambient = missing; }\n", ambient.outputs),
            ]

    frame = lab.render(boxes, Dark())
    assert np.isfinite(frame["visibility"][frame.mask]).all()
    for _ in range(2):
        with pytest.raises(aolab.ShaderError, match="missing"):
            frame["image"]
    same(lab.render(boxes, "ssao"), buffers_of(lab.render(boxes, "ssao").complete()))
