"""Error against milliseconds: which settings are measured, what counts as time and as error, what is written."""

from itertools import pairwise

import numpy as np
import pytest

import aolab
from aolab.errors import Notice, ParameterError
from aolab.modules.filters import FILTERS
from aolab.studies.curve import Curve
from aolab.studies.quality import curve, pareto_front, settings, visibility_error
from aolab.truth import reference

SIZE = (64, 36)
FEW = {"size": SIZE, "rays": 8, "frames": 2}


@pytest.fixture(scope="module")
def measured(boxes: aolab.Scene) -> Curve:
    """Three modules on a floor with boxes."""
    return curve(boxes, ["none", "ssao", "ssdo"], radius=1.0, **FEW)


def test_pareto_front_of_a_case_by_hand():
    #         fast, bad; both worse; slow, good; a tie in time; equal to the third; slower, no better
    costs = [(1.0, 0.5), (1.5, 0.6), (2.0, 0.1), (2.0, 0.2), (2.0, 0.1), (3.0, 0.1)]
    assert pareto_front(costs) == {0, 2}


def test_pareto_front_is_what_no_other_point_dominates():
    costs = [tuple(pair) for pair in np.random.default_rng(5).random((200, 2))]
    undominated = {i for i, (x, y) in enumerate(costs) if not any(a < x and b < y for a, b in costs)}
    assert pareto_front(costs) == undominated


@pytest.mark.slow
def test_front_of_the_curve_falls(measured: Curve):
    front = measured.front
    assert front
    times, errors = [point.milliseconds for point in front], [point.rmse for point in front]
    assert times == sorted(times)
    assert all(later < earlier for earlier, later in pairwise(errors))
    assert errors[-1] == min(point.rmse for point in measured.points)


def test_settings_are_a_grid_around_the_module_as_it_is():
    module = aolab.SSAO(directions=8, steps=4, thickness=0.5)
    grid = settings(module)
    assert {one.directions for one, _ in grid} == {2, 4, 8, 16}  # pyright: ignore[reportAttributeAccessIssue]
    assert {one.steps for one, _ in grid} == {2, 4, 8}  # pyright: ignore[reportAttributeAccessIssue]
    assert {one.filter for one, _ in grid} == set(FILTERS)
    assert {one.scale for one, _ in grid} == {0.5, 1.0}
    assert len(grid) == 4 * 3 * len(FILTERS) * 2
    assert all(one.thickness == 0.5 for one, _ in grid)  # pyright: ignore[reportAttributeAccessIssue]
    assert [varied for one, varied in grid if one == module] == [
        {"directions": 8, "steps": 4, "scale": 1.0, "filter": "box4"}
    ]


def test_settings_keep_to_the_parameters_ranges_and_repeat_none():
    grid = [one for one, _ in settings(aolab.SSAO(directions=1, steps=64, scale=0.125))]
    assert {one.directions for one in grid} == {1, 2}  # pyright: ignore[reportAttributeAccessIssue]
    assert {one.steps for one in grid} == {32, 64}  # pyright: ignore[reportAttributeAccessIssue]
    assert {one.scale for one in grid} == {0.125}
    assert len(grid) == len(set(map(str, grid))) == 2 * 2 * len(FILTERS)


@pytest.mark.slow
def test_module_without_parameters_of_its_own_is_one_point(measured: Curve):
    assert settings(aolab.Unoccluded()) == [(aolab.Unoccluded(), {})]
    assert [point.label for point in measured.points if point.module == "none"] == ["none"]


def test_own_module_is_measured_over_what_it_has(boxes: aolab.Scene):
    class Few(aolab.Module):
        shader = "none.frag"
        samples_per_pixel: int = aolab.parameter(1, "Not one of the axes.", ge=1, le=4)

    points = curve(boxes, [Few], radius=1.0, **FEW).points
    assert {tuple(point.settings) for point in points} == {("scale", "filter")}
    assert len(points) == 2 * len(FILTERS)
    assert {point.module for point in points} == {"Few"}


