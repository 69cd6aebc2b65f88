"""`compare`: the compared buffers, their regions, and the messages."""

import json
import math
from dataclasses import asdict

import numpy as np
import pytest

import aolab
from aolab.measures import compare


def scene_depth(shape=(40, 56)):
    """A wall at 10, a box at 5 in its middle, sky above."""
    view_z = np.full(shape, -10, np.float32)
    view_z[12:30, 16:40] = -5
    view_z[:4] = -np.inf
    return view_z


def strict(text: str):
    """JSON without the NaN and Infinity that its standard does not know."""

    def refuse(constant):
        raise AssertionError(constant)

    return json.loads(text, parse_constant=refuse)


def test_equal_results(noise):
    one = compare({"visibility": noise}, {"visibility": noise})["visibility"]
    assert (one.rmse, one.bias, one.mae, one.p99, one.maximum, one.flip) == (0, 0, 0, 0, 0, 0)
    assert one.psnr == math.inf
    assert one.ssim == pytest.approx(1)


def test_a_known_shift_is_the_bias(noise):
    one = compare({"visibility": noise + np.float32(0.1)}, {"visibility": noise})["visibility"]
    assert (one.bias, one.rmse, one.mae, one.maximum) == pytest.approx((0.1, 0.1, 0.1, 0.1), abs=1e-6)
    assert one.psnr == pytest.approx(20, abs=1e-4)
    lower = compare({"visibility": noise - np.float32(0.1)}, {"visibility": noise})["visibility"]
    assert (lower.bias, lower.rmse) == pytest.approx((-0.1, 0.1), abs=1e-6)


def test_radiance_is_compared_linearly_and_seen_tone_mapped():
    dim, bright = np.full((32, 32, 3), 8, np.float32), np.full((32, 32, 3), 16, np.float32)
    one = compare({"ambient": bright}, {"ambient": dim})["ambient"]
    assert one.bias == pytest.approx(8)
    assert one.psnr > 30  # both are nearly white on a screen
    assert one.flip > 0.05  # but HDR-FLIP looks at lower exposures too


def test_the_background_is_left_out(noise):
    view_z = scene_depth()
    wrong = noise.copy()
    wrong[~np.isfinite(view_z)] = 1e6
    a, b = ({"visibility": values, "viewZ": view_z} for values in (wrong, noise))
    one = compare(a, b)["visibility"]
    assert (one.pixels, one.rmse, one.flip) == (36 * 56, 0, 0)
    assert one.ssim == pytest.approx(1)


def test_without_depth_nan_in_both_is_background(noise):
    holed = noise.copy()
    holed[:10] = np.nan
    assert compare({"visibility": holed}, {"visibility": holed})["visibility"].pixels == 30 * 56


def test_broken_pixels_are_left_out_and_told(noise):
    broken = noise.copy()
    broken[7, 3], broken[8, 5] = np.nan, np.inf
    with pytest.warns(aolab.Notice, match=r"'visibility': 2 pixels .* x=3, y=7"):
        one = compare({"visibility": broken}, {"visibility": noise})["visibility"]
    assert (one.pixels, one.rmse) == (40 * 56 - 2, 0)
    assert np.isnan(one.error[7, 3])


def test_regions_tell_where_the_error_is(noise):
    view_z = scene_depth()
    wrong = noise.copy()
    wrong[12:30, 15:17] += 0.5  # along the left side of the box: the pixels on both sides of the gap
    a, b = ({"visibility": values, "viewZ": view_z} for values in (wrong, noise))
    one = compare(a, b, border=3, flip=False)["visibility"]
    assert one.measures["silhouettes"].bias == pytest.approx(0.5 * 18 * 2 / one.measures["silhouettes"].pixels)
    assert one.measures["border"].rmse == one.measures["interior"].rmse == 0
    assert one.measures["thin"].pixels == 0
    assert math.isnan(one.measures["thin"].rmse)
    regions = compare(a, b, border=3).regions
    assert regions["border"].sum() == regions["all"].sum() - (40 - 4 - 3) * (56 - 6)
    assert not (regions["interior"] & (regions["border"] | regions["silhouettes"] | regions["thin"])).any()


