"""Every exercise: its solution has all points, its holes have none, and each known mistake is named."""

import pytest
from students import hand_in

from aolab import course
from aolab.course import shader as glsl
from aolab.course.exercise import bare, mutated
from aolab.course.exercise import names as exercise_names
from aolab.course.results import COMPILES

NAMES = exercise_names()
WRITTEN = [name for name in NAMES if course.exercise(name).spec.shaders]
MISTAKES = [(name, step.name, mistake.name) for name in WRITTEN for step in course.exercise(name).spec.steps
            for mistake in step.mistakes]  # fmt: skip


@pytest.mark.parametrize("name", WRITTEN)
def test_the_solution_has_all_points(gl, tmp_path, name):
    one = course.exercise(name)
    result = course.check(hand_in(tmp_path / "mine", name, one.solution))
    assert result.passed, str(result)
    assert result.score == result.points == one.points


@pytest.mark.parametrize("name", WRITTEN)
def test_the_holes_compile_and_have_no_other_points(gl, tmp_path, name):
    result = course.check(course.start(name, tmp_path / "mine"))
    assert result[COMPILES].passed, str(result)
    assert result.score == 1
    assert not any(step.begun for step in result.steps if step.name != COMPILES)


@pytest.mark.parametrize("name", WRITTEN)
def test_a_step_by_itself_has_its_points(gl, tmp_path, name):
    """The last step done, all others as they were: its functions alone earn its points."""
    one = course.exercise(name)
    last = one.spec.steps[-1]
    texts = dict(one.holes)
    for hole in last.holes:
        file = one.file_of(hole)
        texts[file] = glsl.with_functions(texts[file], one.solution[file], [bare(hole)])
    result = course.check(hand_in(tmp_path / "mine", name, texts))
    assert [step.name for step in result.steps if step.score] == [COMPILES, last.name], str(result)
    assert result[last.name].passed


@pytest.mark.slow
@pytest.mark.parametrize(("name", "step", "mistake"), MISTAKES)
def test_a_known_mistake_fails_and_is_named(gl, tmp_path, name, step, mistake):
    one = course.exercise(name)
    known = next(found for found in one.step(step).mistakes if found.name == mistake)
    result = course.check(hand_in(tmp_path / "mine", name, mutated(one, known)), only=step)[step]
    assert not result.passed
    assert result.mistake == mistake
    assert result.hint == known.hint


def test_there_are_enough_exercises_and_mistakes():
    assert len(MISTAKES) >= 20
