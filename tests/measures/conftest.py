"""A cache of each test's own, and pictures to compare."""

import numpy as np
import pytest


@pytest.fixture(autouse=True)
def cache_folder(tmp_path, monkeypatch):
    """Nothing that a test computes reaches another, or the user's cache."""
    monkeypatch.setenv("AOLAB_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def noise() -> np.ndarray:
    """(40, 56) float32 in [0.2, 0.8]."""
    return np.random.default_rng(1).uniform(0.2, 0.8, (40, 56)).astype(np.float32)
