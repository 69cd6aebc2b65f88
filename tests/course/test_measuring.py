"""The measuring exercises: the right answers have all points, others none, and each verdict has its number."""

import pytest

from aolab import course

SWEEP = """
scene = "boxes"
module = "ssao"
size = "96x54"
measures = "visibility.rmse"
seed = [0, 1]
[fixed]
radius = 1.0
[zip]
directions = [4, 8, 16, 32, 64]
steps = [16, 8, 4, 2, 1]
"""


@pytest.mark.parametrize("name", ["causes", "sweep"])
def test_a_folder_without_answers_has_no_points(tmp_path, name):
    result = course.check(course.start(name, tmp_path / "mine"))
    assert result.score == 0
    assert "no answer" in str(result)


@pytest.mark.slow
def test_the_cause_of_an_error(gl, tmp_path):
    folder = course.start("causes", tmp_path / "mine")
    (folder / "answers.toml").write_text('case_1 = "sampling noise"\ncase_2 = "filter"\ncase_1_filtered_rmse = 0.4')
    result = course.check(folder)
    assert result["few"].passed, str(result)
    assert not result["thin"].passed
    assert "case_2 = 'filter' has 3 % of the error" in str(result)
    assert not result["cure"].passed
    (folder / "answers.toml").write_text('case_1 = "noise"\ncase_2 = "hidden layers"\ncase_1_filtered_rmse = 0.049')
    result = course.check(folder)
    assert "case_1 = 'noise': write one of sampling noise, filter," in str(result)
    assert result["thin"].passed
    assert result["cure"].passed


@pytest.mark.slow
def test_the_best_split_and_the_sweep_that_finds_it(gl, tmp_path):
    folder = course.start("sweep", tmp_path / "mine")
    (folder / "answers.toml").write_text("best_split = [16, 4]")
    (folder / "sweep.toml").write_text(SWEEP)
    assert course.check(folder).passed
    (folder / "answers.toml").write_text("best_split = [64, 1]")
    (folder / "sweep.toml").write_text(SWEEP.replace(", 64]", "]").replace(", 1]", "]"))
    result = course.check(folder)
    assert result.score == 0
    assert "does not render 'boxes' with directions, steps = [64.0, 1.0]" in str(result)
    assert "times the least one" in str(result)
    (folder / "sweep.toml").write_text(
        SWEEP.replace("visibility.rmse", "visibility.mean").replace("seed", "reference = false\nseed")
    )
    assert "has no reference" in str(course.check(folder, only="design"))
    (folder / "sweep.toml").write_text("scene = ")
    assert "as TOML" in str(course.check(folder, only="design"))
