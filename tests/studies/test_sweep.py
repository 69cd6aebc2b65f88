"""Sweeps: the cases of a plan, the table, and nothing lost when cases, workers or the sweep itself die."""

import json
import os
import resource
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest

import aolab
from aolab.errors import FileError, Notice, ParameterError
from aolab.studies.sweep.api import run_plan
from aolab.studies.sweep.case import Case, Settings, identity
from aolab.studies.sweep.plan import Draw, Plan, read_spec
from aolab.studies.sweep.schedule import shard_of
from aolab.studies.sweep.table import SweepTable

pytestmark = [
    pytest.mark.filterwarnings("ignore:sweep. none has no:aolab.Notice"),
    pytest.mark.filterwarnings("ignore:buffer .* standard error:aolab.Notice"),  # few rays, for speed
]
SMALL = {"size": (48, 32), "rays": 8}


@pytest.fixture(scope="module")
def table() -> SweepTable:
    with pytest.warns(Notice, match="none has no 'radius'"):
        return aolab.sweep("boxes", ["none", "ssao"], radius=[0.2, 0.5], directions=[4, 8], seed=range(2), **SMALL)


def test_a_row_a_case_and_a_module_without_the_parameter_once(table):
    rows = [tuple(row) for row in table[["module", "radius", "directions", "seed"]].fillna(0).itertuples(index=False)]
    expected = {("ssao", r, d, s) for r in (0.2, 0.5) for d in (4, 8) for s in (0, 1)} | {
        ("none", 0, 0, s) for s in (0, 1)
    }
    assert len(rows) == len(expected)
    assert set(rows) == expected
    assert (table["status"] == "ok").all()
    assert (table["ms"] > 0).all()
    assert table.attrs["measures"] == ["visibility.rmse", "visibility.bias"]


def test_a_case_has_the_error_that_compare_finds(table):
    row = table[(table["module"] == "ssao") & (table["radius"] == 0.2) & (table["seed"] == 1)].iloc[0]
    module = aolab.SSAO(radius=0.2, directions=int(row["directions"]))
    frame = aolab.render("boxes", module, size=SMALL["size"], seed=1)
    truth = aolab.reference("boxes", like=module, size=SMALL["size"], rays=8, buffers=("visibility",))
    assert row["visibility.rmse"] == aolab.compare(frame, truth, "visibility", flip=False)["visibility"].rmse


def test_cases_with_one_question_share_a_truth(cache_folder):
    aolab.sweep("boxes", "ssao", radius=[0.2, 0.5], directions=[2, 4, 8], seed=range(2), **SMALL)
    assert len(list(cache_folder.glob("*.npz"))) == 2


def test_a_buffer_of_a_stored_reference_of_several_is_not_traced_again(monkeypatch):
    names = ["visibility", "ambient", "bent_normal", "indirect"]
    aolab.reference("boxes", like=aolab.SSAO(radius=0.2), buffers=names, **SMALL)

    def trace(*arguments):
        raise AssertionError("rays were traced")

    monkeypatch.setattr(sys.modules["aolab.truth.reference"], "trace", trace)
    table = aolab.sweep("boxes", "ssao", radius=0.2, measures="ambient.rmse", **SMALL)
    assert list(table["error"]) == [""]


def test_times_are_those_of_a_frame_whose_maps_are_kept(tmp_path):
    for number, scene in enumerate(("cornell", "boxes")):  # the maps of the other scene are not those of "boxes"
        aolab.render(scene, "ssdo", size=(32, 18)).complete("image")
        folder = tmp_path / str(number)
        aolab.sweep(
            "boxes", ["ssdo", "rsm"], size=(32, 18), seed=range(2), measures=[lit], reference=False, folder=folder
        )
        records = [json.loads(file.read_text()) for file in (folder / "records").glob("*.json")]
        assert len(records) == 4
        for record in records:
            assert "g_buffer" in record["timings"]
            assert not {"shadows", "reflective shadow maps"} & set(record["timings"])


def lit(frame: aolab.Frame) -> float:
    return float(frame.image.mean())


