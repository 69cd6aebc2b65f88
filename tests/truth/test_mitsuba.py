"""The second opinion: Mitsuba's path tracer and our two ways to the same light, within stated errors."""

import importlib.util
import sys

import numpy as np
import pytest

import aolab
from aolab.environment import direction_from_uv
from aolab.errors import Error, ParameterError, SceneError
from aolab.shapes import placed
from aolab.truth import reference
from aolab.truth.mitsuba import path_traced, run_worker
from aolab.truth.picture import over_environment
from aolab.view import View

from .rooms import quad, scene, wall_scene

SIZE = (64, 48)
FINE = 8  # our pixels are points: this many, squared, average to the area of one of Mitsuba's

needs_mitsuba = pytest.mark.skipif(not importlib.util.find_spec("mitsuba"), reason="needs Mitsuba: pip install mitsuba")


def fine(buffer):
    """(H, W, channels): the mean over each of Mitsuba's pixels of a buffer that is `FINE` times as large."""
    height, width = buffer.shape[0] // FINE, buffer.shape[1] // FINE
    return np.nan_to_num(buffer.astype(np.float64)).reshape(height, FINE, width, FINE, -1).mean(axis=(1, 3))


FINE_SIZE = (SIZE[0] * FINE, SIZE[1] * FINE)


def bias_and_error(a, b):
    """Signed mean and root mean square of a - b, as shares of the mean of b."""
    return (a - b).mean() / b.mean(), np.sqrt(((a - b) ** 2).mean()) / b.mean()


def cornell(camera=None):
    """The Cornell box with its bulb a metre lower: under the lid, a few bright pixels would be all of the noise.

    The camera is rolled, for edges along rows of pixels would meet all of our sample points at once, or none.
    """
    box = aolab.load("cornell")
    bulb = aolab.PointLight((0, 4.4, -2.8), (18.0, 14.0, 9.0))
    rolled = aolab.Camera(box.camera.eye, box.camera.target, up=(0.17, 1, 0), fov=box.camera.fov)
    return box.replace(lights=(bulb,), camera=camera or rolled)


@needs_mitsuba
def test_direct_light_in_the_cornell_box_by_three_engines():
    second = path_traced(cornell(), size=SIZE, samples=256, buffers="direct")["direct"]
    first = fine(reference(cornell(), size=FINE_SIZE, rays=2, buffers="direct")["direct"])
    drawn = fine(aolab.render(cornell(), "none", size=FINE_SIZE)["direct"])
    print(bias_and_error(first, second), bias_and_error(drawn, second), bias_and_error(drawn, first))


@needs_mitsuba
def test_environment_and_bounce_in_the_cornell_box_by_two_engines():
    second = path_traced(cornell(), size=SIZE, samples=256, buffers=("ambient", "indirect"))
    first = reference(cornell(), size=FINE_SIZE, rays=8, buffers=("ambient", "indirect"))
    for n in ("ambient", "indirect"):
        print(n, bias_and_error(fine(first[n]), second[n]))


@needs_mitsuba
def test_unoccluded_ambient_light_is_right_where_nothing_blocks():
    """From outside, the Cornell box is all but convex: what is seen of it sees the whole sky."""
    behind = aolab.Camera(eye=(-9, -6, -16), target=(0, 2.7, -2.8), up=(0.17, 1, 0), fov=32)
    second = path_traced(cornell(behind), size=SIZE, samples=256, buffers="ambient")["ambient"]
    drawn = fine(aolab.render(cornell(behind), "none", size=FINE_SIZE)["ambient"])
    print(bias_and_error(drawn, second))
    np.save("/tmp/out_a.npy", np.stack([drawn, second]))
