"""The lines of README.md run in a fresh folder, at a small size; long ones tell how long they take."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).parents[1]
README = (CHECKOUT / "README.md").read_text(encoding="utf-8")
BLOCKS = {kind: re.findall(rf"^```{kind}\n(.*?)^```", README, re.MULTILINE | re.DOTALL) for kind in ("python", "sh")}
COMMANDS = [
    (part.strip(), comment.strip())
    for block in BLOCKS["sh"]
    for line in block.splitlines()
    if line.startswith(".venv/bin/aolab")
    for code, _, comment in [line.partition(" #")]
    for part in code.split(";")
]
# commands of minutes: a test reads their durations, and other tests run the commands (tests/shell, tests/studies)
LONG = ("bench --quality", "tune", "compare boxes --relight", "reproduce", "bench")
SMALL = {
    "render": ["--size", "96x54"],
    "reference": ["--size", "96x54", "--rays", "8"],
    "compare": ["--size", "96x54", "--rays", "8"],
}  # fmt: skip


def is_long(command: str) -> bool:
    return any(command.startswith(f".venv/bin/aolab {start}") for start in LONG)


@pytest.mark.slow
def test_the_python_lines_run(python, tmp_path):
    code = "\n".join(BLOCKS["python"]).replace("(1280, 720)", "(320, 180)")
    # a quarter of the size, and of the pixels in it
    code, changed = re.subn(
        r"\(frame, \((\d+), (\d+)\)\)", lambda m: f"(frame, ({int(m[1]) // 4}, {int(m[2]) // 4}))", code
    )
    assert changed >= 2
    done = python(code)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.slow
def test_the_shell_lines_run_one_after_another(tmp_path):
    (tmp_path / "out").mkdir()
    run = []
    for command, _ in COMMANDS:
        if is_long(command):
            continue
        words = shlex.split(command)[1:]
        if "--size" in words:
            words[words.index("--size") + 1] = "96x54"
        elif "--like" not in words:
            words += SMALL.get(words[0], [])
        run.append(words)
    assert len(run) >= 7
    for words in run:
        script = "from aolab.shell.cli import main; main()"
        done = subprocess.run(
            [sys.executable, "-c", script, *words],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, f"aolab {' '.join(words)}\n{done.stderr}"


def test_long_commands_tell_how_long_they_take():
    for start in (
        "reference",
        "compare colonnade",
        "bench --quality",
        "tune",
        "compare boxes --relight",
        "reproduce",
        "bench;",
    ):
        lines = [line for line in README.splitlines() if line.startswith(f".venv/bin/aolab {start}")]
        comments = [line.partition(" #")[2] for line in lines]
        assert comments, f"README has no line `aolab {start}`"
        assert re.search(r"\(\d+ (s|min)\b", comments[0]), f"aolab {start}: {comments[0]}"


def test_files_that_the_lines_name_exist():
    for path in re.findall(r"\bexamples/[\w./]+", README):
        assert (CHECKOUT / path.rstrip(".")).exists(), path
