"""Ctrl-C in a reference: the work that is under way ends after its next rays."""

import threading

import pytest

from aolab.truth import tracing


def test_the_work_under_way_ends(monkeypatch):
    monkeypatch.setattr(tracing, "cores", lambda: 2)
    stop, ended = threading.Event(), []

    def work(start: int, advance: tracing.Advance) -> None:
        if start == 0:
            raise KeyboardInterrupt
        ended.append(stop.wait(60))

    with pytest.raises(KeyboardInterrupt):
        tracing._run(work, 2 * tracing.CHUNK, False, "a test", stop)
    assert stop.is_set()
    assert all(ended)
