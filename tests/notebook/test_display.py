"""Objects show themselves: short reprs, pictures with colour bars, HTML for notebooks."""

import pickle
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

import aolab
from aolab import Frame, ParameterError
from aolab.modules import MODULES, known_buffers
from aolab.modules.parameters import own_first
from aolab.pictures import buffers, html
from aolab.pictures.buffers import BACKGROUND, Scale, buffer_picture, buffer_pixels, scale_of


@pytest.fixture(scope="module")
def frame(lab, boxes):
    return lab.render(boxes, "s3ho")


def made(**buffers: np.ndarray) -> Frame:
    """A frame without an image, as the reference gives for chosen buffers."""
    height, width = next(iter(buffers.values())).shape[:2]
    return Frame(buffers, {}, {"module": "reference", "size": [width, height]})


def test_reprs_are_short(lab, boxes, frame):
    assert repr(boxes).startswith("<Scene 'scene': 38 triangles, 4 meshes, no lights, <Environment 'constant': 2x1, ")
    assert repr(lab).startswith("<Lab 64x48 on ")
    for shown in (boxes, boxes.environment, lab):
        assert len(repr(shown)) < 200
        assert "array" not in repr(shown)


def test_a_frame_is_read_like_a_dictionary(frame):
    assert "visibility" in frame
    assert "visibilty" not in frame
    assert list(frame) == frame.keys() == frame.buffers == frame._ipython_key_completions_()
    assert (dict(frame)["visibility"] == frame["visibility"])[frame.mask].all()


def test_a_frame_is_pickled_as_arrays(frame):
    copy = pickle.loads(pickle.dumps(frame))
    assert copy.buffers == frame.buffers
    for name in frame:
        np.testing.assert_array_equal(copy[name], frame[name])
    assert copy.info == frame.info
    with pytest.raises(ParameterError, match="not rendered by a lab"):
        aolab.Lab((64, 48)).relight(copy)


@pytest.mark.parametrize("module", MODULES)
def test_every_buffer_of_every_module_has_a_picture(lab, boxes, module):
    frame = lab.render(boxes, module)
    for name in frame:
        picture = frame.show(name)
        assert picture.width >= 64, name
        assert np.asarray(picture).std() > 0, name


def test_a_frame_without_an_image_shows_its_first_buffer(boxes):
    half, depth = np.full((4, 6), 0.5, np.float32), np.full((4, 6), -1, np.float32)
    frame = made(visibility=half, viewZ=depth, albedo=np.ones((4, 6, 3), np.float32))
    picture = Image.open(BytesIO(frame._repr_png_()))
    assert picture.size == frame.show("visibility").size
    assert frame._repr_html_().index("visibility") < frame._repr_html_().index("albedo")


def test_pixels_of_a_share_are_its_grey_and_the_background_is_blue():
    values = np.array([[0.0, 0.5, 1.0, np.nan]], np.float32)
    pixels = buffer_pixels("visibility", values, scale_of("visibility", values))
    assert pixels.tolist() == [[[0] * 3, [128] * 3, [255] * 3, BACKGROUND.tolist()]]


@pytest.mark.parametrize(
    ("values", "scale"),
    [
        (np.linspace(-5, -1, 101), Scale(-4.96, -1.04, "viridis")),
        (np.linspace(-1, 3, 101), Scale(-2.96, 2.96, "RdBu_r")),
        (np.full(4, 2.0), Scale(2.0, 3.0, "viridis")),
        (np.full(4, -np.inf), Scale(0.0, 1.0, "viridis")),
    ],
    ids=["percentiles", "both signs", "constant", "background"],
)
def test_the_scale_of_numbers(values, scale):
    found = scale_of("viewZ", values[None].astype(np.float32))
    assert found is not None
    assert found.colors == scale.colors
    assert (found.low, found.high) == pytest.approx((scale.low, scale.high), rel=1e-5)


def test_the_bar_has_the_colours_of_the_values():
    values = np.linspace(0, 1, 40 * 30, dtype=np.float32).reshape(40, 30)
    picture = np.asarray(buffer_picture("visibility", values))
    bar = picture[20:, 38 + 8]  # below the title, in the middle of the bar
    assert bar[0].tolist() == [255] * 3
    assert bar[-1].tolist() == [0] * 3


def test_frames_stand_side_by_side(frame, lab, boxes):
    small = lab.render(boxes, "ssao", size=(32, 24))
    sheet = np.asarray(aolab.show(frame, ssao=small))
    assert sheet.shape[1] == 2 * (64 + 8) + 8
    sheet = sheet[20 + 8 :]  # below the buffer's name
    assert (sheet[:48, 8 : 8 + 64] == frame.image).all()
    assert (sheet[:48:2, 80 : 80 + 64 : 2] == small.image).all()  # twice as large


def test_frames_side_by_side_show_a_buffer_that_all_have(frame):
    truth = made(ambient=frame["ambient"], viewZ=frame["viewZ"])
    sheet = np.asarray(aolab.show(frame, truth))[28 : 28 + 48]
    assert (sheet[:, 8 : 8 + 64] == sheet[:, 80 : 80 + 64]).all()


def test_frames_side_by_side_share_the_scale():
    dark, bright = (made(depth=np.full((8, 8), value, np.float32)) for value in (1.0, 3.0))
    sheet = np.asarray(aolab.show(dark, bright, buffer="depth"))
    assert (sheet[30, 10] != sheet[30, 26]).any()
    with pytest.raises(ParameterError, match="no buffer 'visibility'"):
        aolab.show(dark, buffer="visibility")


def test_a_sheet_refuses_what_is_no_picture():
    with pytest.raises(ParameterError, match=r"shape \(2, 2\), type float64; aolab.gray"):
        aolab.contact_sheet([("floats", np.zeros((2, 2)))])
    with pytest.raises(ParameterError, match="at least one picture"):
        aolab.contact_sheet([])


def test_a_module_is_a_table_with_its_own_parameters_first():
    text = aolab.SSDO(bounces=1)._repr_html_()
    for name in aolab.SSDO.model_fields:
        assert f">{name}<" in text
    assert set(own_first(aolab.SSDO)[:2]) == {"estimator", "bounces"}
    assert own_first(aolab.SSDO).index("directions") < own_first(aolab.SSDO).index("occluders")
    assert sorted(own_first(aolab.SSDO)) == sorted(aolab.SSDO.stated())


def test_pictures_and_the_table_of_buffers_agree():
    for name, about in known_buffers().items():
        assert (name in buffers.RADIANCE) == (about.kind == "radiance" or about.unit == "irradiance"), name
        assert (name in buffers.DIRECTIONS) == (about.kind == "direction"), name
        assert (name in (*buffers.SHARES, "albedo")) == (about.kind == "share"), name


def test_a_scene_is_a_picture_and_a_table_of_its_meshes(lab):
    text = aolab.load("boxes")._repr_html_()
    assert "<img" in text
    assert ">low box<" in text


def test_a_comparison_has_a_handle_between_truth_and_result(frame):
    other = made(visibility=np.ones((48, 64), np.float32), viewZ=frame["viewZ"])
    comparison = aolab.compare(frame, other, flip=False)
    text = comparison._repr_html_()
    assert "resize: horizontal" in text
    assert text.count("<img") == 3  # truth, result, the picture of the error
    assert "<script" not in text + frame._repr_html_()


def test_texts_are_escaped():
    assert "<b>" not in html.table(["<b>"], [["<b>"]], "<b>") + html.tabs([("<b>", "")], "<b>")
