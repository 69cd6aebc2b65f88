"""The rotated kernel's occlusion: its line of samples, its pattern, and a corner."""

import numpy as np
import pytest

import aolab
from aolab.maths.sampling import line_start


@pytest.mark.parametrize("seed", [0, 1, 7])
def test_the_lines_of_a_block_fill_the_disc_evenly(glsl, seed):
    """24 samples on each of the 16 lines: distances x² for even x, shares of the disc, and moments of a full disc."""
    sets, samples = np.repeat(np.arange(16), 24), np.tile(np.arange(24), 16)
    xyz = glsl(
        "lib/line.glsl",
        "result.xyz = onLine(lineOf(int(x.x), start.xyz), int(x.y), 24);",
        np.stack([sets, samples, sets, sets], axis=1),
        start=(*line_start(seed).tolist(), 0.0),
    )
    place, share = xyz[:, :2], xyz[:, 2]
    x = np.sqrt(np.linalg.norm(place, axis=1)).reshape(16, 24)
    np.testing.assert_allclose(np.diff(x, axis=1), 1 / 24, rtol=1e-3)
    np.testing.assert_allclose(np.diff(np.sort(x.ravel())), 1 / (16 * 24), rtol=0.02)  # all 384 distances differ
    assert share.sum() / 16 == pytest.approx(1, abs=2e-3)
    squared = (place**2).sum(axis=1)
    assert (share * squared).sum() / 16 == pytest.approx(1 / 2, abs=2e-3)
    second = (share[:, None, None] * place[:, :, None] * place[:, None, :]).sum(axis=0) / 16
    np.testing.assert_allclose(second, np.eye(2) / 4, atol=0.01)
    np.testing.assert_allclose((share[:, None] * place).sum(axis=0) / 16, 0, atol=0.01)


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


@pytest.mark.filterwarnings("ignore::aolab.Notice")  # the floor is not closed
@pytest.mark.parametrize("occluders", ["depth", "layers"])
def test_a_lower_resolution_does_not_darken(lab, boxes, occluders):
    """Peeled layers are as fine as the image, so that a coarse pixel's centre is on no layer's centre."""
    fine, coarse = (
        np.nanmean(lab.render(boxes, "rotated_ssao", radius=1.0, occluders=occluders, scale=scale)["visibility"])
        for scale in (1.0, 0.5)
    )
    assert fine - 0.01 < coarse < fine + 0.03
