"""Numbers that can be worked out by hand."""

import math

import numpy as np
import pytest
from skimage.metrics import peak_signal_noise_ratio

from aolab.measures.metrics import angles, differences, psnr


def test_differences_by_hand():
    found = differences(np.array([[0.0, 3.0], [-4.0, 5.0]]))
    assert found["rmse"] == pytest.approx(math.sqrt((9 + 16 + 25) / 4))
    assert found["bias"] == pytest.approx(1.0)
    assert found["mae"] == pytest.approx(3.0)
    assert found["maximum"] == 5.0


def test_outliers_are_told_from_the_rest():
    """One pixel in a hundred errs by 10, the others by 0.1: it makes 99 % of the squares."""
    difference = np.full((300, 3), 0.1)
    difference[:3] = -10.0
    found = differences(difference)
    assert found["trimmed"] == pytest.approx(0.1)
    assert found["outliers"] == pytest.approx(300 / (300 + 297 * 0.01))
    assert found["rmse"] == pytest.approx(math.sqrt((300 + 2.97) / 300))
    assert differences(np.zeros(5))["outliers"] == 0
    assert math.isnan(differences(np.ones(1))["trimmed"])


def test_even_errors_have_no_outliers():
    found = differences(np.full(1000, 0.3))
    assert found["trimmed"] == found["rmse"] == pytest.approx(0.3)
    assert found["outliers"] == pytest.approx(0.01)


def test_percentiles_are_of_magnitudes():
    found = differences(-np.arange(101.0))
    assert (found["p50"], found["p90"], found["p99"]) == pytest.approx((50, 90, 99))


def test_sums_do_not_lose_digits():
    """A float32 sum over a megapixel would: the bias is one in a million."""
    assert differences(np.full((1000, 1000), 1e-6, np.float32))["bias"] == pytest.approx(1e-6, rel=1e-5)


def test_psnr_by_hand_and_against_scikit_image(noise):
    assert psnr(np.full((3, 3), 0.1)) == pytest.approx(20)
    assert psnr(np.zeros((3, 3))) == math.inf
    other = np.clip(noise + 0.1 * np.sin(np.arange(56)), 0, 1).astype(np.float32)
    assert psnr(noise - other) == pytest.approx(peak_signal_noise_ratio(noise, other, data_range=1))


def test_angles_by_hand():
    x, y = np.array([2.0, 0, 0]), np.array([0, 0.5, 0])
    assert angles(x, y) == pytest.approx(90)
    assert angles(x, -x) == pytest.approx(180)
    assert angles(x, x + y) == pytest.approx(math.degrees(math.atan(0.25)))
    assert np.isnan(angles(x, 0 * x))


def test_small_angles_survive_single_precision():
    """An arc cosine would answer 0 for these."""
    tilt = 1e-4
    a, b = np.float32([0, 0, 1]), np.float32([math.sin(tilt), 0, math.cos(tilt)])
    assert angles(a, b) == pytest.approx(math.degrees(tilt), rel=1e-5)
