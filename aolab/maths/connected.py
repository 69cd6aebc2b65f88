"""The connected components of a graph."""

import numpy as np


def connected(count: int, edges: np.ndarray) -> np.ndarray:
    """(count,): for each point the least index in its component; `edges` (E, 2). Labels spread until none changes."""
    label = np.arange(count)
    while True:
        before = label.copy()
        np.minimum.at(label, edges[:, 0], before[edges[:, 1]])
        np.minimum.at(label, edges[:, 1], before[edges[:, 0]])
        label = label[label]  # pointer jumping: fewer rounds
        if (label == before).all():
            return label
