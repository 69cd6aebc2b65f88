"""The structure of the benchmark's results; no test has a time limit."""

import json
import math
from typing import Any

import pytest

from aolab.gl import context
from aolab.modules import MODULES
from aolab.studies import bench

SIZE = 24, 16


def is_summary(value: Any) -> bool:
    return set(value) == {"median", "spread"} and all(math.isfinite(one) and one >= 0 for one in value.values())


def test_a_summary_is_median_and_interquartile_range():
    assert bench.summary([1, 2, 3, 4, 100]) == {"median": 3, "spread": 2}


@pytest.mark.slow
def test_frames(gl, monkeypatch):
    monkeypatch.setattr(bench, "SMALL", SIZE)
    result = bench.frames("boxes", SIZE, 3)
    json.dumps(result)
    assert (result["renderer"], result["scene"], result["size"]) == (context.renderer(), "boxes", [24, 16])
    assert list(result["modules"]) == list(MODULES)
    for name, measured in result["modules"].items():
        assert {"g_buffer", name} <= set(measured["passes"])
        assert {"image", "compose"} & set(measured["passes"])
        assert all(is_summary(one) for one in measured["passes"].values())
        assert is_summary(measured["frame"])
    assert 0 < result["python_share"]["percent"]["median"] < 100
    against = result["ssao_16x1_against"]
    assert set(against["milliseconds"]) == {"ssao", "same_taps", "fixed_taps"}
    assert set(against["ratio"]) == {"same_taps", "fixed_taps"}
    assert all(one["median"] > 0 for one in against["ratio"].values())
    text = bench.table(result)
    assert f"renderer: {context.renderer()}" in text
    frame = result["modules"]["ssao"]["frame"]
    assert ["ssao", "frame", f"{frame['median']:.3f}", f"{frame['spread']:.3f}"] in map(str.split, text.splitlines())
    assert all(f"  {unit}  " in text for unit in ("milliseconds", "percent", "ratio"))


@pytest.mark.slow
def test_start_up(gl):
    result = bench.start_up(2)
    assert len(result["seconds"]) == 3
    assert all(is_summary(one) for one in result["seconds"].values())