@pytest.mark.slow
def test_time_is_that_of_the_passes_that_the_module_adds(measured: Curve):
    by_label = {point.label: point for point in measured.points}
    assert set(by_label["ssao 8×4 none"].passes) == {"ssao"}
    assert set(by_label["ssao 8×4 box4"].passes) == {"ssao", "filter visibility"}
    assert set(by_label["ssao 4×2 box4 at 0.5"].passes) == {
        "shrink", "ssao", "filter visibility", "upsample visibility"
    }  # fmt: skip
    assert set(by_label["none"].passes) == {"none", "filter visibility"}
    # one pass: the median of the sum is the median of the pass
    alone = by_label["ssao 8×4 none"]
    assert alone.milliseconds == pytest.approx(alone.passes["ssao"])


@pytest.mark.slow
def test_error_is_that_against_the_truth_of_the_same_radius_and_falloff(measured: Curve, boxes: aolab.Scene):
    module = aolab.SSAO(radius=1.0)
    truth = reference(boxes, size=SIZE, rays=8, like=module, buffers=("visibility",))
    frame = aolab.render(boxes, module, size=SIZE)
    difference = (frame["visibility"] - truth["visibility"])[np.isfinite(frame["viewZ"])].astype(np.float64)
    default = next(point for point in measured.points if point.module == "ssao" and point.default)
    assert default.label == "ssao 8×4 box4"
    assert default.rmse == pytest.approx(np.sqrt(np.mean(difference**2)))
    assert default.bias == pytest.approx(difference.mean())
    # without a radius of its own, `none` is judged by the same truth: all its error is occlusion that it lacks
    none = next(point for point in measured.points if point.module == "none")
    assert none.bias == pytest.approx(np.nanmean(1 - truth["visibility"]), abs=1e-6)


@pytest.fixture
def short_grid(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each point compiles its own shader: two numbers of directions, and the filters."""
    monkeypatch.setattr("aolab.studies.quality.FACTORS", {"directions": (0.5, 1)})


@pytest.mark.slow
@pytest.mark.usefixtures("short_grid")
def test_all_modules_have_the_radius_of_the_curve(boxes: aolab.Scene):
    reach = [curve(boxes, [aolab.SSAO(radius=9.0)], radius=radius, **FEW).points for radius in (0.1, 1.0)]
    same = curve(boxes, [aolab.SSAO(radius=0.5)], radius=0.1, **FEW).points
    assert [point.rmse for point in same] == [point.rmse for point in reach[0]]
    assert reach[0][0].rmse != reach[1][0].rmse


def test_module_without_visibility_is_left_out_and_said(boxes: aolab.Scene):
    class Colour(aolab.Module):
        name = "colour"
        shader = "none.frag"
        outputs = {"colour": "R16F"}  # noqa: RUF012

        def passes(self) -> list[aolab.Pass]:
            return [aolab.Pass("colour", self.shader, self.outputs, writes={"visibility": "colour"})]

    with pytest.warns(Notice, match="colour is left out: it has colour, no visibility"):
        measured = curve(boxes, [Colour, "none"], **FEW)
    assert [point.module for point in measured.points] == ["none"]


@pytest.mark.filterwarnings("ignore:nothing is drawn:aolab.Notice")
def test_curve_of_few_frames_or_of_nothing_is_refused(boxes: aolab.Scene):
    with pytest.raises(ParameterError, match=r"frames = 1: .* 2 or more"):
        curve(boxes, size=SIZE, frames=1)
    away = boxes.replace(camera=aolab.Camera(eye=(0, 50, 0), target=(0, 99, 1)))
    with pytest.raises(ParameterError, match="no pixel of this view shows a surface"):
        curve(away, **FEW)


def test_visibility_error_of_equal_frames_is_zero(boxes: aolab.Scene):
    truth = reference(boxes, size=SIZE, rays=8, like="ssao", buffers=("visibility",))
    assert visibility_error(truth, truth)["maximum"] == 0
