"""The `aolab` lines of the docs run, page by page and in order, in a fresh folder at a small size."""

import re
import shlex
from pathlib import Path
from shutil import copy, copytree

import pytest

from aolab import paths
from aolab.course import exercise

CHECKOUT = Path(__file__).parents[2]
# lines of minutes, of a window and of several machines, and the tests that run such commands
ELSEWHERE = {
    "bench": "tests/shell/test_bench.py",
    "reproduce": "tests/papers/test_reproduce.py",
    "tune": "tests/shell/test_tune.py",
    "view": "tests/notebook/test_viewer.py",
    "exercise grade": "tests/course/test_lecturers.py",
    "sweep sweep.toml -o out --scheduler": "tests/studies/test_sweep.py",
    "sweep sweep.toml -o out --shard": "tests/shell/test_sweep.py",
}
SMALL = {"--size": "64x36", "--rays": "8", "--relight": "2", "--workers": "2"}
ADDED = {"render": ("--size",), "reference": ("--size", "--rays"), "compare": ("--size", "--rays")}
SMALL_SWEEP = {
    '["boxes", "colonnade"]': '["boxes"]',
    '"480x270"': '"48x27"',
    "seed = [0, 1, 2, 3]": "seed = [0]",
    "directions = [4, 8, 16]": "directions = [4]",
    "samples = 8": "samples = 2",
}


def lines_of(page: Path) -> list[str]:
    """The lines of `sh` blocks that start with `aolab`, without their comments; a line may go on after a backslash."""
    blocks = re.findall(r"^```sh\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    lines = "\n".join(blocks).replace("\\\n", " ").splitlines()
    return [line.removeprefix("aolab ").partition(" #")[0].strip() for line in lines if re.match(r"aolab [a-z]", line)]


def runs_elsewhere(line: str) -> bool:
    return any(line.startswith(start) for start in ELSEWHERE)


PAGES = {
    page.relative_to(CHECKOUT / "docs").as_posix(): [line for line in lines_of(page) if not runs_elsewhere(line)]
    for page in sorted((CHECKOUT / "docs").rglob("*.md"))
    if "_build" not in page.parts and page.name != "lecturers.md"  # tests/course/test_lecturers.py
}


def small(line: str) -> list[str]:
    words = shlex.split(line)
    for option, value in SMALL.items():
        if option in words:
            words[words.index(option) + 1] = value
        elif option in ADDED.get(words[0], ()):
            words += [option, value]
    return words


def files_that_pages_name(folder: Path) -> None:
    """`student.py`, shaders of one's own, a specification of a sweep, a model, and a folder that a student hands in."""
    page = (CHECKOUT / "docs/your_own_module.md").read_text(encoding="utf-8")
    ball = next(
        cell for cell in re.findall(r"^```\{code-cell\}.*?\n(.*?)^```$", page, re.M | re.S) if "class Ball" in cell
    )
    mine = "\n\nclass Mine(aolab.SSAO):\n    name = 'mine'\n"
    (folder / "student.py").write_text(f"import aolab\nimport numpy as np\n{ball}{mine}")
    for name in ("student.frag", "ball.frag"):
        copy(paths.glsl() / "ssao.frag", folder / name)
    sweep = (CHECKOUT / "docs/sweeps.md").read_text(encoding="utf-8").partition("```toml\n")[2].partition("```")[0]
    for text, smaller in SMALL_SWEEP.items():
        assert text in sweep
        sweep = sweep.replace(text, smaller)
    (folder / "sweep.toml").write_text(sweep)


def hand_in_the_solution(name: str, folder: str | None = None) -> None:
    """A folder with points missing ends `check` with exit status 1."""
    for file, text in exercise(name).solution.items():
        (Path(folder or name) / Path(file).name).write_text(text)


@pytest.mark.slow
@pytest.mark.parametrize("page", [page for page, lines in PAGES.items() if lines])
def test_the_lines_of_a_page_run_one_after_another(page, aolab, tmp_path):
    files_that_pages_name(tmp_path)
    for line in PAGES[page]:
        if "submissions/ada" in line:
            copytree("hemisphere", "submissions/ada")
        done = aolab(*small(line))
        assert done.code == 0, f"docs/{page}: aolab {line}\n{done.err}"
        if line.startswith("exercise start"):
            hand_in_the_solution(*line.split()[2:])


def test_lines_that_run_elsewhere_have_a_test():
    assert sum(map(len, PAGES.values())) > 30
    for path in ELSEWHERE.values():
        assert (CHECKOUT / path).is_file(), path
