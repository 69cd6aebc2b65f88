"""Notices stand at the line of the user's own code, however deep in aolab they come from."""

import inspect
import warnings

import numpy as np
import pytest

import aolab
from aolab import Camera, Instance, Mesh, Notice, Scene

CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], float)
SIZE = (32, 24)


def degenerate() -> object:
    return Mesh(CORNERS, np.array([(0, 1, 2), (0, 0, 1)]))


def empty_picture() -> object:
    scene = Scene((Instance(Mesh(CORNERS, np.array([(0, 1, 2)]))),), camera=Camera(eye=(9, 9, 9), target=(19, 19, 19)))
    return aolab.render(scene, "none", size=SIZE)


def other_question() -> object:
    truth = aolab.reference("boxes", size=SIZE, rays=4, buffers="visibility", radius=0.7, cache=False)
    return aolab.compare(aolab.render("boxes", "ssao", size=SIZE, radius=0.3), truth, flip=False)


@pytest.mark.parametrize("function", [degenerate, empty_picture, other_question])
def test_a_notice_names_the_line_that_has_led_to_it(function):
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always", Notice)
        function()
    lines, first = inspect.getsourcelines(function)
    assert seen
    for one in seen:
        assert one.filename == __file__
        assert first < one.lineno < first + len(lines)
