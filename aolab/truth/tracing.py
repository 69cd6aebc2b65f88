"""The reference's work: points in chunks, on all cores."""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np

from ..progress import progress_bar
from .buffers import BUFFERS
from .integrals import Setting, integrate
from .lighting import irradiance
from .points import Surface

CHUNK = 16_384  # points a thread has in hand: a few hundred kB an array, which stays within a core's cache


def trace(
    setting: Setting, surface: Surface, rays: int, seed: int, wanted: list[str], progress: bool | None
) -> dict[str, np.ndarray]:
    """The `wanted` buffers at the surface's points: (n, channels) float32."""
    integrals = {integral for name in wanted for integral in BUFFERS[name].integrals}
    hemisphere = sorted(integrals - {"light"})
    result = {name: np.zeros((len(surface), BUFFERS[name].channels), np.float32) for name in wanted}

    def work(start: int) -> int:
        part = surface.points(start, start + CHUNK)
        random = np.random.Generator(np.random.SFC64([seed, start]))
        means = integrate(setting, part, rays, hemisphere, random) if hemisphere else {}
        if "light" in integrals:
            means["light"] = irradiance(setting.world, setting.lights, part.position, part.normal)
        for name in wanted:
            result[name][start : start + CHUNK] = BUFFERS[name].finish(means, part)
        return len(part)

    _run(work, range(0, len(surface), CHUNK), len(surface), progress)
    return result


def _run(work: Callable[[int], int], starts: range, total: int, progress: bool | None) -> None:
    """All of `starts`, a thread a core: Embree and NumPy let each other run. Stops at the first error or Ctrl-C."""
    with _bar(total, progress) as advance, ThreadPoolExecutor(_cores()) as pool:
        jobs: list[Future[int]] = [pool.submit(work, start) for start in starts]
        try:
            for job in jobs:
                advance(job.result())
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _cores() -> int:
    """The cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def _bar(total: int, progress: bool | None) -> Iterator[Callable[[int], object]]:
    """A function that advances a `progress_bar`, which is shown as `progress` demands."""
    with progress_bar("reference", total, "px", shown=progress, unit_scale=True) as bar:
        yield bar.update
