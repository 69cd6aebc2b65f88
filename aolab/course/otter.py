"""Test files for otter-grader: a file for each step, with a case for each check."""

from .exercise import Exercise, Step

_FILE = '''"""Step "{step}" of the exercise "{name}", for otter-grader."""

from otter.test_files import test_case

from aolab import course

OK_FORMAT = False
name = "{step}"
points = None
{cases}'''

_CASE = """

@test_case(points={points:g}, name="{kind}")
def test_{number}():
    found = course.check(only="{step}")["{step}"].checks[{place}]
    assert found.passed, found.message
"""


def files(one: Exercise) -> dict[str, str]:
    """{path: text} of the folder `tests`."""
    return {f"tests/{step.name}.py": _file(one, step) for step in one.spec.steps}


def _file(one: Exercise, step: Step) -> str:
    cases = [
        _CASE.format(
            points=check.points, kind=f"{place + 1} {check.kind}", step=step.name, place=place, number=place + 1
        )
        for place, check in enumerate(step.checks)
    ]
    return _FILE.format(step=step.name, name=one.name, cases="".join(cases))
