"""A description of the machine, which belongs to every figure of time."""

import platform
from pathlib import Path

from ..cores import cores


def describe() -> str:
    """Processor, cores that this process may use, and system: 'AMD EPYC 7R13, 2 cores, Linux'."""
    count = cores()
    return f"{_processor()}, {count} core{'s' if count > 1 else ''}, {platform.system()}"


def _processor() -> str:
    """The name of the processor; on Linux, the module `platform` does not return it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
