"""Relighting error: the turned light, the numbers, and the messages."""

import json
import math
import sys

import numpy as np
import pytest

import aolab
from aolab.measures import relight, relighting_error
from aolab.shell import cli

SUN = aolab.Environment.sky(sun_direction=(1, 1, 0))


def towards(light: aolab.Environment):
    """A stand-in for a render: the irradiance on surfaces that face +x, -x, +z and -z."""
    normals = np.array([[[1, 0, 0], [-1, 0, 0]], [[0, 0, 1], [0, 0, -1]]])
    return {"ambient": light.irradiance(normals).astype(np.float32)}


def grey(light: aolab.Environment):
    """A result without direction: the mean of the other."""
    values = towards(light)["ambient"]
    return {"ambient": np.broadcast_to(values.mean(axis=(0, 1)), values.shape)}


def test_the_truth_has_no_error():
    found = relight(towards, towards, SUN, k=4)
    assert found.degrees == [0, 90, 180, 270]
    assert found.rmse == 0


def test_a_result_without_direction_errs_alike_under_every_quarter_turn():
    found = relight(grey, towards, SUN, k=4)
    errors = [one.rmse for one in found.measures]
    assert errors == pytest.approx([errors[0]] * 4, rel=1e-4)
    assert found.rmse == pytest.approx(errors[0], rel=1e-4)
    assert all(0 < relative < 1 for relative in found.relative)


def test_a_light_baked_in_errs_when_turned():
    baked = towards(SUN)
    found = relight(lambda light: baked, towards, SUN, k=4)
    assert found.measures[0].rmse == 0
    assert found.worst == 2  # the sun has gone to the other side
    assert found.rmse == pytest.approx(math.sqrt(sum(one.rmse**2 for one in found.measures) / 4))


def test_prints_and_goes_to_json():
    found = relight(grey, towards, SUN, k=2)
    read = json.loads(found.to_json())
    assert [one["degrees"] for one in read["rotations"]] == [0, 180]
    assert read["rmse"] == pytest.approx(found.rmse)
    assert "under 2 rotations" in str(found)
    assert len(str(found).splitlines()) == 5


def test_a_light_that_is_the_same_all_around_is_refused():
    with pytest.raises(aolab.ParameterError, match="'constant' is the same all around: turning it 4 times"):
        relight(towards, towards, aolab.Environment.constant(1.0), k=4)
    assert relight(towards, towards, aolab.Environment.constant(1.0), k=1).rmse == 0
    with pytest.raises(aolab.ParameterError, match="k = 0"):
        relight(towards, towards, SUN, k=0)


def test_a_module_errs_less_the_more_of_the_light_it_takes_into_account(boxes):
    """Red light from one side, blue from the other. Measured: none 0.037, grey occlusion 0.020, directional 0.013."""
    radiance = np.zeros((32, 64, 3), np.float32)
    radiance[:, 32:, 0] = radiance[:, :32, 2] = 1
    options = {"k": 2, "environment": aolab.Environment(radiance), "size": (48, 32), "rays": 256}
    marched = {"radius": 1.0, "directions": 16, "steps": 8}
    none = relighting_error(boxes, "none", like=aolab.SSAO(radius=1.0), **options)
    grey, directional = (relighting_error(boxes, name, **marched, **options) for name in ("ssao", "ssdo"))
    for turn in range(2):
        errors = [found.measures[turn].rmse for found in (none, grey, directional)]
        assert errors[0] > 1.5 * errors[1]
        assert errors[1] > 1.3 * errors[2]
    assert none.rmse < 0.05


def test_the_shell_lists_modules_best_first_with_one_truth(gl, monkeypatch, capsys, tmp_path):
    monkeypatch.setenv("AOLAB_CACHE", str(tmp_path))
    small = ["--size", "48x27", "--rays", "8", "--relight", "2"]

    def lines(*more: str) -> list[list[str]]:
        assert shell(monkeypatch, "compare", "boxes", *small, *more) == 0
        return [line.split() for line in capsys.readouterr().out.splitlines()[1:]]

    found = lines("--modules", "none,s3ho,ssao")
    assert {row[0] for row in found} == {"none", "s3ho", "ssao"}
    errors = [float(row[1]) for row in found]
    assert errors == sorted(errors)
    assert found[-1][0] == "none"
    assert lines("--modules", "ssao", "--radius", "0.1") != lines("--modules", "ssao", "--radius", "1.0")
    assert shell(monkeypatch, "compare", "boxes", *small, "--modules", "ssao", "--json") == 0
    (one,) = json.loads(capsys.readouterr().out)
    assert one["module"] == "ssao"
    assert len(one["rotations"]) == 2


def test_the_shell_refuses_what_relighting_does_not_take(monkeypatch, capsys):
    assert shell(monkeypatch, "compare", "boxes", "--relight", "2", "--buffer", "sh0") == 2
    assert "--relight prints errors of ambient light: it takes no -o and no --buffer" in capsys.readouterr().err


def shell(monkeypatch, *arguments: str) -> object:
    monkeypatch.setattr(sys, "argv", ["aolab", *arguments])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    return ended.value.code or 0
