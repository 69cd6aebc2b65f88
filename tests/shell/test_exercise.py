"""`aolab exercise`: list, start, check, show, grade, new."""

import csv
import json
from pathlib import Path

import pytest
from students import hand_in

from aolab import course


def mistaken(folder: str) -> Path:
    """A student's folder with one mistake."""
    texts = course.exercise("positions").solution
    return hand_in(Path(folder), "positions", {file: text.replace("cross(", "-cross(") for file, text in texts.items()})


def test_list_names_every_exercise(aolab):
    done = aolab("exercise", "list")
    assert done.code == 0, done.err
    assert all(name in done.out for name in course.exercises())
    listed = json.loads(aolab("exercise", "list", "--json").out)
    assert [one["name"] for one in listed] == list(course.exercises())
    assert all(one["points"] > 0 and one["steps"] for one in listed)


def test_start_names_the_next_command(aolab):
    done = aolab("exercise", "start", "positions")
    assert done.code == 0, done.err
    assert "aolab exercise check positions" in done.out
    assert sorted(path.name for path in Path("positions").glob("*.*")) == [
        "aolab.toml", "exercise.ipynb", "positions.frag", "task.md",
    ]  # fmt: skip
    again = aolab("exercise", "start", "positions")
    assert (again.code, again.err) == (
        2,
        "aolab: positions exists already and is not an empty folder; name another one\n",
    )


@pytest.mark.slow
def test_check_writes_gradescopes_form_and_its_status_is_1_after_a_failure(aolab):
    done = aolab("exercise", "check", mistaken("mine"), "--json", "results.json", "--only", "normal")
    assert done.code == 1, done.err
    assert "hint: The normals point into the surface" in done.out
    written = json.loads(Path("results.json").read_text())
    assert {test["status"] for test in written["tests"]} == {"passed", "failed"}
    assert all({"name", "score", "max_score", "output"} <= test.keys() for test in written["tests"])
    assert sum(test["score"] for test in written["tests"]) == written["score"]
    assert written["extra_data"]["hints"]["normal"]["mistake"] == "normals point away"


@pytest.mark.slow
def test_grade_writes_a_row_a_folder(aolab):
    mistaken("jane")
    Path("empty").mkdir()
    done = aolab("exercise", "grade", "jane", "empty", "-o", "results.csv")
    assert done.code == 0, done.err
    with open("results.csv", newline="") as file:
        jane, empty = csv.DictReader(file)
    assert float(jane["score"]) == course.exercise("positions").points - 4
    assert jane["hints"] == "normal: normals point away"
    assert jane["normal 3 solution"] == "0"
    assert jane["world 2 solution"] == "2"
    assert empty["score"] == "0"
    assert "no aolab.toml in empty" in empty["error"]


def test_show_and_new_write_where_they_are_told(aolab):
    course.start("positions", "mine")
    assert aolab("exercise", "show", "mine", "--only", "world").out == "mine/show.png\n"
    assert Path("mine/show.png").stat().st_size > 1000
    assert "own/exercise.toml" in aolab("exercise", "new", "own").out
    assert aolab("exercise", "start", "own", "trial").code == 0
    assert "no exercise 'hemispere'" in aolab("exercise", "start", "hemispere").err
