"""`aolab sweep` and `aolab animate`: the listing, the table, the exit status, the errors."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

pd = pytest.importorskip("pandas", reason="the extra `sweep` is not installed")

SPEC = """
scene = "boxes"
size = "48x32"
measures = "visibility.mean"
reference = false
[parameters]
radius = [0.2, 0.4]
directions = [4, {last}]
"""


PAGE = (Path(__file__).parents[2] / "docs" / "sweeps.md").read_text(encoding="utf-8").partition("## On a cluster")[2]
BLOCKS = re.findall(r"^```sh\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture
def spec(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def write(last: int) -> str:
        (tmp_path / "spec.toml").write_text(SPEC.format(last=last))
        return "spec.toml"

    return write


def test_dry_run_lists_the_cases_and_writes_nothing(aolab, spec):
    done = aolab("sweep", spec(8), "--dry-run")
    assert done.code == 0, done.err
    *cases, total = done.out.splitlines()
    assert len(cases) == 4
    assert "boxes ssao 48x32 seed=0 radius=0.2 directions=4" in cases
    assert total.startswith("4 cases, about ")
    assert [path.name for path in Path().iterdir()] == ["spec.toml"]
    listed = json.loads(aolab("sweep", spec(8), "--dry-run", "--shard", "1/4", "--json").out)
    assert len(listed["cases"]) == 1


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("phase", ["starting", "computing"])
def test_an_interrupt_ends_the_workers_too(spec, phase):
    """A terminal sends SIGINT to all processes. The error output ends when the last process has ended."""
    name = spec(8)
    Path(name).write_text(
        Path(name).read_text().replace("reference = false", f"reference = false\nseed = {[*range(200)]}")
    )
    command = [sys.executable, "-m", "aolab.shell.cli", "sweep", name, "-o", "out", "--workers", "2"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)
    here = Path("out/records")
    deadline = time.monotonic() + 60
    while len(list(here.glob("*.json"))) < 3 and time.monotonic() < deadline:
        time.sleep(0.02)
        if phase == "starting" and len(children(process.pid)) >= 3:  # two workers, and the tracker of their files
            break
    os.killpg(process.pid, signal.SIGINT)
    errors = process.communicate(timeout=30)[1]
    assert process.returncode == 130
    assert [line for line in errors.splitlines() if "dashboard" not in line] == ["aolab: interrupted"]
    assert len(list(here.glob("*.json"))) < 800


def children(pid: int) -> list[int]:
    """The processes that a process has started."""
    listed = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False)
    return [int(line) for line in listed.stdout.split()]


def test_shards_then_the_table(aolab, spec):
    for part in ("0/2", "1/2"):
        assert aolab("sweep", spec(8), "-o", "out", "--shard", part).code == 0
    assert not Path("out/sweep.parquet").exists()
    done = aolab("sweep", spec(8), "-o", "out", "--json")
    rows = json.loads(done.out)
    assert len(rows) == len(pd.read_parquet("out/sweep.parquet")) == 4
    assert all(0 < row["visibility.mean"] < 1 for row in rows)


@pytest.fixture
def shell(tmp_path) -> Callable[..., subprocess.Popen[str]]:
    """Starts lines of a page in bash, where `aolab` and `dask` are those of this Python."""
    commands = tmp_path / "commands"
    commands.mkdir()
    for name, code in {
        "aolab": "from aolab.shell.cli import main; main()",
        "dask": "from dask.cli import run_cli; run_cli()",
    }.items():
        (commands / name).write_text(f"#!/bin/sh\nexec '{sys.executable}' -c '{code}' \"$@\"\n")
        (commands / name).chmod(0o755)
    path = os.pathsep.join([str(commands), os.environ["PATH"]])

    def start(lines: str, **variables: str) -> subprocess.Popen[str]:
        package = str(Path(__file__).parents[2])
        environment = {**os.environ, "PATH": path, "PYTHONPATH": package, **variables}
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
        return subprocess.Popen(
            ["bash", "-ec", f"exec {lines}" if "\n" not in lines else lines], env=environment, **streams
        )

    return start


@contextmanager
def running(process: subprocess.Popen[str]) -> Iterator[None]:
    try:
        yield
    finally:
        process.terminate()
        process.communicate(timeout=60)


@pytest.mark.slow
def test_the_pages_dask_cluster(shell, spec):
    pytest.importorskip("distributed")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    block = BLOCKS[0].replace("8786", str(port)).replace("HOST", "127.0.0.1").replace("sweep.toml", spec(8))
    lines = [line.partition(" #")[0].strip() for line in block.splitlines()]
    scheduler, worker, sweep = (line.removeprefix("LP_NUM_THREADS=1 ") for line in lines)
    with running(shell(f"{scheduler} --dashboard-address :0")), running(shell(worker, LP_NUM_THREADS="1")):
        done = shell(sweep)
        output, _ = done.communicate(timeout=120)
    assert done.returncode == 0, output
    assert "4 of 4 cases succeeded" in output
    assert len(pd.read_parquet("out/sweep.parquet")) == 4


@pytest.mark.slow
def test_the_pages_job_array(shell, spec):
    job, last = (block.replace("sweep.toml", spec(8)).replace("/40", "/3") for block in BLOCKS[1:])
    assert "#SBATCH --array=0-39" in job
    for task in range(3):
        done = shell(job, SLURM_ARRAY_TASK_ID=str(task))
        output, _ = done.communicate(timeout=120)
        assert done.returncode == 0, output
        assert not Path("out/sweep.parquet").exists()
    written = {path: path.stat().st_mtime_ns for path in Path("out/records").iterdir()}
    done = shell(last.strip())
    assert "4 of 4 cases succeeded" in done.communicate(timeout=120)[0]
    assert {path: path.stat().st_mtime_ns for path in Path("out/records").iterdir()} == written
    assert len(pd.read_parquet("out/sweep.parquet")) == 4


def test_a_failed_case_is_named_and_the_status_is_1(aolab, spec):
    done = aolab("sweep", spec(0), "-o", "out")
    assert done.code == 1
    assert "2 of 4 cases succeeded" in done.out
    assert "directions = 0 is not valid" in done.out


def test_errors_name_the_option_the_file_and_the_scheduler(aolab, spec, monkeypatch):
    monkeypatch.setattr("aolab.studies.sweep.schedule.CONNECT", 0.5)
    done = aolab("sweep", spec(8))
    assert (done.code, done.out) == (2, "")
    assert "-o DIR" in done.err
    assert "no file nothing.toml" in aolab("sweep", "nothing.toml", "-o", "out").err
    assert "no Dask scheduler" in aolab("sweep", spec(8), "-o", "out", "--scheduler", "tcp://127.0.0.1:1").err


def test_a_film_of_a_scene_in_motion(aolab):
    done = aolab("animate", "toasters", "--vary", "time=0:1", "--size", "48x32", "--seconds", "0.2", "--fps", "10",
                 "-o", "film.gif")  # fmt: skip
    assert (done.code, done.out) == (0, "film.gif\n"), done.err
    assert Path("film.gif").read_bytes()[:3] == b"GIF"
    assert "time=6 is not NAME=FIRST:LAST" in aolab("animate", "toasters", "--vary", "time=6").err