def test_the_border_reaches_as_far_as_the_frames_radius(lab, boxes):
    """And without a radius, in frames of `none`, a set share of the shorter side."""
    frames = [*(lab.render(boxes, "ssao", radius=radius) for radius in (0.2, 1.0)), lab.render(boxes, "none")]
    found = [compare(frame, frame, "visibility", flip=False).regions for frame in frames]
    small, large, fixed = (regions["border"] for regions in found)
    assert 0 < small.sum() < large.sum()
    assert (large | ~small).all()
    y, x = np.nonzero(found[2]["all"])
    expected = np.minimum(np.minimum(x, 63 - x), np.minimum(y, 47 - y)) + 0.5 < 48 / 20
    assert fixed[y, x].tolist() == expected.tolist()


def test_directions_have_angles(noise):
    up = np.zeros((8, 8, 3), np.float32)
    up[..., 1] = 1
    tilted = up.copy()
    tilted[..., 0] = 1  # 45°, and longer: the length does not count
    one = compare({"bent_normal": tilted}, {"bent_normal": up})["bent_normal"]
    assert one.angle == one.angle_p90 == pytest.approx(45)
    assert one.error == pytest.approx(45)
    assert math.isnan(one.psnr)
    assert math.isnan(one.flip)


def test_harmonics_are_compared_by_band():
    a = {f"sh{i}": np.zeros((6, 6, 4), np.float32) for i in range(4)}
    b = {name: values.copy() for name, values in a.items()}
    a["sh0"][..., 0] = 0.5  # band 0
    a["sh2"][..., 0] = 0.3  # coefficient 8: the last of band 2
    a["sh2"][..., 1] = 0.4  # coefficient 9: the first of band 3
    found = compare(a, b)
    assert list(found.buffers) == ["sh", "sh_band0", "sh_band1", "sh_band2", "sh_band3"]
    expected = {"sh_band0": 0.5, "sh_band1": 0, "sh_band2": 0.3 / math.sqrt(5), "sh_band3": 0.4 / math.sqrt(7)}
    assert {name: found[name].rmse for name in expected} == pytest.approx(expected)
    assert found["sh"].rmse == pytest.approx(math.sqrt(0.5 / 16))
    assert found["sh"].error == pytest.approx(math.sqrt(0.5))
    assert list(compare(a, b, "sh2").buffers) == ["sh2"]
    assert list(compare(a, b, "sh").buffers) == list(found.buffers)


