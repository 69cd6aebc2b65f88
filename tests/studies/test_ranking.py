"""Modules against the truth: the order, the meaning of the truth, the sheet, the command."""

import json

import numpy as np
import pytest

import aolab
from aolab.shell.compare import compare_command, parse_module
from aolab.studies import compare_modules, ranking, sheet

SMALL = {"size": (64, 48), "rays": 16, "flip": False}
# the truth of so few rays is noisy, and `compare` says so
pytestmark = pytest.mark.filterwarnings("ignore:buffer .* the reference's own standard error:aolab.errors.Notice")


@pytest.fixture
def entries(boxes):
    return compare_modules(boxes, ["none", "ssao", aolab.SSAO(directions=64, steps=16)], radius=0.4, **SMALL)


def test_the_best_comes_first(entries):
    errors = [entry.comparison["visibility"].rmse for entry in entries]
    assert errors == sorted(errors)
    assert len(errors) == 3
    assert entries[-1].label == "none"
    assert entries[-1].comparison["visibility"].bias > 0  # without occlusion everything is too open
    assert all(entry.milliseconds > 0 for entry in entries)


def test_labels_name_what_was_changed(entries):
    labels = {entry.label for entry in entries}
    assert labels == {"none", "ssao radius=0.4", "ssao radius=0.4 directions=64 steps=16"}


def test_the_truth_means_what_the_module_means(boxes):
    near, far = (
        compare_modules(boxes, [aolab.SSAO(radius=radius), "none"], **SMALL) for radius in (0.05, 1.0)
    )  # fmt: skip
    for entries, other in ((near, far), (far, near)):
        truths = [entry.comparison["visibility"].reference for entry in entries]
        assert np.array_equal(*truths, equal_nan=True)  # `none` has no radius of its own
        assert not np.array_equal(truths[0], other[0].comparison["visibility"].reference, equal_nan=True)


def test_modules_without_radius_alone_take_the_given_one(boxes):
    short, unlimited = (compare_modules(boxes, ["none"], radius=radius, **SMALL)[0] for radius in (0.05, None))
    assert short.comparison["visibility"].rmse < unlimited.comparison["visibility"].rmse


def test_a_sheet_has_a_line_a_module(entries):
    one, three = sheet(entries[:1]), sheet(entries)
    assert one.width == three.width
    assert three.height > 2 * one.height
    with pytest.raises(aolab.ParameterError, match="no modules"):
        sheet([])


def test_text_beside_the_pictures(entries):
    text = ranking._text(entries[0])
    for word in ("rmse", "bias", "ssim", "silhouettes", "radius            0.4", "ms"):
        assert word in text
    assert "flip" not in text  # was not asked for


def test_a_buffer_that_a_module_lacks_is_an_error(boxes):
    with pytest.raises(aolab.ParameterError, match="module none gives no 'bent_normal'; it has albedo"):
        compare_modules(boxes, ["none"], buffer="bent_normal", **SMALL)


def test_command_writes_the_sheet_and_prints(tmp_path):
    path = tmp_path / "sheet.png"
    options = {"scene": "boxes", "modules": "none,ssao?steps=3", "size": "48x32", "rays": 4, "radius": None}
    text = compare_command(**options, buffer="visibility", output=path, as_json=False)
    assert path.read_bytes().startswith(b"\x89PNG")
    assert [line.split()[0] for line in text.splitlines()[1:]] == ["ssao", "none"]
    read = json.loads(compare_command(**options, buffer="ambient", output=None, as_json=True))
    assert {entry["label"] for entry in read} == {"ssao steps=3", "none"}
    assert all(entry["buffers"]["ambient"]["all"]["rmse"] > 0 for entry in read)
    assert all(entry["rays"] == 4 and entry["renderer"] for entry in read)


def test_command_refuses_before_the_work(tmp_path):
    options = {"scene": "boxes", "modules": None, "size": "48x32", "rays": 4, "radius": None, "buffer": "visibility"}
    with pytest.raises(aolab.FileError, match=r"sheet.jpg: the sheet is written as .png"):
        compare_command(**options, output=tmp_path / "sheet.jpg", as_json=False)
    with pytest.raises(aolab.FileError, match="does not exist"):
        compare_command(**options, output=tmp_path / "nowhere" / "sheet.png", as_json=False)


def test_modules_are_written_as_scenes_are():
    assert parse_module(" ssao?directions=32&radius=0.5") == aolab.SSAO(directions=32, radius=0.5)
    with pytest.raises(aolab.ParameterError, match="write NAME"):
        parse_module("ssao?directions")
    with pytest.raises(aolab.ParameterError, match="did you mean 'ssao'"):
        parse_module("sao")
