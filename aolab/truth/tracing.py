"""The reference's work: points in chunks, on all cores."""

import itertools
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from functools import partial
from queue import SimpleQueue

import numpy as np

from ..cores import cores
from ..progress import progress_bar
from .adaptive import batches_needed
from .buffers import BUFFERS, standard_error
from .integrals import INTEGRANDS, integrate
from .moments import Moments, Pair
from .points import Surface
from .sample import Setting, randoms

Advance = Callable[[int], object]  # takes a number of points that are done
Work = Callable[[int, Advance], None]  # from this point on
LOOK = 0.1  # seconds between two looks at the work that is done
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

    def work(batch: int, where: np.ndarray, start: int, advance: Advance) -> None:
        chunk = where[start : start + CHUNK]
        random = randoms(seed, batch, start)
        strata = itertools.count(1)
        done = 0

        def stopped() -> bool:  # called before each stratum's rays, two a point
            nonlocal done
            before, done = done, len(chunk) * next(strata) // (setting.rays // 2 + 1)
            advance(done - before)
            return stop.is_set()

        moments.put(chunk, integrate(setting, surface.points(chunk), list(integrals), crosses, random, stopped))
        advance(len(chunk) - done)

    everywhere = np.arange(len(surface))
    _run(partial(work, 0, everywhere), len(surface), progress, "reference", stop)
    result: dict[str, np.ndarray] = {}
    if error is not None:
        batches = batches_needed(surface, moments, wanted, error)
        for batch in range(1, batches.max(initial=1)):
            where = np.flatnonzero(batches > batch)
            _run(partial(work, batch, where), len(where), progress, f"reference, batch {batch}", stop)
        result["rays"] = (setting.rays * batches[:, None]).astype(np.float32)
    for name in wanted:
        result[name] = BUFFERS[name].value(moments, surface.albedo)
        result[standard_error(name)] = BUFFERS[name].error(moments, surface.albedo)
    return result


def _run(work: Work, total: int, progress: bool | None, what: str, stop: threading.Event) -> None:
    """`work` from every CHUNK-th point on, a thread a core: Embree and NumPy let each other run.

    Stops at the first error or Ctrl-C: `stop` is set, and the work that is under way ends after its next rays.
    """
    done: SimpleQueue[int] = SimpleQueue()  # points; this thread advances the bar, as notebooks need it
    with _bar(total, progress, what) as advance, ThreadPoolExecutor(cores()) as pool:
        jobs: set[Future[None]] = {pool.submit(work, start, done.put) for start in range(0, total, CHUNK)}
        try:
            while jobs:
                ended, jobs = wait(jobs, LOOK, FIRST_COMPLETED)
                for job in ended:
                    job.result()
                advance(sum(done.get() for _ in range(done.qsize())))
        except BaseException:
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise


@contextmanager
def _bar(total: int, progress: bool | None, what: str) -> Iterator[Advance]:
    """A function that advances a `progress_bar`, which is shown as `progress` demands."""
    with progress_bar(what, total, "px", shown=progress, unit_scale=True) as bar:
        yield bar.update
