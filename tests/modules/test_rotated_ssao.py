"""The rotated kernel's occlusion: its line of samples, its pattern, and a corner."""

import numpy as np
import pytest

import aolab
from aolab.maths.sampling import line


@pytest.mark.parametrize("seed", [0, 1, 7])
def test_the_lines_distances_are_squares_and_its_shares_fill_the_disc(seed):
    kernel = line(24, seed)
    distance = np.linalg.norm(kernel[:, :2], axis=1)
    steps = np.diff(np.sqrt(distance))
    np.testing.assert_allclose(steps, 1 / 24, rtol=1e-3)
    assert kernel[:, 2].sum() == pytest.approx(1, abs=0.1)
    # ∫ r² over the disc, as a share of its area, is 1/2
    fine = line(1024, seed)
    assert (fine[:, 2] * (fine[:, :2] ** 2).sum(axis=1)).sum() == pytest.approx(0.5, abs=0.01)


def test_the_mean_of_four_by_four_pixels_removes_the_pattern(lab, boxes):
    """The period of four pixels, in the spectrum of a row and column of the raw and of the filtered visibility."""
    frame = lab.render(boxes, "rotated_ssao", radius=1.0, size=(128, 96))
    raw, filtered = (_at_period_four(frame[name]) for name in ("visibility_raw", "visibility"))
    assert filtered < 0.1 * raw


def _at_period_four(visibility: np.ndarray) -> float:
    """The mean squared coefficient at the period of four pixels, both ways."""
    spectrum = np.abs(np.fft.fft2(np.nan_to_num(visibility, nan=1.0))) ** 2
    height, width = visibility.shape
    return float(spectrum[0, width // 4] + spectrum[height // 4, 0] + spectrum[height // 4, width // 4])


def test_a_corner_is_dark_and_the_darkness_ends_at_the_radius(lab, wall):
    frame = lab.render(wall, "rotated_ssao", radius=0.5, size=(128, 96))
    from small_scenes import world_positions

    x, y, _ = np.moveaxis(world_positions(frame, wall.camera), -1, 0)
    floor = np.abs(y) < 1e-3
    near, far = floor & (x > 0.02) & (x < 0.1), floor & (x > 0.6)
    assert frame["visibility"][near].mean() < 0.8
    np.testing.assert_array_equal(frame["visibility_raw"][far], 1.0)


def test_strength_scales_the_occlusion(lab, wall):
    settings = {"radius": 0.5, "filter": "none"}
    one, two = (1 - lab.render(wall, "rotated_ssao", strength=s, **settings)["visibility"] for s in (0.5, 1.0))
    np.testing.assert_allclose(np.nan_to_num(two), np.nan_to_num(2 * one), atol=2e-3)


def test_its_rays_have_its_radius(boxes):
    question = aolab.modules.RotatedSSAO(radius=0.7).question()  # pyright: ignore[reportAttributeAccessIssue]
    assert (question.radius, question.falloff) == (0.7, 0.0)
