"""The reference's work: points in chunks, on all cores."""

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np

from ..cores import cores
from ..progress import progress_bar
from .adaptive import batches_needed
from .buffers import BUFFERS, standard_error
from .integrals import INTEGRANDS, integrate
from .moments import Moments, Pair
from .points import Surface
from .sample import Setting, randoms

CHUNK = 16_384  # points a thread has in hand: a few hundred kB an array, which stays within a core's cache


def trace(
    setting: Setting, surface: Surface, wanted: list[str], seed: int, error: float | None, progress: bool | None
) -> dict[str, np.ndarray]:
    """The `wanted` buffers and their standard errors at the surface's points: (n, channels) float32 by name.

    With `error`, a relative one, points get further batches of rays until they meet it (`adaptive`); then `rays` (n, 1)
    is how many each had.
    """
    integrals = {integral: INTEGRANDS[integral].channels if integral != "light" else 3
                 for name in wanted for integral in BUFFERS[name].integrals}  # fmt: skip
    crosses: set[Pair] = {cross for name in wanted for cross in BUFFERS[name].crosses}
    moments = Moments(len(surface), integrals, crosses)

    stop = threading.Event()

    def work(batch: int, where: np.ndarray, start: int) -> int:
        chunk = where[start : start + CHUNK]
        random = randoms(seed, batch, start)
        part = integrate(setting, surface.points(chunk), list(integrals), crosses, random, stop.is_set)
        moments.put(chunk, part)
        return len(chunk)

    everywhere = np.arange(len(surface))
    _run(lambda start: work(0, everywhere, start), len(surface), progress, "reference", stop)
    result: dict[str, np.ndarray] = {}
    if error is not None:
        batches = batches_needed(surface, moments, wanted, error)
        for batch in range(1, batches.max(initial=1)):
            where = np.flatnonzero(batches > batch)
            _run(
                lambda start, b=batch, w=where: work(b, w, start),
                len(where),
                progress,
                f"reference, batch {batch}",
                stop,
            )
        result["rays"] = (setting.rays * batches[:, None]).astype(np.float32)
    for name in wanted:
        result[name] = BUFFERS[name].value(moments, surface.albedo)
        result[standard_error(name)] = BUFFERS[name].error(moments, surface.albedo)
    return result


def _run(work: Callable[[int], int], total: int, progress: bool | None, what: str, stop: threading.Event) -> None:
    """`work` from every CHUNK-th point on, a thread a core: Embree and NumPy let each other run.

    Stops at the first error or Ctrl-C: `stop` is set, and the work that is under way ends after its next rays.
    """
    with _bar(total, progress, what) as advance, ThreadPoolExecutor(cores()) as pool:
        jobs: list[Future[int]] = [pool.submit(work, start) for start in range(0, total, CHUNK)]
        try:
            for job in jobs:
                advance(job.result())
        except BaseException:
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise


@contextmanager
def _bar(total: int, progress: bool | None, what: str) -> Iterator[Callable[[int], object]]:
    """A function that advances a `progress_bar`, which is shown as `progress` demands."""
    with progress_bar(what, total, "px", shown=progress, unit_scale=True) as bar:
        yield bar.update
