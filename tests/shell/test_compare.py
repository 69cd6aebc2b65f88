"""`aolab compare`: a line for each module, the sheet, and refusals before the work."""

import json
import sys
from pathlib import Path

import pytest

SMALL = ("compare", "boxes", "--size", "48x32", "--rays", "4")


def test_a_line_for_each_module_and_a_sheet(aolab):
    done = aolab(*SMALL, "--modules", "none, ssao?steps=3", "-o", "sheet.png")
    assert done.code == 0, done.err
    head, *lines = done.out.splitlines()
    assert head.split() == ["visibility", "rmse", "bias", "p99", "ssim", "flip", "frame", "ms"]
    assert [line.split()[:2] for line in lines] == [["ssao", "steps=3"], ["none", lines[1].split()[1]]]
    assert Path("sheet.png").read_bytes().startswith(b"\x89PNG")


def test_as_json(aolab):
    done = aolab(*SMALL, "--modules", "none,ssao?steps=3", "--buffer", "ambient", "--no-flip", "--json")
    found = json.loads(done.out)
    assert {entry["label"] for entry in found} == {"ssao steps=3", "none"}
    assert all(entry["buffers"]["ambient"]["all"]["rmse"] > 0 for entry in found)
    assert all(entry["buffers"]["ambient"]["all"]["flip"] is None for entry in found)
    assert all(entry["rays"] == 4 and entry["renderer"] for entry in found)


def test_errors_under_a_turning_environment(aolab):
    done = aolab(*SMALL, "--modules", "none,ssdo", "--relight", "2")
    assert done.code == 0, done.err
    head, *lines = done.out.splitlines()
    assert head.split() == ["ambient,", "2", "rotations", "rmse", "relative", "worst", "at"]
    assert {line.split()[0] for line in lines} == {"none", "ssdo"}
    assert all(line.endswith("°") for line in lines)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("-o", "sheet.jpg"), "sheet.jpg: images are written as .png"),
        (("-o", "nowhere/sheet.png"), "does not exist"),
        (("--modules", "ssao?directions"), "write NAME?KEY=VALUE&KEY=VALUE"),
        (("--modules", "ssao?steps=1&steps=2"), "parameter 'steps' is given twice"),
    ],
)
def test_refusals_come_before_the_work(aolab, monkeypatch, options, message):
    monkeypatch.setattr("aolab.studies.ranking.compare_modules", lambda *_, **__: pytest.fail("compared first"))
    done = aolab(*SMALL, *options)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert message in done.err


def test_a_missing_library_is_named_before_rays_are_traced(aolab, monkeypatch):
    monkeypatch.setattr("aolab.studies.ranking.reference", lambda *_, **__: pytest.fail("traced first"))
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    assert "pip install flip-evaluator, or flip=False (--no-flip in the shell)" in aolab(*SMALL).err
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert "pip install matplotlib, or leave out -o" in aolab(*SMALL, "--no-flip", "-o", "a.png").err
