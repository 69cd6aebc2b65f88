"""Errors told apart: each part appears where its cause is, and nowhere else, and together they are the whole."""

import numpy as np
import pytest
from small_scenes import box, floor, of

import aolab
from aolab.measures.explain import with_margin

# the floor is one quad, open on purpose, and peeling gives a notice
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore:.*not closed:aolab.errors.Notice")]

SIZE = (72, 48)
SMALL = {"size": SIZE, "rays": 64, "frames": 16, "radius": 1.0, "directions": 8}


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


def test_a_margin_leaves_every_pixel_its_sample_set(lab, boxes):
    """50 rows want a margin of 25, which is no whole number of the pattern's periods: 24 then, and the same noise."""
    size, module = (70, 50), aolab.SSAO(radius=0.3, directions=4, steps=1, filter="none").resolved(boxes)
    wide = with_margin(lab, boxes, module, boxes.camera, size, 0, 1)["visibility"]
    plain = lab.render(boxes, module, size=size)["visibility"]
    inner = (slice(10, -10), slice(10, -10))  # whose spheres are on the screen
    difference = np.abs(wide - plain)[inner]
    assert (plain[inner] < 1).mean() > 0.03
    assert np.nanmean(difference > 1e-3) < 0.02


def test_how_far_senders_see_is_a_part_of_the_bounce_alone():
    """In a sealed room no sky reaches a wall, but within the radius of each there is one."""
    walls = box((-2, -2, -2), (2, 2, 2))
    room = of(walls, camera=aolab.Camera(eye=(0, 0.3, 1.9), target=(0, -0.2, 0), fov=90))
    options = {**SMALL, "size": (48, 32), "frames": 4, "bounces": 1}
    bounced = aolab.explain(room, "ssdo", buffer="indirect", **options)
    assert (bounced.truth["indirect"] == 0).all()
    table = bounced.table()
    assert table["limited senders"]["bias"] > 0.02
    assert table["limited senders"]["share"] > 0.5
    assert bounced.residual < 1e-6
    assert "limited senders" not in aolab.explain(room, "ssdo", buffer="ambient", **options).table()


def test_a_blocker_beside_the_image_is_off_screen_geometry():
    """A block close to the left border, outside of it, darkens a floor that one view cannot know to be dark."""
    camera = aolab.Camera(eye=(0, 4, 0.01), target=(0, 0, 0), fov=40)
    left = -4 * np.tan(np.radians(20)) * SIZE[0] / SIZE[1]  # of the image, on the floor
    scene = of(floor(), box((left - 2, 0, -5), (left - 0.02, 0.5, 5)), camera=camera)
    table = aolab.explain(scene, "ssao", **SMALL).table()
    assert table["off-screen geometry"]["share"] > 0.8
    assert table["off-screen geometry"]["bias"] > 0.01  # too bright without it


def test_noise_is_the_part_that_more_directions_cure(boxes, boxes_explained):
    many = aolab.explain(boxes, "ssao", **{**SMALL, "directions": 32}).table()
    few = boxes_explained.table()
    assert many["sampling noise"]["rmse"] < 0.7 * few["sampling noise"]["rmse"]
    assert many["method"]["rmse"] == pytest.approx(few["method"]["rmse"], rel=0.2)


def test_a_long_march_is_the_part_that_more_steps_cure(boxes, boxes_explained):
    marched = aolab.explain(boxes, "ssao", steps=32, **SMALL).table()
    assert marched["few steps"]["rmse"] == 0.0
    assert boxes_explained.table()["few steps"]["rmse"] > 0.005


def test_a_wall_behind_a_post_is_hidden_layers():
    """A block that a nearer one hides darkens the floor beside it only for who knows the second layer."""
    camera = aolab.Camera(eye=(0, 1.2, 6), target=(0, 0.5, 0), fov=40)
    scene = of(floor(), box((-1.2, 0, 1), (1.2, 1.4, 1.3)), box((-1.5, 0, -0.5), (1.5, 0.6, 0)), camera=camera)
    table = aolab.explain(scene, "ssao", thickness=10.0, **SMALL).table()
    assert table["hidden layers"]["rmse"] > 2 * table["method"]["rmse"]
    peeled = aolab.explain(scene, "ssao", occluders="layers", **SMALL).table()
    assert peeled["hidden layers"]["rmse"] == 0.0


def test_without_a_filter_the_filter_has_no_part(boxes):
    assert aolab.explain(boxes, "ssao", filter="none", **SMALL).table()["filter"]["rmse"] == 0.0


def test_the_picture_shows_result_truth_error_and_parts(boxes_explained):
    picture = np.asarray(boxes_explained.picture())
    columns, rows = 2, 5  # nine pictures
    assert picture.shape[0] > rows * SIZE[1]
    assert picture.shape[1] > columns * SIZE[0]


def test_bad_requests_name_the_alternatives(boxes):
    with pytest.raises(aolab.ParameterError, match=r"gives no 'visibilty'; did you mean 'visibility'"):
        aolab.explain(boxes, "ssao", buffer="visibilty", **SMALL)
    with pytest.raises(aolab.ParameterError, match="frames = 1"):
        aolab.explain(boxes, "ssao", **{**SMALL, "frames": 1})


def test_coarse_voxels_are_a_part_that_a_finer_grid_cures(boxes):
    options = {**SMALL, "frames": 4, "scale": 1.0, "steps": 32}
    coarse = aolab.explain(boxes, "hao", voxels=64, **options)
    fine = aolab.explain(boxes, "hao", voxels=512, **options).table()
    table = coarse.table()
    assert coarse.residual < 1e-6
    assert table["hidden layers"]["rmse"] == 0
    assert table["coarse voxels"]["rmse"] > 2 * fine["coarse voxels"]["rmse"]
    assert "coarse voxels" not in aolab.explain(boxes, "ssao", **{**options, "frames": 2}).table()


def test_a_screen_that_the_bounce_passes_through_is_a_part_of_its_own(lab):
    """A lit wall, a floor before it, and a dark screen between them, which the bounce ignores."""
    lit = box((-2, 0, -2.2), (2, 2, -2))
    screen = box((-1.5, 0.01, -1.0), (1.5, 1.5, -0.98))
    lamp = aolab.SpotLight((0, 1.6, -1.2), (0, -0.3, -1), (8, 8, 8), inner=20, outer=30)
    camera = aolab.Camera(eye=(0, 3, 3), target=(0, 0, 0), fov=45)
    dark = aolab.Environment.constant(0.0)
    scene, free = (of(floor(), lit, *more, camera=camera, lights=(lamp,), sky=dark) for more in ((screen,), ()))
    options = {"buffer": "indirect", "size": (48, 32), "rays": 128, "frames": 8}
    explained = aolab.explain(scene, "rsm", **options)
    table = explained.table()
    assert explained.residual < 1e-6
    assert table["unblocked bounce"]["bias"] > 0.5 * table["error"]["bias"] > 0
    assert abs(table["method"]["bias"]) < 0.1 * table["unblocked bounce"]["bias"]
    through, plain = (
        aolab.reference(one, buffers="indirect", rays=256, blocked_senders=blocked, size=(48, 32), cache=False)
        for one, blocked in ((scene, False), (free, True))
    )
    ground = through.mask & (through.world_normal()[..., 1] > 0.9) & np.isclose(through["viewZ"], plain["viewZ"])
    assert through["indirect"][ground].mean() == pytest.approx(plain["indirect"][ground].mean(), rel=0.02)
