"""A description of the machine, which belongs to every figure of time."""

import os
import platform
from pathlib import Path


def describe() -> str:
    """Processor, cores that this process may use, and system: 'AMD EPYC 7R13, 2 cores, Linux'."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return f"{_processor()}, {cores} core{'s' if cores > 1 else ''}, {platform.system()}"


def _processor() -> str:
    """The name of the processor; on Linux, the module `platform` does not return it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
