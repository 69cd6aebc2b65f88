"""Pictures to compare."""

import numpy as np
import pytest


@pytest.fixture
def noise() -> np.ndarray:
    """(40, 56) float32 in [0.2, 0.8]."""
    return np.random.default_rng(1).uniform(0.2, 0.8, (40, 56)).astype(np.float32)
