"""Progress of long work: a bar in a terminal, a line now and then in a log, nothing for short work."""

import io
import os
import re
import select
import sys

import pytest

from aolab import progress


class Stream(io.StringIO):
    """Standard error that is a terminal or not."""

    def __init__(self, terminal: bool) -> None:
        super().__init__()
        self.terminal = terminal

    def isatty(self) -> bool:
        return self.terminal


@pytest.fixture
def written(monkeypatch):
    """The text that four steps write: `written(terminal=False)`."""
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)  # tests of notebooks import it into this process

    def run(terminal: bool, **options) -> str:
        stream = Stream(terminal)
        monkeypatch.setattr("sys.stderr", stream)
        with progress.progress_bar("reference", 4, "px", **options) as bar:
            for _ in range(4):
                bar.update()
        return stream.getvalue()

    return run


def test_a_terminal_gets_a_bar_with_the_time_left(written):
    text = written(terminal=True, mininterval=0)
    assert re.search(r"\rreference: +50%\|.*\| 2/4 \[00:00<00:00, .*px/s\]", text)
    assert text.rsplit("\r", 2)[1].strip() == ""  # in the end it is removed


def test_a_line_stands_above_the_bar(monkeypatch):
    """The bar is removed, the line is written, and the bar is drawn below it."""
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.setattr("sys.stderr", stream := Stream(terminal=True))
    with progress.progress_bar("reference", 4) as bar:
        bar.update()
        progress.write_line("a note", stream)
    assert re.search(r"\r +\ra note\n\rreference: +25%", stream.getvalue())


def test_a_log_gets_the_line_alone(monkeypatch):
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    monkeypatch.setattr("sys.stderr", stream := Stream(terminal=False))
    with progress.progress_bar("reference", 4) as bar:
        bar.update()
        progress.write_line("a note", stream)
    assert stream.getvalue() == "a note\n"


@pytest.mark.skipif(sys.platform == "win32", reason="pseudoterminals")
def test_a_bar_leaves_room_for_the_mark_of_an_interrupt(monkeypatch):
    """A terminal shows ^C behind the bar; on a full line it would go to the next one, and the bar would stay."""
    import fcntl
    import pty
    import struct
    import termios

    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 50, 0, 0))
    with open(theirs, "w") as stream:
        monkeypatch.setattr("sys.stderr", stream)
        with progress.progress_bar("reference", 4, shown=True) as bar:
            assert len(str(bar)) <= 50 - len("^C")
    os.close(ours)


def test_a_log_gets_no_line_for_short_work(written):
    assert written(terminal=False) == ""


def test_a_log_gets_lines_for_long_work(written, monkeypatch):
    monkeypatch.setattr(progress, "LOG_EVERY", 0.0)
    lines = written(terminal=False).splitlines()
    assert "\r" not in "".join(lines)
    assert lines[1] == "reference: 25 %, 00:00 elapsed, 00:00 left"
    assert lines[-1].startswith("reference: 100 %")


def test_it_can_be_forced_and_forbidden(written, monkeypatch):
    assert written(terminal=True, shown=False) == ""
    with monkeypatch.context() as patch:
        patch.setenv("TQDM_DISABLE", "1")
        assert written(terminal=True) == ""
    assert "4/4" in written(terminal=False, shown=True, mininterval=0)


def test_a_notebook_gets_a_widget(monkeypatch):
    """Without ipykernel's front end the widget writes text; the class is what counts."""
    pytest.importorskip("ipywidgets")
    import sys
    import types

    monkeypatch.setitem(sys.modules, "ipykernel", types.ModuleType("ipykernel"))
    from tqdm.auto import tqdm

    monkeypatch.setattr("sys.stderr", Stream(False))
    with progress.progress_bar("reference", 4) as bar:
        assert isinstance(bar, tqdm)


def test_without_standard_error_nothing_fails(monkeypatch):
    monkeypatch.setattr("sys.stderr", None)
    with progress.progress_bar("reference", 4) as bar:
        bar.update(4)


@pytest.mark.skipif(sys.platform == "win32", reason="pseudoterminals")
def test_a_terminal_that_reports_no_size_gets_a_bar(monkeypatch):
    import pty

    ours, theirs = pty.openpty()  # 0 columns, as of a container without a window
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with open(theirs, "w") as stream:
        monkeypatch.setattr("sys.stderr", stream)
        with progress.progress_bar("reference", 4, mininterval=0) as bar:
            bar.update()
            assert select.select([ours], [], [], 5)[0], "no bar within five seconds"
            assert b"reference: " in os.read(ours, 10_000)
    os.close(ours)
