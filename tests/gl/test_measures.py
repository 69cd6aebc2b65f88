"""The fuzzy measures in GLSL against their NumPy twins, and a measure of one's own, by tables."""

import numpy as np
import pytest

from aolab import ParameterError
from aolab.gl import texture
from aolab.gl.bindings import Bindings
from aolab.gl.program import Programs
from aolab.gl.texture import Pool
from aolab.maths.fading import CURVES
from aolab.modules.measures import MEASURES, Exponential, Measure
from aolab.modules.passes import Pass
from aolab.pipeline.pass_runner import PassRunner

SHADER = """#include "measure.glsl"
uniform sampler2D rows;
uniform float measure_farthest;
out vec4 value;
void main() {
    float x = texelFetch(rows, ivec2(gl_FragCoord.xy), 0).r;
    value = vec4(measureOpenness(x), measureDensity(x), measureInverse(x), measure_farthest);
}
"""


class Smooth(Measure):
    name = "smooth"

    def openness(self, distance):
        return distance**2 * (3 - 2 * distance)


EVERY = [*(measure() for measure in MEASURES.values()), Exponential(sigma=0.7), Smooth()]


def evaluated(measure: Measure, x: np.ndarray) -> np.ndarray:
    """(n, 4): openness, density and inverse of `x` (n,) by the shader, and the farthest distance."""
    runner = PassRunner(Programs(), Pool())
    size = len(x), 1
    rows = Bindings("the test", {"rows": texture.make(size, "R32F", x.astype("f4").tobytes())})
    made = runner.run(Pass("measure", SHADER, {"value": "RGBA32F"}), [rows, measure.bindings()], size)
    return texture.read(made["value"])[0]


@pytest.mark.parametrize("measure", EVERY, ids=lambda measure: measure.name)
def test_glsl_and_numpy_agree(gl, measure):
    x = np.linspace(0.01, 0.99, 99) + 1e-3
    found = evaluated(measure, x)
    by_table = isinstance(measure, Smooth)  # 128 linear pieces, of the inverse in particular
    for column, expected in enumerate((measure.openness(x), measure.density(x), measure.inverse(x))):
        np.testing.assert_allclose(found[:, column], expected, atol=4e-3 if by_table else 1e-5, rtol=1e-5)
    assert found[0, 3] == pytest.approx(measure.farthest, rel=1e-5)


@pytest.mark.parametrize("measure", EVERY, ids=lambda measure: measure.name)
def test_beyond_the_radius_all_is_open_but_for_the_exponential(gl, measure):
    beyond = np.array([1.0, 1.5, 3.0])
    expected = 1 - np.exp(-measure.sigma * beyond) if isinstance(measure, Exponential) else 1.0
    np.testing.assert_allclose(evaluated(measure, beyond)[:, 0], expected, atol=1e-6)
    np.testing.assert_allclose(evaluated(measure, beyond + 1)[:, 1] > 0, isinstance(measure, Exponential))


@pytest.mark.parametrize("measure", EVERY, ids=lambda measure: measure.name)
def test_distances_of_uniform_shares_have_the_density(measure):
    """The share of the samples nearer than d is μ(d)."""
    distances = measure.inverse((np.arange(20_000) + 0.5) / 20_000)
    assert distances.max() <= measure.farthest
    for d in (0.2, 0.5, 0.9):
        assert (distances < d).mean() == pytest.approx(float(measure.openness(np.array([d]))[0]), abs=1e-3)


@pytest.mark.parametrize("measure", [one for one in EVERY if one.name != "classical"], ids=lambda one: one.name)
def test_the_density_is_the_derivative(measure):
    d = np.linspace(0.05, 0.95, 19) + 1e-3
    slope = (measure.openness(d + 1e-4) - measure.openness(d - 1e-4)) / 2e-4
    np.testing.assert_allclose(measure.density(d), slope, atol=0.02)


def test_the_registry_has_the_curves_of_figure_1():
    assert [*MEASURES] == ["classical", "linear", "sqrt", "exponential"]
    assert {measure().fading for measure in MEASURES.values()} <= {*CURVES}


@pytest.mark.parametrize(
    ("openness", "shown"),
    [
        (lambda d: 1 - d, "1 to 0"),
        (lambda d: d / 2, "0 to 0.5"),
        (lambda d: np.sin(np.pi * 2.5 * d), "0 to 1"),
        (lambda d: d[:3], r"an array \(3,\)"),
    ],
)
def test_a_measure_that_does_not_grow_from_0_to_1_is_refused(openness, shown):
    own = type("Own", (Measure,), {"name": "own", "openness": lambda self, distance: openness(distance)})
    with pytest.raises(ParameterError, match=rf"measure='own': openness\(distance\) is {shown}; it must grow from 0"):
        own().bindings()


def test_a_measure_without_openness_is_refused():
    with pytest.raises(NotImplementedError, match="'bare' has no method"):
        type("Bare", (Measure,), {"name": "bare"})().bindings()