def test_a_parameter_of_an_occluder_kind_belongs_to_the_cases_with_that_kind():
    options = {"occluders": ["depth", "layers"], "layers": [2, 3], "radius": 0.3, "reference": False}
    table = aolab.sweep("boxes", "ssao", size=(48, 32), **options)
    assert list(table["status"]) == ["ok"] * 3
    assert list(table["layers"].fillna(0)) == [0, 2, 3]
    with pytest.raises(ParameterError, match="no case takes 'layers', a parameter of occluders='layers'"):
        aolab.sweep("boxes", "ssao", layers=[2, 3], reference=False, size=(48, 32))


def test_scenes_and_modules_of_one_name_are_told_apart(boxes):
    lower = boxes.replace(environment=aolab.Environment.constant((0.1, 0.1, 0.1)))
    modules = [aolab.SSAO(steps=2), aolab.SSAO(steps=4, radius=0.5), "ssdo"]
    table = aolab.sweep([boxes, lower], modules, size=(32, 18), measures=["ambient.mean"], reference=False)
    name = boxes.source or boxes.name
    assert list(table["scene"].unique()) == [name, f"{name} (2)"]
    assert set(table["module"]) == {"ssao?steps=2", "ssao?radius=0.5", "ssdo"}  # 4 steps are the default
    first, second = (table[table["scene"] == scene]["ambient.mean"].to_numpy() for scene in table["scene"].unique())
    assert (first > second).all()


def test_measures_by_region_of_the_frame_alone_and_of_ones_own():
    def dark(frame: aolab.Frame) -> float:
        return float((frame["visibility"][frame.mask] < 0.5).mean())

    def both(frame: aolab.Frame, truth: aolab.Frame) -> dict[str, float]:
        return {"gap": float(np.nanmean(frame["visibility"] - truth["visibility"])), "one": 1.0}

    names = ["visibility.interior.rmse", "ambient.mean", dark, both]
    row = aolab.sweep("boxes", "ssao", radius=0.3, measures=names, **SMALL).iloc[0]
    frame = aolab.render("boxes", "ssao", radius=0.3, size=SMALL["size"])
    assert row["ambient.mean"] == pytest.approx(frame["ambient"][frame.mask].mean())
    assert row["dark"] == dark(frame)
    assert row["one"] == 1.0
    assert np.isfinite(row["visibility.interior.rmse"])


def test_lists_that_go_together_and_random_draws():
    plan = Plan(["boxes"], zipped={"radius": [0.1, 0.2], "bias": [0, 0.1]}, grid={"directions": [4, 8]})
    assert [(p["radius"], p["bias"]) for p in plan.points()] == [(0.1, 0), (0.2, 0.1)] * 2
    drawn = Plan(["boxes"], random={"radius": Draw("loguniform", (0.01, 1.0)), "steps": Draw("integers", (1, 4))},
                 samples=64).points()  # fmt: skip
    radius = np.log10([point["radius"] for point in drawn])
    assert (radius >= -2).all()
    assert (radius < 0).all()
    assert np.histogram(radius, 4, (-2, 0))[0] == pytest.approx([16] * 4, abs=1)  # Sobol points are spread evenly
    assert {point["steps"] for point in drawn} == {1, 2, 3, 4}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"radiuss": [1]}, "no module here has the parameter 'radiuss'; did you mean 'radius'"),
        ({"radius": []}, "the list of 'radius' is empty"),
        ({"zip": {"radius": [1, 2], "bias": [0]}}, "zipped lists differ in length"),
        ({"zip": {"radius": [1]}, "radius": [2]}, "radius stands in two tables"),
        ({"measures": "visibility.rmsee"}, "measure 'visibility.rmsee' is unknown"),
        ({"measures": "visibility.middle.rmse"}, "no region 'middle'"),
        ({"measures": "rmse", "reference": False}, "rmse compares with the truth, but reference is False"),
        ({"random": {"radius": ("normal", 0, 1)}}, "no distribution 'normal'"),
        ({"random": {"radius": ("uniform", 1, 0)}}, "two numbers, low before high"),
        ({"on_error": "ignore"}, "on_error = 'ignore' is not one of: record, raise"),
        ({"shard": "3/3"}, "shard = '3/3' is not I/N"),
        ({"workers": -1}, "workers = -1"),
        ({"workers": "two"}, "workers = 'two' is not a whole number"),
        ({"radius": None}, "no case can be rendered; the first: ssao: radius = None is not valid"),
        ({"directions": [0, -1]}, "no case can be rendered; the first: ssao: directions = 0 is not valid"),
        ({"size": 5}, "size = 5 is not two whole numbers"),
        ({"size": "48x32"}, "size = '48x32' is not two whole numbers"),
    ],
)
def test_a_sweep_that_cannot_work_is_refused(arguments, words):
    with pytest.raises(ParameterError, match=words.replace("(", r"\(")):
        aolab.sweep("boxes", "ssao", **{"size": (48, 32), **arguments})


