"""Damaged files of all kinds: each is loaded, or refused in its own words. `make fuzz`."""

import subprocess
import sys

import fuzzed
import pytest

SEEDS = 50


@pytest.mark.fuzz
@pytest.mark.slow
@pytest.mark.parametrize("kind", fuzzed.KINDS)
def test_damaged_files(kind):
    """In a process of its own, for a decoder may end it."""
    for package in {"glb draco": ["DracoPy"], "glb meshopt": ["meshopt"]}.get(kind, []):
        pytest.importorskip(package, reason="an extra")
    command = [sys.executable, fuzzed.__file__, kind, "0", str(SEEDS)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    last = (done.stdout.split() or ["none"])[-1]
    assert done.returncode == 0, f"seed {last} ended the process: {done.stderr[-500:]}"
    # OpenEXR prints remarks of its own
    assert [line for line in done.stderr.splitlines() if "EXR_ERR" not in line] == []
