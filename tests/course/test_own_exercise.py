"""A lecturer's own exercise: the template, a copy, the errors of exercise.toml; and the folder of a student."""

import json
from pathlib import Path

import numpy as np
import pytest
from students import hand_in

from aolab import course
from aolab.course.exercise import SPEC
from aolab.course.exercise import names as exercise_names
from aolab.errors import FileError, ParameterError

NAMES = exercise_names()


def edited(folder: Path, old: str, new: str) -> Path:
    """The folder of a new exercise with an edit of exercise.toml."""
    course.new(folder)
    text = (folder / SPEC).read_text()
    assert old in text
    (folder / SPEC).write_text(text.replace(old, new))
    return folder


@pytest.mark.parametrize("like", [None, "harmonics"])
def test_a_new_exercise_works_at_once(gl, tmp_path, like):
    made = course.new(tmp_path / "mine", like=like)
    one = course.exercise(made)
    student = course.start(made, tmp_path / "student")
    assert course.check(student).score == 1  # aolab.toml leads to the lecturer's folder
    for file, text in one.solution.items():
        (student / file).write_text(text)
    assert course.check(student).passed
    assert course.check(student, name=made).score == one.points


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('kind = "range"', 'kind = "ragne"', "step.mean.check.1: .*'ragne'"),
        ("tolerance = 0.05", "tolerance = -1", "step.mean.check.2.tolerance: .*greater than 0"),
        ("minutes = 30", "minuts = 30", "minutes: Field required|unknown key 'minuts'"),
        ("tolerance = 0.05", "toleranz = 0.05", "unknown key 'step.mean.check.2.toleranz'"),
        ('main = "', 'mian = "', "no shader of the exercise has a function 'mian'"),
        (
            '"pow(1.0 - blockedDirections"',
            '"pow(2.0"',
            "mistake 'occlusion in place of visibility': 0 shaders, not one",
        ),
        ('file = "ssao.frag"', 'file = "sao.frag"', "no shader 'sao.frag' in .*did you mean 'ssao.frag'"),
        ('module = "ssao?', 'module = "sao?', "no module 'sao'"),
        ("title =", "title ", "as TOML"),
    ],
)
def test_a_wrong_exercise_is_refused_with_its_key(tmp_path, old, new, message):
    with pytest.raises(ParameterError, match=message):
        course.exercise(edited(tmp_path / "mine", old, new))


def test_unknown_exercises_and_folders_in_the_way_are_refused(tmp_path):
    with pytest.raises(ParameterError, match=r"no exercise 'hemispere'.*did you mean 'hemisphere'"):
        course.exercise("hemispere")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    with pytest.raises(FileError, match="is not an empty folder"):
        course.start("positions", tmp_path / "full")
    with pytest.raises(FileError, match="exists already"):
        course.new(tmp_path / "full")
    with pytest.raises(ParameterError, match=r"has no step 'nromal'.*did you mean 'normal'"):
        course.check(course.start("positions", tmp_path / "mine"), only="nromal")


@pytest.mark.parametrize("name", NAMES)
def test_the_folder_has_the_task_the_files_and_a_notebook(tmp_path, name):
    one = course.exercise(name)
    folder = course.start(name, tmp_path / "mine")
    page = (folder / "task.md").read_text()
    assert page.startswith(f"# {one.spec.title}\n")
    assert all(f"`{step.name}`" in page for step in one.spec.steps)
    notebook = json.loads((folder / "exercise.ipynb").read_text())
    graded = [cell["metadata"]["nbgrader"] for cell in notebook["cells"] if "nbgrader" in cell["metadata"]]
    assert {cell["grade_id"]: cell["points"] for cell in graded} == {
        step.name: sum(check.points for check in step.checks) for step in one.spec.steps
    }
    for file in one.solution:
        text = (folder / Path(file).name).read_text()
        assert text.count("TODO, step") >= 1


def test_the_order_names_every_folder_and_the_times_are_those_of_a_course():
    folders = {path.parent.name for path in Path(course.exercise(NAMES[0]).folder.parent).glob(f"*/{SPEC}")}
    assert set(exercise_names()) == folders
    assert all(30 <= course.exercise(name).spec.minutes <= 120 for name in NAMES)


def test_a_picture_has_a_row_a_step(gl, tmp_path):
    one = course.exercise("positions")
    wrong = {
        file: text.replace("return normalize(cross(", "return -normalize(cross(") for file, text in one.solution.items()
    }
    folder = hand_in(tmp_path / "mine", "positions", wrong)
    both, single = course.show(folder), course.show(folder, only="normal")
    assert both.height > 3 * single.height
    pixels = np.asarray(single)
    ours, expected = pixels[40:200, 10:320], pixels[40:200, 340:650]
    assert np.abs(ours.astype(int) - expected).mean() > 20  # the normals point away
    with pytest.raises(ParameterError, match="has no pictures"):
        course.show(course.start("causes", tmp_path / "causes"))
