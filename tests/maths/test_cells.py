"""Cells of equal energy: they cover the map once, share its energy evenly, and end at single texels."""

import numpy as np
import pytest

from aolab.maths.cells import equal_energy_cells


@pytest.fixture
def energy() -> np.ndarray:
    return np.random.default_rng(1).random((40, 60)) ** 4


@pytest.mark.parametrize("count", [1, 2, 7, 64, 256])
def test_the_cells_cover_the_map_once(energy, count):
    covered = np.zeros(energy.shape, int)
    cells = equal_energy_cells(energy, count)
    for top, bottom, left, right in cells:
        covered[top:bottom, left:right] += 1
    np.testing.assert_array_equal(covered, 1)
    assert len(cells) == count


def test_their_energies_are_nearly_equal(energy):
    sums = [energy[top:bottom, left:right].sum() for top, bottom, left, right in equal_energy_cells(energy, 64)]
    assert sum(sums) == pytest.approx(energy.sum())
    assert max(sums) < 2.5 * min(sums)


def test_dark_parts_have_no_cell_and_a_burning_texel_has_one_of_its_own(energy):
    energy[:, :30] = 0
    energy[5, 40] = 1e9
    cells = equal_energy_cells(energy, 64)
    assert (5, 6, 40, 41) in cells
    assert len(cells) == 64  # the others are cut nevertheless
    assert all(energy[top:bottom, left:right].sum() > 0 for top, bottom, left, right in cells)


def test_fewer_texels_than_cells_and_a_dark_map():
    assert len(equal_energy_cells(np.ones((2, 3)), 256)) == 6
    assert equal_energy_cells(np.zeros((4, 4)), 256) == []


def test_narrow_rows_are_cut_across(energy):
    """Of two rows that are 100 times as wide as high, the columns are cut."""
    cells = equal_energy_cells(np.ones((2, 8)), 4, np.full(2, 100.0))
    assert cells == [(0, 2, 0, 2), (0, 2, 2, 4), (0, 2, 4, 6), (0, 2, 6, 8)]
