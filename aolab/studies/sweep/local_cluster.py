"""Dask's cluster of worker processes on this machine, which Ctrl-C ends within a second and without a word."""

import logging
import multiprocessing
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing import resource_tracker
from typing import TYPE_CHECKING

from ...cores import cores
from ...errors import Error

if TYPE_CHECKING:
    from distributed import LocalCluster
    from distributed.utils import LoopRunner

DASK = {
    "distributed.scheduler.allowed-failures": 0,  # `schedule` counts the deaths
    "distributed.admin.large-graph-warning-threshold": "10GB",  # scenes are part of the graph
}


@contextmanager
def local_cluster(workers: int) -> Iterator["LocalCluster"]:
    """A cluster of `workers`, which end with the block. Each draws with its share of the cores, and shows no bars.

    Raises `Error` if a worker fails to start.
    """
    from dask import config
    from distributed import LocalCluster

    environment = {"LP_NUM_THREADS": str(max(1, cores() // workers)), "TQDM_DISABLE": "1"}
    runner = _deaf_loop()
    # without workers at first: their start takes seconds, in which an interrupt would leave no cluster to be closed
    cluster = {"n_workers": 0, "threads_per_worker": 1, "env": environment, "dashboard_address": ":0"}
    with config.set(DASK):
        local = LocalCluster(loop=runner.loop, **cluster)
        try:
            _start(local, workers)
            yield local
            local.close()
        except BaseException:
            _end_at_once(local, runner)
            raise
        runner.stop()


def _start(cluster: "LocalCluster", workers: int) -> None:
    """Start the workers, and wait until they are there. Raises `Error` if a worker fails."""
    for _ in range(workers):
        cluster.worker_spec.update(cluster.new_worker_spec())
    try:
        cluster.sync(cluster._correct_state)
    except RuntimeError as error:
        raise Error(
            "the worker processes did not start; a script has to call aolab.sweep under "
            "`if __name__ == '__main__':`, since each worker imports the script"
        ) from error


def _deaf_loop() -> "LoopRunner":
    """Dask's event loop, whose processes get no SIGINT: a terminal sends it to all, and each would write a traceback.

    A thread, and a process that it starts, inherit the signals that are blocked.
    """
    from distributed.utils import LoopRunner

    resource_tracker.ensure_running()  # in a thread whose signals are blocked, its start would let them through
    runner = LoopRunner()
    blocks = hasattr(signal, "pthread_sigmask")  # not on Windows
    former = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT}) if blocks else ()
    try:
        runner.start()
    finally:
        if blocks:
            signal.pthread_sigmask(signal.SIG_SETMASK, former)
    return runner


def _end_at_once(cluster: "LocalCluster", runner: "LoopRunner") -> None:
    """End the workers without waiting for their cases. Dask shall neither complain nor start them again."""
    disabled = logging.root.manager.disable
    logging.disable()
    cluster.shutdown_on_close = False
    cluster.worker_spec.clear()
    for nanny in cluster.workers.values():
        nanny.auto_restart = False
    _kill_workers()
    with suppress(Exception):  # TimeoutError; workers that were about to start
        cluster.close(timeout=0.5)
    runner.stop(timeout=1)
    for _ in range(4):  # a worker that was about to start
        _kill_workers()
        time.sleep(0.05)
    logging.disable(disabled)


def _kill_workers() -> None:
    for process in multiprocessing.active_children():
        if process.name.startswith("Dask Worker"):
            process.kill()
