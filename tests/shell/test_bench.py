"""`aolab bench`: numbers with units, and the curve of error against time with its files."""

import json
import sys
from pathlib import Path

import pytest
from PIL import Image

from aolab.modules import MODULES
from aolab.modules.filters import FILTERS

SIZE = (64, 36)
SMALL = ("--size", "64x36", "--rays", "8", "--frames", "3")


def test_times_have_units(aolab):
    out = aolab("bench", "--size", "24x16", "--frames", "3").out
    assert "medians of 3 frames; ± is the interquartile range" in out
    assert all(f"  {unit}" in out for unit in ("milliseconds", "percent", "ratio"))
    assert "renderer: " in out


def test_quality_writes_a_picture_and_the_data_beside_it(aolab, tmp_path, monkeypatch):
    monkeypatch.setattr("aolab.studies.quality.MODULES", {name: MODULES[name] for name in ("none", "ssao")})
    monkeypatch.setattr("aolab.studies.quality.FACTORS", {"directions": (0.5, 1), "steps": (1,)})
    done = aolab("bench", "--quality", "boxes", *SMALL, "-o", "curve.png")
    assert done.code == 0, done.err
    with Image.open("curve.png") as picture:
        assert picture.width > 1000
    assert sorted(path.name for path in tmp_path.iterdir()) == ["curve.json", "curve.png"]
    data = json.loads(Path("curve.json").read_text())
    assert {"renderer", "machine", "radius", "rays", "truth_standard_error"} <= set(data)
    assert (data["scene"], data["size"], data["frames"]) == ("boxes", list(SIZE), 3)
    assert {point["module"] for point in data["points"]} == {"none", "ssao"}
    assert len(data["points"]) == 1 + 2 * len(FILTERS)  # two numbers of directions with each filter; and `none`
    for text in (data["renderer"], data["machine"], "ssao 8×4 box4, default"):
        assert text in done.out


def test_quality_refuses_before_the_work(aolab, tmp_path, monkeypatch):
    monkeypatch.setattr("aolab.studies.quality.curve", lambda *_, **__: pytest.fail("measured before it was refused"))
    quality = ("bench", "--quality", "boxes", *SMALL, "-o")
    assert "curve.svg: images are written as .png" in aolab(*quality, "curve.svg").err
    assert "does not exist" in aolab(*quality, "nowhere/curve.png").err
    (tmp_path / "curve.json").mkdir()
    assert "curve.json: it is a folder" in aolab(*quality, "curve.png").err
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert "pip install matplotlib" in aolab(*quality, "other.png").err
