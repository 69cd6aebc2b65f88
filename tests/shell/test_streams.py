"""Standard output and signals: full devices, closed pipes, poor encodings and interrupts end in at most one line."""

import os
import signal
import stat
import subprocess
import sys
import time

import pytest

pytestmark = pytest.mark.slow

COMMAND = [sys.executable, "-m", "aolab.shell.cli"]
posix = pytest.mark.skipif(os.name != "posix", reason="devices and signals of POSIX")


def run(line: str, **options) -> subprocess.CompletedProcess[str]:
    options = {"stdout": subprocess.PIPE, **options}
    return subprocess.run([*COMMAND, *line.split()], stderr=subprocess.PIPE, text=True, timeout=120, **options)


@posix
def test_a_full_device_is_one_line(full_device):
    with open(full_device, "w") as full:
        done = run("modules ssao", stdout=full)
    assert (done.returncode, done.stderr) == (2, "aolab: cannot write to standard output: No space left on device\n")


@posix
def test_a_reader_that_has_ended_gets_no_message():
    reader, writer = os.pipe()
    os.close(reader)
    try:
        assert run("modules ssao", stdout=writer).stderr == ""
    finally:
        os.close(writer)


def test_a_terminal_without_the_characters_gets_plain_ones():
    done = run("modules ssao", env={**os.environ, "PYTHONIOENCODING": "ascii"})
    assert (done.returncode, done.stderr) == (0, "")
    assert "directions = 8  (int, >= 1, <= 256)" in done.stdout
    done = run("render boxes --set directions=0", env={**os.environ, "PYTHONIOENCODING": "ascii"})
    assert "int, >= 1, <= 256" in done.stderr


@posix
@pytest.mark.parametrize("phase", ["starting", "importing", "rendering"])
def test_an_interrupt_is_one_line(phase, tmp_path):
    """The process announces, through a hook of its imports, that the phase has begun."""
    wanted = {"starting": "lazy_loader", "importing": "typer.main", "rendering": "aolab.pipeline.shadows"}[phase]
    program = f"""
import sys

class Announce:
    def find_spec(self, name, path=None, target=None):
        if name == {wanted!r}:
            print("now", flush=True)
            import time
            time.sleep(0.5)

sys.meta_path.insert(0, Announce())
sys.argv = ["aolab", "render", "boxes", "--size", "64x36", "--accumulate", "500"]
from aolab_command import main
main()
"""
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "now\n"
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert errors == "aolab: interrupted\n"
    assert process.returncode == 130
    assert list(tmp_path.iterdir()) == []


@posix
def test_statistics_go_through_to_devices(tmp_path, full_device):
    full = run(f"render boxes --size 16x9 --stats {full_device}", cwd=tmp_path)
    assert (full.returncode, full.stderr) == (2, f"aolab: cannot write {full_device}: No space left on device\n")
    assert stat.S_ISCHR(os.lstat(full_device).st_mode)
    (tmp_path / "stdout").symlink_to("/dev/stdout")
    done = run("render boxes --size 16x9 --stats stdout", cwd=tmp_path)
    assert done.stdout.startswith("{\n")
    assert done.stdout.endswith("}\nout.png\n")
