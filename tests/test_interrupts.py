"""Ctrl-C while a library is imported, on the shell and in cells of a notebook."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timers on Windows")

GREEDY = """
import time
try:
    print("now", flush=True)
    time.sleep({seconds})
except BaseException:
    print("swallowed", flush=True)
"""
ON_THE_SHELL = """
import signal, time
from aolab.interrupts import after_imports
try:
    with after_imports():
        import greedy
        time.sleep(20)
except KeyboardInterrupt:
    print("interrupted", flush=True)
assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
"""
IN_CELLS = """
import signal
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
shell.showtraceback = lambda *_, **__: print("raised", flush=True)
shell.run_cell("import aolab")
done = shell.run_cell("import time, greedy; time.sleep(20)")
print("interrupted" if isinstance(done.error_in_exec, KeyboardInterrupt) else done.error_in_exec)
assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
"""


def interrupted(program: str, folder: Path, seconds: float) -> str:
    """The text that a program prints after an interrupt while it imports `greedy` from the folder."""
    folder.mkdir()
    (folder / "greedy.py").write_text(GREEDY.format(seconds=seconds))
    found = f"import sys; sys.path.insert(0, {str(folder)!r})\n"
    process = subprocess.Popen([sys.executable, "-c", found + program], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "now\n"
    process.send_signal(signal.SIGINT)
    printed = process.communicate(timeout=15)[0]
    assert process.returncode == 0
    return printed


@pytest.mark.parametrize(("program", "printed"), [(ON_THE_SHELL, "interrupted\n"), (IN_CELLS, "raised\ninterrupted\n")])
def test_an_interrupt_waits_for_the_end_of_an_import(program, printed, tmp_path):
    """A library may swallow every exception in its import, as trimesh does, and the interrupt with them."""
    assert interrupted(program, tmp_path / "site-packages", 0.5) == printed


def test_an_interrupt_ends_the_import_of_a_file_of_ones_own_at_once(tmp_path):
    """Its statements may compute for hours; this one swallows the interrupt by itself, and sleeps on in the program."""
    program = ON_THE_SHELL.replace("time.sleep(20)", "print('went on')")
    assert interrupted(program, tmp_path / "mine", 60) == "swallowed\nwent on\n"
