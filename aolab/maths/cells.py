"""Cells of equal energy: a map cut into rectangles, each with about the same sum."""

import heapq
from itertools import count as numbers

import numpy as np

Cell = tuple[int, int, int, int]  # rows from, to; columns from, to (the ends excluded)


def equal_energy_cells(energy: np.ndarray, count: int, widths: np.ndarray | None = None) -> list[Cell]:
    """Up to `count` rectangles that cover all energy of the map (H, W), which is nowhere negative.

    The median cut (Debevec 2005): the cell with the most energy is cut across its longer side, where both halves have
    most nearly the same energy, until there are enough. A summed-area table gives the energy of each. `widths` (H,) are
    the widths of the rows' texels, in heights; 1 by default. Cells without energy are left out, and a cell of a texel
    is not cut, however bright it is.
    """
    height, width = energy.shape
    table = np.zeros((height + 1, width + 1))
    table[1:, 1:] = energy.cumsum(axis=0, dtype=np.float64).cumsum(axis=1)
    widths = np.ones(height) if widths is None else widths

    def inside(cell: Cell) -> float:
        top, bottom, left, right = cell
        return table[bottom, right] - table[top, right] - table[bottom, left] + table[top, left]

    order, done = numbers(), []
    whole: Cell = (0, height, 0, width)
    waiting: list[tuple[float, int, Cell]] = [(-inside(whole), next(order), whole)]
    while waiting and len(waiting) + len(done) < count:
        _, _, cell = heapq.heappop(waiting)
        parts = _halves(table, cell, widths)
        if len(parts) == 1:
            done.append(cell)
            continue
        for part in parts:
            if inside(part) > 0:
                heapq.heappush(waiting, (-inside(part), next(order), part))
    cells = [*done, *(cell for _, _, cell in waiting)]
    return sorted(cell for cell in cells if inside(cell) > 0)


def _halves(table: np.ndarray, cell: Cell, widths: np.ndarray) -> list[Cell]:
    """The cell's halves of nearly the same energy; the cell itself if it is one texel."""
    top, bottom, left, right = cell
    across = (right - left) * widths[top:bottom].max()
    if right - left > 1 and (across >= bottom - top or bottom - top == 1):
        sums = table[bottom, left : right + 1] - table[top, left : right + 1]
        middle = left + _median(sums)
        return [(top, bottom, left, middle), (top, bottom, middle, right)]
    if bottom - top > 1:
        sums = table[top : bottom + 1, right] - table[top : bottom + 1, left]
        middle = top + _median(sums)
        return [(top, middle, left, right), (middle, bottom, left, right)]
    return [cell]


def _median(sums: np.ndarray) -> int:
    """Where running sums reach the middle of their ends most nearly, but not at an end."""
    return 1 + int(np.abs(sums[1:-1] - (sums[0] + sums[-1]) / 2).argmin())
