"""A cache of each test's own."""

import pytest


@pytest.fixture(autouse=True)
def cache_folder(tmp_path, monkeypatch):
    """Nothing that a test computes reaches another, or the user's cache."""
    monkeypatch.setenv("AOLAB_CACHE", str(tmp_path / "cache"))
