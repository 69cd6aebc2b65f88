"""Modules compared with the truth: the order, the radius of the truth, the sheet."""

import sys

import numpy as np
import pytest

import aolab
from aolab.errors import Notice
from aolab.studies import compare_modules, ranking, sheet

SMALL = {"size": (64, 48), "rays": 16, "flip": False}
# the truth of so few rays is noisy, and `compare` warns of it
pytestmark = pytest.mark.filterwarnings("ignore:buffer .* the truth's own standard error:aolab.errors.Notice")


@pytest.fixture
def entries(boxes):
    return compare_modules(boxes, ["none", "ssao", aolab.SSAO(directions=64, steps=16)], radius=0.4, **SMALL)


def test_one_notice_counts_the_results_whose_truth_is_noisy(boxes):
    with pytest.warns(Notice) as seen:
        found = compare_modules(boxes, ["ssao", "hao", "none"], radius=0.4, **{**SMALL, "rays": 4})
    noisy = [one for one in found if one.comparison["visibility"].is_noisy]
    assert len(noisy) >= 2
    (notice,) = (str(one.message) for one in seen)
    assert f"{len(noisy)} of {len(found)} results" in notice
    assert seen[0].filename == __file__


def test_the_best_comes_first(entries):
    errors = [entry.comparison["visibility"].rmse for entry in entries]
    assert errors == sorted(errors)
    assert len(errors) == 3
    assert entries[-1].label == "none"
    assert entries[-1].comparison["visibility"].bias > 0  # without occlusion everything is too open
    assert all(entry.milliseconds > 0 for entry in entries)


def test_the_ranking_shows_itself(entries):
    lines = repr(entries).splitlines()
    assert lines[0].split() == ["visibility", "rmse", "bias", "p99", "ssim", "flip", "frame", "ms"]
    assert [line.split("  ")[0] for line in lines[1:]] == [entry.label for entry in entries]
    assert f"{entries[0].comparison['visibility'].rmse:.4f}" in lines[1]
    html = entries._repr_html_()
    assert all("<td" in html and entry.label in html for entry in entries)
    assert html.count("<img") == 1
    assert repr(entries[-1]).startswith("<Entry none: visibility rmse 0.")
    assert "truth | result" in entries[0]._repr_html_()


def test_methods_for_coloured_light_are_compared_by_ambient_light(boxes):
    """And modules with the same result are named in a line of their own."""
    sky = boxes.replace(environment=aolab.Environment.sky(sun_direction=(1.0, 0.6, 0.2)))
    found = compare_modules(sky, ["ssao", "ssdo", "rsm"], radius=0.4, **SMALL)
    assert [next(iter(one.comparison.buffers)) for one in found] == ["ambient"] * 3
    assert repr(found).splitlines()[0].split()[0] == "ambient"
    same = [line for line in repr(found).splitlines() if line.startswith("the same")]
    assert same == []  # rsm has no occlusion
    twice = compare_modules(sky, ["none", "rsm"], **SMALL)
    assert repr(twice).splitlines()[-1] == "the same ambient, pixel by pixel: none, rsm"
    assert "the same ambient" in twice._repr_html_()
    only = compare_modules(sky, ["ssao", "none"], radius=0.4, **SMALL)
    assert next(iter(only[0].comparison.buffers)) == "visibility"


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
    lines = [line.split() for line in text.splitlines()]
    assert ["radius", "0.4"] in lines
    assert [line[0] for line in lines if line][:6] == ["rmse", "bias", "p99", "psnr", "ssim", "rmse"]
    assert lines[-1][:2] == ["frame,", "ms"]
    assert "flip" not in text  # was not asked for


def test_a_buffer_that_a_module_lacks_is_an_error(boxes):
    with pytest.raises(aolab.ParameterError, match="module none has no 'bent_normal'; it has albedo"):
        compare_modules(boxes, ["none"], buffer="bent_normal", **SMALL)


def test_one_module_may_stand_alone(boxes):
    (entry,) = compare_modules(boxes, "ssao", **SMALL)
    assert entry.label == "ssao"


def test_the_noise_of_the_truth_is_noted_once(boxes):
    with pytest.warns(
        aolab.Notice, match="'visibility': the truth's own standard error is .* 3 of 3 results"
    ) as notices:
        found = compare_modules(boxes, ["ssao", "hao", "rotated_ssao"], buffer="visibility", **SMALL)
    assert len(notices) == 1
    shares = [one.noise / one.rmse for one in (entry.comparison["visibility"] for entry in found)]
    assert f"{min(shares):.0%} to {max(shares):.0%}" in str(notices[0].message)


def test_a_comparison_without_its_buffer_or_library_is_refused_before_rays_are_traced(boxes, monkeypatch):
    monkeypatch.setattr(ranking, "reference", lambda *_, **__: pytest.fail("traced before it was refused"))
    with pytest.raises(aolab.ParameterError, match="module ssao has no 'bent_normal'"):
        compare_modules(boxes, ["ssbn", "ssao"], buffer="bent_normal", **SMALL)
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    with pytest.raises(aolab.ParameterError, match=r"pip install flip-evaluator, or flip=False \(--no-flip"):
        compare_modules(boxes, ["ssao"], **{**SMALL, "flip": True})


def test_shadow_maps_of_an_environment_are_judged_by_unlimited_rays(boxes):
    """Also beside modules with a radius."""
    together = {
        one.module.name: one for one in compare_modules(boxes, ["ssao", "environment_vpl"], radius=0.05, **SMALL)
    }
    alone = compare_modules(boxes, ["environment_vpl"], **SMALL)[0].comparison["ambient"]
    assert together["environment_vpl"].comparison["ambient"].rmse == pytest.approx(alone.rmse)
    assert together["ssao"].comparison["ambient"].rmse < 0.05
