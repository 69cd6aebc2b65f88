"""`aolab sweep` and `aolab animate`: the listing, the table, the exit status, the errors."""

import json
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


@pytest.fixture
def spec(tmp_path):
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


def test_shards_then_the_table(aolab, spec):
    for part in ("0/2", "1/2"):
        assert aolab("sweep", spec(8), "-o", "out", "--shard", part).code == 0
    assert not Path("out/sweep.parquet").exists()
    done = aolab("sweep", spec(8), "-o", "out", "--json")
    rows = json.loads(done.out)
    assert len(rows) == len(pd.read_parquet("out/sweep.parquet")) == 4
    assert all(0 < row["visibility.mean"] < 1 for row in rows)


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
