"""The growth of a frame's time: its structure and its fits; no test has a time limit."""

import json
import math

import pytest

from aolab.studies import scaling


@pytest.mark.figures
def test_scaling(gl):
    result = scaling.scaling((40, 20), 2)
    json.dumps(result)
    growth = {what: list(found["milliseconds"]) for what, found in result["growth"].items()}
    assert list(growth) == ["pixels", "taps", "triangles", "lights", "layers", "views"]
    assert growth["pixels"] == [10 * 5, 13 * 6, 20 * 10, 40 * 20]
    assert growth["taps"] == [16, 32, 64, 128]
    assert growth["triangles"] == sorted(growth["triangles"])
    assert growth["triangles"][-1] > 4 * growth["triangles"][0]
    for what, found in result["growth"].items():
        parts = {"g_buffer", "estimate", "filter", "lighting", "frame"}
        assert set(found["exponents"]) == parts | ({"occluders"} if what in {"layers", "views"} else set())
        assert all(math.isfinite(one) for one in found["exponents"].values())
        for cost in found["milliseconds"].values():
            assert 0 < sum(cost[part] for part in cost if part != "frame") <= cost["frame"]
    text = scaling.table(result)
    assert text.count("exponent ") == 6
    assert "g_buffer, ms" in text
    from aolab.studies.scaling_picture import draw

    assert len(draw(result).axes) == 6


def test_a_power_law_is_fitted_exactly():
    costs = {x: {"linear": 0.5 * x, "flat": 3.0, "square": 1e-3 * x * x, "nothing": 0.0} for x in (10, 20, 50, 80)}
    exponents = scaling.fitted(costs)["exponents"]
    assert exponents == pytest.approx({"linear": 1, "flat": 0, "square": 2})
