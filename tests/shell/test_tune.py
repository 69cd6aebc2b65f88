"""`aolab tune`: a preset that `aolab.render` takes, and a table."""

import json
from pathlib import Path

import pytest

import aolab as package

pytest.importorskip("optuna", reason="the extra `tune` is not installed")

SMALL = ("tune", "ssao", "--parameters", "thickness,bias", "--set", "steps=3", "--scenes", "boxes", "--test-scenes",
         "cornell", "--trials", "2", "--views", "1", "--size", "64x36", "--rays", "8")  # fmt: skip


def test_a_preset_is_written_that_a_module_takes(aolab):
    done = aolab(*SMALL, "--json", "-o", "preset.json")
    assert done.code == 0, done.err
    report, preset = json.loads(done.out), json.loads(Path("preset.json").read_text())
    assert report["preset"] == preset
    assert set(preset) == {"steps", "thickness", "bias"}
    assert report["training"]["tuned_rmse"] <= report["training"]["rmse"]
    assert [(view["scene"], view["held_out"]) for view in report["views"]] == [("boxes", False), ("cornell", True)]
    assert package.SSAO(**preset).steps == 3


def test_the_table_ends_with_the_settings_for_render(aolab):
    out = aolab(*SMALL).out
    heads = next(line for line in out.splitlines() if line.lstrip().startswith("rmse"))
    assert heads.split() == ["rmse", "tuned", "rmse", "change", "bias", "tuned", "bias"]
    assert "--set steps=3 --set" in out.splitlines()[-1] or "worse" in out.splitlines()[-1]
