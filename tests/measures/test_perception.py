"""SSIM against scikit-image, FLIP against its properties."""

import sys

import flip_evaluator
import numpy as np
import pytest
from scipy.ndimage import gaussian_filter
from skimage.metrics import structural_similarity

import aolab
from aolab.measures import compare
from aolab.measures.perception import exposures, flip_map, ssim_map


@pytest.mark.parametrize("channels", [1, 3])
def test_ssim_is_that_of_scikit_image(channels):
    random = np.random.default_rng(3)
    a = gaussian_filter(random.random((48, 64, channels)), (2, 2, 0))
    b = np.clip(a + random.normal(0, 0.03, a.shape), 0, 1)
    _, expected = structural_similarity(
        a, b, data_range=1, channel_axis=2, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, full=True
    )
    assert ssim_map(a, b) == pytest.approx(expected.mean(axis=2), abs=1e-12)


def test_ssim_of_equal_pictures_is_one(noise):
    assert ssim_map(noise[..., None], noise[..., None]) == pytest.approx(1)


def test_ssim_of_constant_pictures_is_its_luminance_term():
    a, b = np.full((20, 20, 1), 0.5), np.full((20, 20, 1), 0.25)
    assert ssim_map(a, b) == pytest.approx((2 * 0.5 * 0.25 + 1e-4) / (0.5**2 + 0.25**2 + 1e-4))


@pytest.mark.parametrize("hdr", [False, True])
def test_flip_of_equal_pictures_is_zero_and_grows_with_the_difference(hdr, noise):
    picture = noise[..., None] * (5 if hdr else 1)
    assert flip_map(picture, picture, hdr=hdr).max() == 0
    little, much = (flip_map(np.minimum(picture * k, 5 if hdr else 1), picture, hdr=hdr).mean() for k in (1.02, 1.2))
    assert 0 < little < much <= 1


def test_flip_of_black_against_white_is_nearly_one():
    black, white = np.zeros((32, 32, 3)), np.ones((32, 32, 3))
    assert 0.9 < flip_map(black, white, hdr=False).mean() <= 1


def test_flip_sees_where():
    a = np.full((64, 64, 1), 0.5)
    b = a.copy()
    b[40:, 40:] = 0.9
    flip = flip_map(a, b, hdr=False)
    assert flip.shape == (64, 64)
    assert flip[44:, 44:].min() > 0.2
    assert flip[:20, :20].max() == 0


def test_exposures_are_those_of_flip(noise):
    picture = np.stack([noise, noise**2, noise**3], axis=2) * 30
    used = flip_evaluator.evaluate(picture, picture * np.float32(0.9), "HDR", applyMagma=False)[2]
    ours = exposures(picture)
    assert ours["startExposure"] == pytest.approx(used["startExposure"], abs=1e-4)
    # of an even number of pixels it takes one in the middle, we the mean of both
    assert ours["stopExposure"] == pytest.approx(used["stopExposure"], abs=2e-3)
    assert ours["numExposures"] == used["numExposures"]


def test_a_black_reference_is_compared_too():
    """flip-evaluator by itself ends the process here."""
    black, grey = np.zeros((16, 16, 3)), np.full((16, 16, 3), 0.5)
    assert flip_map(black, black, hdr=True).max() == 0
    assert flip_map(grey, black, hdr=True).min() > 0.3


def test_a_missing_package_is_named_with_the_fix(monkeypatch, noise):
    """A module that is None in `sys.modules` is not installed."""
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    found = {"visibility": noise}
    with pytest.raises(aolab.ParameterError, match=r"pip install flip-evaluator, or flip=False"):
        compare(found, found)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.delitem(sys.modules, "aolab.measures.pictures", raising=False)
    with pytest.raises(aolab.ParameterError, match="pip install matplotlib"):
        compare(found, found, flip=False).picture()


def test_a_mostly_black_reference_takes_few_exposures():
    one_light = np.zeros((16, 16, 3))
    one_light[0, 0] = 100
    assert exposures(one_light)["numExposures"] == 8
