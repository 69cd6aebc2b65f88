"""Errors told apart: each part appears where its cause is, and nowhere else, and together they are the whole."""

import numpy as np
import pytest
from small_scenes import box, floor, of

import aolab

SIZE = (96, 64)
SMALL = {"size": SIZE, "rays": 64, "frames": 32, "radius": 1.0, "directions": 8}


@pytest.fixture(scope="module")
def boxes_explained(lab, boxes):
    return aolab.explain(boxes, "ssao", **SMALL)


def test_the_parts_add_up_to_the_error(boxes_explained):
    explained = boxes_explained
    whole = explained.frame["visibility"] - explained.truth["visibility"]
    assert np.nanmax(np.abs(sum(explained.parts.values()) - whole)) < 1e-6
    assert explained.residual < 1e-6
    shares = [row["share"] for name, row in explained.table().items() if name != "error"]
    assert sum(shares) == pytest.approx(1.0, abs=1e-6)


def test_a_plane_has_no_error_of_any_kind(plane):
    explained = aolab.explain(plane, "ssao", **SMALL)
    assert all(row["rmse"] == 0.0 for row in explained.table().values())


def test_a_blocker_beside_the_image_is_off_screen_geometry():
    """A block close to the left border, outside of it, darkens a floor that one view cannot know to be dark."""
    camera = aolab.Camera(eye=(0, 4, 0.01), target=(0, 0, 0), fov=40)
    left = -4 * np.tan(np.radians(20)) * SIZE[0] / SIZE[1]  # of the image, on the floor
    scene = of(floor(), box((left - 2, 0, -5), (left - 0.02, 0.5, 5)), camera=camera)
    table = aolab.explain(scene, "ssao", steps=16, **SMALL).table()
    assert table["off-screen geometry"]["share"] > 0.8
    assert table["off-screen geometry"]["bias"] > 0.01  # too bright without it


def test_noise_is_the_part_that_more_directions_cure(boxes, boxes_explained):
    many = aolab.explain(boxes, "ssao", **{**SMALL, "directions": 128}).table()
    few = boxes_explained.table()
    assert many["sampling noise"]["rmse"] < 0.5 * few["sampling noise"]["rmse"]
    method = "hidden layers and method"
    assert many[method]["rmse"] == pytest.approx(few[method]["rmse"], rel=0.2)


def test_without_a_filter_the_filter_has_no_part(boxes):
    assert aolab.explain(boxes, "ssao", filter="none", **SMALL).table()["filter"]["rmse"] == 0.0


def test_the_picture_shows_result_truth_error_and_parts(boxes_explained):
    picture = np.asarray(boxes_explained.picture())
    columns, rows = 2, 4  # seven pictures
    assert picture.shape[0] > rows * SIZE[1]
    assert picture.shape[1] > columns * SIZE[0]


def test_bad_requests_name_the_alternatives(boxes):
    with pytest.raises(aolab.ParameterError, match=r"gives no 'visibilty'; did you mean 'visibility'"):
        aolab.explain(boxes, "ssao", buffer="visibilty", **SMALL)
    with pytest.raises(aolab.ParameterError, match="frames = 1"):
        aolab.explain(boxes, "ssao", **{**SMALL, "frames": 1})
