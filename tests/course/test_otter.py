"""The folder of an exercise under otter-grader: a real run, and its results.json."""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from aolab import course

pytest.importorskip("otter", reason="otter-grader is not installed")


def run(*command: str | Path, cwd: Path) -> str:
    """The output of otter; a failed command fails the test with it."""
    done = subprocess.run(
        [sys.executable, "-m", "otter", *map(str, command)], cwd=cwd, capture_output=True, text=True, env=os.environ
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.slow
def test_otter_grades_a_submission_by_its_steps(tmp_path):
    """Two of four steps are right, one is wrong, one is not begun."""
    folder = course.start("positions", tmp_path / "positions")
    one = course.exercise("positions")
    text = one.solution["positions.frag"].replace("(world_from_view * vec4(viewPos, 1.0)).xyz", "viewPos")
    start = one.holes["positions.frag"]
    text = course.shader.with_functions(text, start, ["tangentAlong", "normalFromDepth"])
    (folder / "positions.frag").write_text(text)
    run("generate", "-t", "tests", "-o", tmp_path / "autograder.zip", "--no-config", "--no-requirements",
        "--no-environment", cwd=folder)  # fmt: skip
    with zipfile.ZipFile(tmp_path / "mine.zip", "w") as archive:
        for name in ("exercise.ipynb", "positions.frag", "aolab.toml"):
            archive.write(folder / name, name)
    run("run", "-a", tmp_path / "autograder.zip", "-o", tmp_path, tmp_path / "mine.zip", cwd=tmp_path)
    results = json.loads((tmp_path / "results.json").read_text())
    tests = {test["name"]: test for test in results["tests"] if test.get("max_score")}
    expected = {step.name: sum(check.points for check in step.checks) for step in one.spec.steps}
    assert {name: test["max_score"] for name, test in tests.items()} == expected
    scores = {name: test["score"] for name, test in tests.items()}
    assert scores == {"position": expected["position"], "pixel": expected["pixel"], "world": 0, "normal": 0}