def test_eight_bit_images_are_shares_and_padding_is_dropped(noise):
    image = np.full((16, 16, 3), 255, np.uint8)
    assert compare({"image": image}, {"image": image // 5})["image"].bias == pytest.approx(0.8)
    padded = np.concatenate([image[..., :1] * [1.0, 1, 1], np.full((16, 16, 1), 7.0)], axis=2)
    assert compare({"ambient_raw": padded}, {"ambient_raw": padded / 2})["ambient_raw"].bias == pytest.approx(127.5)


def test_an_unknown_buffer_has_numbers_only(noise):
    one = compare({"mine": noise * 2}, {"mine": noise})["mine"]
    assert one.mae == pytest.approx(float(noise.mean()), rel=1e-5)
    assert math.isnan(one.ssim)


def test_default_buffers_are_results(lab, boxes):
    frame = lab.render(boxes, "ssao")
    found = compare(frame, frame, flip=False).buffers
    assert next(iter(found)) == "visibility"
    assert {"ambient", "radiance", "image"} <= set(found)
    assert not {"viewZ", "viewNormal", "facetNormal", "albedo"} & set(found)
    assert compare(frame, frame, "viewNormal")["viewNormal"].angle == pytest.approx(0, abs=1e-3)


def test_json_holds_every_number(noise, tmp_path):
    a = {"visibility": noise, "bent_normal": np.ones((40, 56, 3), np.float32)}
    found = compare(a, a)
    found.save(tmp_path / "found.json")
    read = strict((tmp_path / "found.json").read_text())
    assert (read["size"], list(read["buffers"])) == ([56, 40], ["visibility", "bent_normal"])
    for name, one in found.buffers.items():
        for region, measures in one.measures.items():
            numbers = read["buffers"][name][region]
            again = {key: math.nan if value is None else float(value) for key, value in numbers.items()}
            assert again == pytest.approx(asdict(measures), nan_ok=True)
    assert read["buffers"]["visibility"]["all"]["psnr"] == "Infinity"


def test_the_table_names_buffers_units_and_regions(noise):
    view_z = scene_depth()
    text = str(compare({"visibility": noise, "viewZ": view_z}, {"visibility": noise + 0.25, "viewZ": view_z}))
    assert "a against b, 56×40" in text
    assert "-0.25" in text
    assert "silhouettes" in text
    assert "angle" not in text  # a column that no region has is left out


def test_a_frame_shows_itself_in_notebooks(noise):
    found = compare({"visibility": noise}, {"visibility": noise * 0.9})
    assert found._repr_png_().startswith(b"\x89PNG")
    assert "rmse" in found._repr_html_()
    assert "visibility rmse 0.05" in repr(found)


@pytest.mark.parametrize(
    ("a", "b", "buffers", "match"),
    [
        ({"visibility": np.ones((4, 5))}, {"visibility": np.ones((4, 6))}, None, r"a is 5×4 .* b is 6×4"),
        ({"mine": np.ones((4, 5, 2))}, {"mine": np.ones((4, 5))}, None, r"2 channels, b is 5×4 with 1 channel"),
        ({"visibility": np.ones((4, 5))}, {"ambient": np.ones((4, 5))}, None, "a has visibility; b has ambient"),
        ({"viewZ": np.ones((4, 5))}, {"viewZ": np.ones((4, 5))}, None, "only viewZ: name them"),
        ({"visibility": np.ones((4, 5))}, {"visibility": np.ones((4, 5))}, "visibilty", "did you mean 'visibility'"),
        ({"visibility": np.ones((4, 5))}, {"visibility": np.ones((4, 5))}, [], "is empty; both have visib"),
        ({"visibility": np.full((4, 5), np.nan)},) * 2 + (None, "all 20 pixels are background"),
        ({"visibility": np.ones((4, 5)), "viewZ": np.full((4, 5), -np.inf)},) * 2 + (None, "all 5×4 pixels are back"),
        ({"visibility": np.ones(4)}, {"visibility": np.ones(4)}, None, r"of a has shape \(4,\)"),
        ({"bent_normal": np.ones((4, 5, 2))},) * 2 + (None, r"\(4, 5, 2\), not 3 channels"),
        ([1], {"visibility": np.ones((4, 5))}, None, "cannot compare a list"),
    ],
)
def test_results_that_cannot_be_compared(a, b, buffers, match):
    with pytest.raises(aolab.ParameterError, match=match):
        compare(a, b, buffers)


def test_a_negative_border_and_a_missing_buffer_are_refused(noise):
    with pytest.raises(aolab.ParameterError, match="border = -1"):
        compare({"visibility": noise}, {"visibility": noise}, border=-1)
    with pytest.raises(aolab.ParameterError, match="'ambient' was not compared; known: visibility"):
        compare({"visibility": noise}, {"visibility": noise})["ambient"]


def test_other_surfaces_are_told(noise):
    view_z = scene_depth()
    moved = np.roll(view_z, 1, axis=0)
    with pytest.warns(aolab.Notice, match="112 pixels, background in one of them"):
        compare({"visibility": noise, "viewZ": view_z}, {"visibility": noise, "viewZ": moved}, flip=False)