def test_a_case_that_raises_is_a_row_with_its_error():
    table = aolab.sweep("boxes", "ssao", directions=[4, 0], radius=0.2, reference=False, size=(48, 32))
    assert list(table["status"]) == ["ok", "failed"]
    assert "directions = 0 is not valid" in table["error"][1]
    with pytest.raises(aolab.Error, match=r"sweep: boxes ssao 48x32 seed=0 directions=0 .*not valid"):
        aolab.sweep("boxes", "ssao", directions=[4, 0], radius=0.2, reference=False, size=(48, 32), on_error="raise")


def test_shards_are_the_whole():
    cases = list(range(10))
    assert [case for i in range(3) for case in shard_of(cases, f"{i}/3")] == cases


def counted(frame: aolab.Frame) -> float:
    """Leaves a mark for each case that is computed."""
    with Path(os.environ["COUNTED"]).open("a") as file:
        file.write("x")
    return 1.0


def test_a_folder_is_resumed_and_a_changed_sweep_runs_what_is_new(tmp_path, monkeypatch):
    monkeypatch.setenv("COUNTED", str(tmp_path / "marks"))

    def marks() -> int:
        return len((tmp_path / "marks").read_text())

    options = {"measures": counted, "size": (48, 32), "reference": False, "folder": tmp_path / "out"}
    first = aolab.sweep("boxes", "ssao", radius=[0.2, 0.4], images=True, buffers=["visibility"], **options)
    again = aolab.sweep("boxes", "ssao", radius=[0.2, 0.4], images=True, buffers=["visibility"], **options)
    assert marks() == 2
    assert first.equals(again)
    aolab.sweep("boxes", "ssao", radius=[0.2, 0.4, 0.8], **options)
    assert marks() == 3
    for name in first["case"]:
        assert (tmp_path / "out" / "images" / f"{name}.png").is_file()
        assert np.load(tmp_path / "out" / "buffers" / f"{name}.npz")["visibility"].shape == (32, 48)
    import pandas as pd

    assert len(pd.read_parquet(tmp_path / "out" / "sweep.parquet")) == 3
    assert first.small_multiples(tmp_path / "out", "radius").width > 2 * 48


def test_failed_cases_stay_until_they_are_asked_for_again(tmp_path, monkeypatch):
    def moody(frame: aolab.Frame) -> float:
        if "MOOD" in os.environ:
            raise ValueError("in a mood")
        return 1.0

    options = {"measures": moody, "size": (48, 32), "reference": False, "folder": tmp_path / "out", "radius": 0.2}
    monkeypatch.setenv("MOOD", "bad")
    assert aolab.sweep("boxes", **options)["error"][0] == "ValueError: in a mood"
    monkeypatch.delenv("MOOD")
    assert aolab.sweep("boxes", **options)["status"][0] == "failed"
    assert aolab.sweep("boxes", retry_failed=True, **options)["status"][0] == "ok"


def script(tmp_path: Path, text: str) -> subprocess.Popen[str]:
    file = tmp_path / "run.py"
    file.write_text(textwrap.dedent(text))
    return subprocess.Popen([sys.executable, str(file)], cwd=tmp_path, stderr=subprocess.PIPE, text=True)


