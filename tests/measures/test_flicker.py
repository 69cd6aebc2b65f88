"""Flicker: nothing for what is painted on surfaces, all of it for what changes, however the camera moves."""

from dataclasses import asdict, replace

import numpy as np
import pytest
import small_scenes

import aolab
from aolab.measures.flicker import flicker

CAMERA = aolab.Camera((0.5, 2.5, 5), (0, 0.5, 0), fov=45)
MOVED = [replace(CAMERA, eye=(0.5 + 0.05 * i, 2.5, 5 - 0.03 * i)) for i in range(4)]


def painted(lab, paint, cameras=MOVED) -> list[aolab.Frame]:
    """The boxes with `visibility` = paint(number of the frame, world positions)."""
    frames = []
    for i, camera in enumerate(cameras):
        frame = lab.render(small_scenes.boxes(), "none", camera=camera, size=(96, 72))
        arrays = {"viewZ": frame["viewZ"], "visibility": paint(i, small_scenes.world_positions(frame, camera))}
        frames.append(aolab.Frame(arrays, {}, {"size": [96, 72], "camera": asdict(camera), "module": "painted"}))
    return frames


def test_paint_on_surfaces_does_not_flicker(lab):
    """A pattern that is linear in the world is interpolated exactly, wherever the camera goes."""
    found = flicker(painted(lab, lambda i, position: np.nan_to_num(position @ (0.1, 0.2, 0.05), posinf=0, neginf=0)))
    assert found.mean < 1e-3  # perspective is not linear within a pixel
    assert 0.8 < found.seen < 1


def test_a_change_of_the_whole_is_the_flicker(lab):
    found = flicker(painted(lab, lambda i, position: np.full(position.shape[:2], 0.25 * (i % 2))))
    assert found.mean == pytest.approx(0.25)
    assert found.p99 == pytest.approx(0.25)


def test_noise_that_is_fixed_to_the_picture_flickers_when_the_camera_moves_only(lab):
    noise = np.random.default_rng(2).random((72, 96))
    assert flicker(painted(lab, lambda i, position: noise)).mean > 0.08
    still = flicker(painted(lab, lambda i, position: noise, [CAMERA] * 3))
    assert still == aolab.measures.flicker.Flicker(0.0, 0.0, 1.0)


@pytest.mark.filterwarnings("ignore:nothing is drawn")
def test_bad_requests(lab, boxes):
    frame = lab.render(boxes, "ssao")
    with pytest.raises(aolab.ParameterError, match="1 given, at least 2"):
        flicker([frame])
    with pytest.raises(aolab.ParameterError, match="differ in size: 32x24, 64x48"):
        flicker([frame, lab.render(boxes, "ssao", size=(32, 24))])
    away = replace(CAMERA, target=(0.5, 2.5, 9))
    with pytest.raises(aolab.ParameterError, match="no surface is seen in two"):
        flicker([frame, lab.render(boxes, "ssao", camera=replace(away, eye=(0.5, 90, 5), target=(0.5, 200, 9)))])
    with pytest.raises(aolab.ParameterError, match="no buffer 'visibilty'; did you mean 'visibility'"):
        flicker([frame, frame], "visibilty")
