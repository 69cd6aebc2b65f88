"""docs/lecturers.md: its lines run one after another in a fresh folder, and the exercises that it names exist."""

import csv
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from aolab.course import exercises

SH = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COMMANDS = """set -e
aolab() { "$PYTHON" -c 'from aolab.shell.cli import main; main()' "$@"; }
python() { "$PYTHON" "$@"; }
"""

CHECKOUT = Path(__file__).parents[2]
PAGE = (CHECKOUT / "docs" / "lecturers.md").read_text(encoding="utf-8")
ENVIRONMENT = {
    **os.environ,
    "PYTHON": sys.executable,
    "PYTHONPATH": os.pathsep.join([str(CHECKOUT), os.environ.get("PYTHONPATH", "")]),
}


def section(title: str) -> str:
    return PAGE.partition(f"\n## {title}\n")[2].partition("\n## ")[0]


@pytest.mark.long
def test_the_first_ten_minutes_end_with_a_graded_folder(tmp_path: Path) -> None:
    set_up, *rest = SH.findall(section("The first ten minutes").partition("make demo\n")[2])
    assert set_up.startswith("aolab exercise list")
    script = COMMANDS + set_up + "".join(rest)
    done = subprocess.run(
        ["bash", "-c", script], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "submissions/ben/show.png").is_file()
    with (tmp_path / "grades.csv").open() as table:
        ada, ben, cyd = csv.DictReader(table)
    assert float(ada["score"]) == float(ada["points"]) == exercises()["positions"].points
    assert float(ada["score"]) > float(ben["score"]) > 0.6 * float(ada["points"])
    assert "sign of z" in ben["hints"]
    assert "sign of z" in done.stdout.partition("grades.csv")[0] or "wrong sign" in done.stdout
    assert float(cyd["score"]) == 1


def test_the_schedule_has_every_exercise_with_its_minutes() -> None:
    weeks = "".join(row.split("|")[3] for row in section("Six weeks").splitlines() if re.match(r"\| \d", row))
    named = dict(re.findall(r"`(\w+)`[^(|]*\((\d+)\)", weeks))
    wanted = {name: str(one.spec.minutes) for name, one in exercises().items()}
    assert wanted.items() <= named.items()