SLOW = """
    import time, aolab
    def slow(frame):
        time.sleep(0.3)
        return 1.0
    if __name__ == "__main__":
        aolab.sweep("boxes", "ssao", measures=slow, reference=False, size=(48, 32), seed=range(30), folder="out")
"""


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_a_killed_sweep_goes_on_where_it_stopped(tmp_path, how):
    records = tmp_path / "out" / "records"
    child = script(tmp_path, SLOW)
    deadline = time.monotonic() + 60
    while len(list(records.glob("*.json"))) < 3 and time.monotonic() < deadline:
        time.sleep(0.05)
    child.send_signal(how)
    child.communicate()
    done = {path.name: path.stat().st_mtime_ns for path in records.glob("*.json")}
    assert 3 <= len(done) < 30
    assert all(json.loads((records / name).read_text())["status"] == "ok" for name in done)
    (tmp_path / "run.py").write_text(textwrap.dedent(SLOW).replace("range(30)", f"range({len(done) + 1})"))
    subprocess.run([sys.executable, "run.py"], cwd=tmp_path, check=True)
    after = {path.name: path.stat().st_mtime_ns for path in records.glob("*.json")}
    assert done.items() <= after.items()
    assert len(after) == len(done) + 1


@pytest.mark.slow
def test_a_full_disk_stops_the_sweep_and_leaves_what_is_written(tmp_path):
    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    code = """
import aolab
aolab.sweep("boxes", "ssao", reference=False, size=(48, 32), seed=range(3), folder="out", images=True)
"""
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, preexec_fn=limited
    )
    assert "FileError: cannot write" in done.stderr
    assert "File too large" in done.stderr
    for path in (tmp_path / "out" / "records").glob("*.json"):
        json.loads(path.read_text())
    assert (
        aolab.sweep("boxes", reference=False, size=(48, 32), seed=range(3), folder=tmp_path / "out")["status"]
        .eq("ok")
        .all()
    )


def deadly(frame: aolab.Frame) -> float:
    """Ends the worker process: always for seed 1, and once for seed 2."""
    seed, mark = frame.info["seed"], Path(os.environ["DEADLY"])
    if seed == 1 or (seed == 2 and not mark.exists()):
        mark.touch()
        os._exit(1)
    return float(np.nanmean(frame["visibility"]))


@pytest.mark.slow
def test_workers_that_die_are_replaced_and_their_case_is_named(tmp_path, monkeypatch):
    monkeypatch.setenv("DEADLY", str(tmp_path / "mark"))
    options = {"measures": [deadly, "visibility.rmse"], "radius": 0.3, **SMALL}
    scene = aolab.load("boxes")  # it travels to the workers, also to those that replace the dead
    table = aolab.sweep(scene, "ssao", seed=range(5), workers=2, folder=tmp_path / "out", **options)
    assert list(table["status"]) == ["ok", "failed", "ok", "ok", "ok"]
    assert table["error"][1] == "its worker process died in each of 3 tries"
    here = aolab.sweep("boxes", "ssao", seed=[0, 2, 3, 4], **options)
    for name in ("deadly", "visibility.rmse"):  # bit for bit
        assert list(table[table["status"] == "ok"][name]) == list(here[name])


SPEC = """
scene = "boxes"
module = ["ssao", "none"]
size = ["48x32", [32, 48]]
seed = [0, 1]
rays = 8
measures = ["rmse", "visibility.mean"]
[camera.front]
eye = [0, 1, 5]
target = [0, 0, 0]
[parameters]
radius = [0.2, 0.4]
[random]
samples = 2
bias = { uniform = [0.0, 0.1] }
[fixed]
filter = "none"
"""


