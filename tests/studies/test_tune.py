"""Tuning: the parameters and ranges of the search, the cameras, and the preset."""

import json
import sys
import warnings

import numpy as np
import pytest
import small_scenes

import aolab
from aolab.errors import Notice, ParameterError
from aolab.modules.filters import FILTERS
from aolab.studies.nearby_cameras import cameras, turned
from aolab.studies.search_space import Axis, axis, tunable
from aolab.studies.tune import Tuning, tune
from aolab.truth import reference

pytest.importorskip("optuna", reason="the extra `tune` is not installed")

SIZE = (64, 36)
FEW = {"size": SIZE, "rays": 8, "views": 2, "progress": False}
POOR = aolab.SSAO(radius=1.0, thickness=0.03)  # blocks far too little


@pytest.fixture(scope="module")
def tuned(boxes: aolab.Scene, ball: aolab.Scene) -> Tuning:
    """A bad start, so that a few trials find better."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Notice)
        return tune(POOR, ["thickness"], scenes=[boxes], test_scenes=[ball], trials=8, **FEW)


def test_tuned_is_not_worse_where_it_was_fitted(tuned: Tuning):
    assert tuned.mean("tuned_rmse", held_out=False) < tuned.mean("rmse", held_out=False)
    assert tuned.tuned.thickness > POOR.thickness  # pyright: ignore[reportAttributeAccessIssue]
    assert tuned.tuned.replace(thickness=POOR.thickness) == POOR


@pytest.mark.parametrize("seed", range(4))
def test_first_trial_is_the_module_as_given(boxes: aolab.Scene, ball: aolab.Scene, seed: int):
    """From such a start any other trial would be better; and it keeps its digits, more than a tuned number has."""
    poor = POOR.replace(thickness=0.1 / 3)
    few = {**FEW, "views": 1}
    one = tune(poor, ["thickness"], scenes=[boxes], test_scenes=[ball], trials=1, seed=seed, **few)  # pyright: ignore[reportArgumentType]
    assert one.tuned == poor
    assert one.rows[0].rmse == one.rows[0].tuned_rmse


def test_parameter_without_effect_is_not_searched(boxes: aolab.Scene, ball: aolab.Scene):
    class Idle(aolab.SSAO):
        idle: float = aolab.parameter(0.5, "Has no effect.", ge=0, le=1)

    start = Idle(radius=1.0, thickness=0.03)
    few = {"scenes": [boxes], "test_scenes": [ball], "trials": 8, **FEW, "views": 1}
    one = tune(start, **few)  # pyright: ignore[reportArgumentType]
    assert one.parameters == ("bias", "thickness", "power")
    with pytest.raises(ParameterError, match="visibility does not depend on idle in these scenes"):
        tune(start, ["idle", "thickness"], **few)  # pyright: ignore[reportArgumentType]


def test_parameters_of_light_are_not_searched(boxes: aolab.Scene, ball: aolab.Scene):
    """Bounces, senders and lights change the picture, but not visibility."""
    few = {"scenes": [boxes], "test_scenes": [ball], "trials": 1, **FEW, "views": 1}
    assert tune("ssdo", **few).parameters == ("bias", "thickness")  # pyright: ignore[reportArgumentType]
    with pytest.raises(ParameterError, match="visibility does not depend on bounces"):
        tune("ssdo", ["bounces"], **few)  # pyright: ignore[reportArgumentType]


def test_same_seed_same_preset(tuned: Tuning, boxes: aolab.Scene, ball: aolab.Scene):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Notice)
        again = tune(POOR, ["thickness"], scenes=[boxes], test_scenes=[ball], trials=8, **FEW)
    assert again.preset == tuned.preset


def test_preset_makes_the_module_that_was_measured(tuned: Tuning, boxes: aolab.Scene):
    assert set(tuned.preset) == {"radius", "thickness"}
    module = aolab.SSAO(**json.loads(json.dumps(tuned.preset)))
    assert module == tuned.tuned
    truth = reference(boxes, size=SIZE, rays=8, like=POOR, buffers=("visibility",))
    frame = aolab.render(boxes, module, size=SIZE)
    error = np.sqrt(np.nanmean((frame["visibility"] - truth["visibility"]) ** 2))
    own_view = next(row for row in tuned.rows if not row.held_out and row.turn == 0)
    assert own_view.tuned_rmse == pytest.approx(error, rel=1e-4)


def test_report_warns_if_held_out_scenes_get_worse(tuned: Tuning):
    warning = "On the held-out scenes this preset is worse"
    for factor in (0.5, 2.0):
        rows = [row for row in tuned.rows if not row.held_out]
        judged = [type(row)(**{**vars(row), "held_out": True, "tuned_rmse": factor * row.rmse}) for row in rows]
        report = Tuning(tuned.module, tuned.tuned, tuned.parameters, (*rows, *judged), tuned.info)
        assert (warning in report.table()) == (factor > 1)
        assert f"{100 * (factor - 1):+.1f}%" in report.table()
        assert report.to_dict()["held_out"]["tuned_rmse"] == pytest.approx(factor * report.mean("rmse", held_out=True))


def test_ranges_come_from_the_parameters_statements():
    assert tunable(aolab.SSAO()) == ["bias", "thickness", "power"]
    assert tunable(aolab.Unoccluded()) == []
    assert not {"bounces", "senders", "directions"} & set(tunable(aolab.SSDO()))
    assert axis(aolab.SSAO(), "thickness") == Axis("thickness", 0.9, 0.9 / 30, 10, log=True)
    assert axis(aolab.SSAO(bias=0.0), "bias") == Axis("bias", 0.0, 0, 1)
    assert axis(aolab.SSAO(), "filter").choices == tuple(FILTERS)

    class Own(aolab.Module):
        lobes: int = aolab.parameter(4, "A whole number.", ge=1, le=8)
        wide: int = aolab.parameter(4, "A whole number with a wide range.", ge=1, le=400)
        soft: bool = aolab.parameter(False, "A choice.")
        endless: float = aolab.parameter(0.0, "No range.")
        word: str = aolab.parameter("a", "Any text.")

    assert axis(Own(), "lobes") == Axis("lobes", 4, 1, 8, whole=True)
    assert axis(Own(), "wide") == Axis("wide", 4, 1, 120, log=True, whole=True)
    assert axis(Own(), "soft").choices == (False, True)
    with pytest.raises(ParameterError, match=r"endless = 0\.0 has no range to search; declare its ge and le"):
        axis(Own(), "endless")
    with pytest.raises(ParameterError, match="word = 'a' cannot be tuned: it is neither a number nor a choice"):
        axis(Own(), "word")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"parameters": ["radius"]}, "radius cannot be tuned: the truth has the same radius"),
        ({"parameters": ["steps"]}, "steps cannot be tuned: it trades time for error"),
        ({"parameters": ["thicknes"]}, "no parameter 'thicknes'; did you mean 'thickness'"),
        ({"module": "none"}, "none has no number of its own to tune"),
        ({"trials": 0}, "trials = 0 is not a whole number from 1 on"),
        ({"scenes": []}, "scenes is empty"),
        ({"test_scenes": []}, "test_scenes is empty"),
        ({"test_scenes": ["boxes"]}, "boxes: a scene is either for the fit or for the test"),
        ({"views": 0}, "views = 0 is not a whole number"),
    ],
)
def test_an_impossible_search_is_refused(arguments: dict, message: str):
    usual = {"module": "ssao", "scenes": ["boxes"], "test_scenes": ["cornell"], "size": SIZE, "rays": 8}
    with pytest.raises(ParameterError, match=message):
        tune(**{**usual, **arguments})


def test_without_optuna_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "optuna", None)
    with pytest.raises(ParameterError, match=r"fitting parameters needs optuna: .*pip install optuna"):
        tune("ssao")


def test_turned_camera_looks_at_the_same_point_from_the_side():
    camera = aolab.Camera(eye=(0, 2, 5), target=(1, 1, 0), fov=30)
    side = turned(turned(camera, 40), 50)
    assert side.eye == pytest.approx((1 + 5, 2, 0 + 1))  # (-1, 1, 5), a quarter turn counterclockwise from above
    assert (side.target, side.up, side.fov) == (camera.target, camera.up, camera.fov)


def test_cameras_step_aside_in_turn(lab: aolab.Lab):
    found = cameras(small_scenes.ball(), 4, lab, SIZE)
    assert list(found) == [0, 15, -15, 30]
    assert found[0] == small_scenes.ball().camera


def test_camera_does_not_go_behind_a_pillar(lab: aolab.Lab):
    """The pillar stands where the camera would be after 15 degrees to the right, and blocks it as far as 7.5."""
    camera = aolab.Camera(eye=(0, 1, 8), target=(0, 1, 0))
    pillar = small_scenes.box((1.6, 0, 6.6), (2.4, 3, 7.4))
    scene = small_scenes.of(small_scenes.floor(), small_scenes.sphere(1.0, (0, 1, 0)), pillar, camera=camera)
    assert set(cameras(scene, 3, lab, SIZE)) == {0, -15, 3.75}


def test_camera_that_finds_no_free_place_is_left_out_and_said(lab: aolab.Lab):
    """The pillar stands before the camera at 30 degrees; half of that is taken already."""
    camera = aolab.Camera(eye=(0, 1, 8), target=(0, 1, 0))
    pillar = small_scenes.box((3.2, 0, 5.84), (4, 3, 6.64))
    scene = small_scenes.of(small_scenes.floor(), small_scenes.sphere(1.0, (0, 1, 0)), pillar, camera=camera)
    with pytest.warns(Notice, match="no free view near 30 degrees"):
        assert list(cameras(scene, 4, lab, SIZE)) == [0, 15, -15]