def test_a_specification_in_toml(tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC)
    plan = read_spec(tmp_path / "spec.toml")
    cases = plan.cases()
    assert len(cases) == 2 * 2 * (2 * 2 + 1)
    assert {case.camera_name for case in cases} == {"front"}
    assert {case.size for case in cases} == {(48, 32), (32, 48)}
    table = run_plan(plan, tmp_path / "out", shard="0/4")
    assert table["status"].eq("ok").all()
    assert len(table) == 5


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("scne = 'boxes'", "unknown key 'scne'; did you mean 'scene'"),
        ("module = 'ssao'", "the key 'scene' is missing"),
        ("scene = 'boxes'\nsize = '48'", "size = '48' is not WIDTHxHEIGHT"),
        ("scene = 'boxes'\n[camera]\neye = [0,0,1]\nfow = 3", "camera 'camera' has no 'fow'; did you mean 'fov'"),
        ("scene = [", "cannot read"),
    ],
)
def test_errors_of_a_specification_name_the_file_and_the_key(tmp_path, text, words):
    (tmp_path / "spec.toml").write_text(text)
    with pytest.raises((ParameterError, FileError), match=words) as error:
        read_spec(tmp_path / "spec.toml")
    assert "spec.toml" in str(error.value)


def test_the_table_becomes_an_array_and_pictures(table):
    cube = table[table["module"] == "ssao"].to_xarray()
    assert dict(cube.sizes) == {"seed": 2, "radius": 2, "directions": 2}
    value = cube["visibility.rmse"].sel(seed=1, radius=0.5, directions=8).item()
    row = table[(table["seed"] == 1) & (table["radius"] == 0.5) & (table["directions"] == 8)]
    assert value == row["visibility.rmse"].item()
    front = table.pareto().axes[0].lines[-1].get_xydata()
    costs = table[["ms", "visibility.rmse"]].to_numpy()
    for ms, error in front:
        assert not ((costs[:, 0] < ms) & (costs[:, 1] < error)).any()
    assert len(table.lines("directions").axes[0].lines) == 1  # none has no directions
    assert table[table["module"] == "ssao"].heat_map("radius", "directions").axes[0].get_xlabel() == "radius"
    with pytest.raises(ParameterError, match="no column 'radiuss'"):
        table.lines("radiuss")


def test_a_notebook_shows_the_table_and_its_plots(table):
    shown = table._repr_html_()
    assert shown.count("<img") == 2
    assert "visibility.rmse over radius" in shown
    assert "visibility.rmse against time" in shown
    assert table[["module", "seed"]]._repr_html_().count("<img") == 0


def test_notes_of_a_case_stand_in_its_row(table):
    assert table["notes"].str.contains("standard error").any()


def test_a_band_is_students_interval_over_the_seeds():
    same = {"scene": "s", "module": "m", "radius": 1, "ms": 1.0, "status": "ok"}
    records = [{"case": str(seed), "seed": seed, "rmse": float(seed), **same} for seed in (1, 2, 3)]
    table = SweepTable.of(records, {"inputs": ["seed", "radius"], "measures": ["rmse"]})
    low, high = np.sort(np.unique(table.lines("radius").axes[0].collections[0].get_paths()[0].vertices[:, 1]))[[0, -1]]
    assert (low, high) == pytest.approx((2 - 2.4841, 2 + 2.4841), abs=1e-3)  # t(0.975, 2) / √3 = 4.3027 / √3


def test_an_edit_of_ones_own_shader_or_of_its_include_makes_another_case(tmp_path):
    (tmp_path / "share.glsl").write_text("const float SHARE = 0.5;\n")
    shader = tmp_path / "own.frag"
    shader.write_text('#include "share.glsl"\nout float visibility;\nvoid main() { visibility = SHARE; }\n')

    class Own(aolab.Module):
        pass

    Own.shader = shader
    case, settings = Case("boxes", Own, {}, (32, 24)), Settings(measures=())
    names = [identity(case, settings), identity(case, settings)]
    (tmp_path / "share.glsl").write_text("const float SHARE = 0.6;\n")
    names.append(identity(case, settings))
    shader.write_text(shader.read_text().replace("= SHARE", "= 1.0 - SHARE"))
    names.append(identity(case, settings))
    assert names[0] == names[1]
    assert len(set(names)) == 3
