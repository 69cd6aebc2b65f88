"""Runs the cases of a sweep: in this process, on worker processes, on a Dask cluster, or one shard of them."""

import importlib.util
import itertools
import sys
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import closing, contextmanager, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...errors import Error, ParameterError
from ...extras import missing
from ...progress import progress_bar, write_line
from ...scene.scene import Scene
from ...version import __version__
from . import case as one
from .case import Case, Settings
from .local_cluster import local_cluster
from .measured import buffers_of
from .records import Records

if TYPE_CHECKING:
    from distributed import Client, Future

TRIES = 3  # a case whose worker dies is computed on another worker; after so many deaths it counts as failed
CONNECT, WORKER_STARTS = 30, 600  # seconds until a scheduler, and its first worker, must be there
Result = tuple[str, dict[str, Any], dict[str, bytes]]  # of a case: its name, its record, its files


def shard_of(cases: Sequence[Case], shard: str | None) -> list[Case]:
    """The part `i/n` of the cases, i from 0 to n - 1: neighbours stay together. Raises `ParameterError`."""
    if shard is None:
        return list(cases)
    index, _, count = shard.partition("/")
    if not index.isdecimal() or not count.isdecimal() or not int(index) < int(count):
        raise ParameterError(f"shard = '{shard}' is not I/N with I from 0 to N - 1, as in 0/10")
    i, n = int(index), int(count)
    return list(cases[len(cases) * i // n : len(cases) * (i + 1) // n])


def run(
    cases: Sequence[Case],
    settings: Settings,
    *,
    records: Records | None = None,
    workers: int = 0,
    scheduler: str | None = None,
    retry_failed: bool = False,
    on_error: str = "record",
    progress: bool | None = None,
) -> list[dict[str, Any]]:
    """The records of all cases, in their order. A case whose record is in the folder is not computed again.

    Raises `Error` for the first failed case where `on_error` is "raise", and `FileError` for a record that cannot be
    written. An interrupt passes; the records so far are kept.
    """
    if on_error not in ("record", "raise"):
        raise ParameterError(f"on_error = {on_error!r} is not one of: record, raise")
    if not isinstance(workers, int) or workers < 0:
        raise ParameterError(f"workers = {workers!r} is not a whole number from 0 on")
    named = _named(cases, settings, progress)
    known = {name: record for name, _ in named if records and (record := records.load(name))}
    wanted = {
        name: case for name, case in named if name not in known or (retry_failed and known[name]["status"] != "ok")
    }
    with progress_bar("sweep", len(named), "case", shown=progress, initial=len(named) - len(wanted)) as bar:
        parallel = wanted and (workers or scheduler)
        results = _on_dask(wanted, settings, workers, scheduler, bar) if parallel else _here(wanted, settings)
        with closing(results):  # an error here ends the workers
            for name, record, files in results:
                if records:
                    records.store(name, record, files)
                known[name] = record
                bar.update()
                if on_error == "raise" and record["status"] != "ok":
                    raise Error(f"sweep: {wanted[name].title}: {record['error']}")
    return [{**known[name], **one.plain(case.columns)} for name, case in named]  # another sweep may name it otherwise


def _named(cases: Sequence[Case], settings: Settings, progress: bool | None) -> list[tuple[str, Case]]:
    named = []
    with progress_bar("names", len(cases), "case", shown=progress) as bar:
        for case in cases:
            named.append((one.identity(case, settings), case))
            bar.update()
    return named


def _here(cases: dict[str, Case], settings: Settings) -> Generator[Result]:
    for name, case in cases.items():
        yield name, *one.run(case, settings, name)


def _on_dask(
    cases: dict[str, Case], settings: Settings, workers: int, scheduler: str | None, bar: Any
) -> Generator[Result]:
    """Results as they come. Each case is a task; a truth is a task that its cases wait for, so it is computed once.

    Dask counts the death of a worker for all tasks that it had given to the worker. The case that kills is therefore
    found at the end, when each of these cases has the cluster for itself.
    """
    with _client(workers, scheduler) as client:
        _show_dashboard(client, bar)
        sent = _Sender(client, settings)
        suspects: list[str] = []
        for name, future in _completed(client, cases, sent):
            if (result := _result(future, name, cases[name])) is not None:
                yield result
            else:
                suspects.append(name)
        for name in suspects:
            yield _alone(name, cases[name], sent)


def _completed(client: "Client", cases: dict[str, Case], sent: "_Sender") -> Iterator[tuple[str, "Future"]]:
    """Each case with its task, when that has ended. Twice as many tasks as workers are at the cluster."""
    from distributed import as_completed

    running, names = as_completed(), dict[Any, str]()
    waiting = iter(cases.items())

    def submit(count: int) -> None:
        for name, case in itertools.islice(waiting, count):
            future = sent.case(name, case, sent.truth(case))
            names[future.key] = name
            running.add(future)

    submit(2 * _workers(client))  # the next task is at hand when a task ends
    for future in running:
        yield names.pop(future.key), future
        future.release()
        submit(1)


class _Sender:
    """Sends cases to a cluster. A truth is one task; a scene that was given as an object travels once."""

    def __init__(self, client: "Client", settings: Settings) -> None:
        self.client, self.settings = client, settings
        self._truths: dict[Any, Future] = {}
        self._scenes: dict[int, Future] = {}

    def case(self, name: str, case: Case, truth: "Future | None") -> "Future":
        case, scene = self._apart(case)
        return self.client.submit(_compute, case, scene, self.settings, name, truth, pure=False)

    def truth(self, case: Case) -> "Future":
        question = one.question(case, self.settings)
        if question not in self._truths:
            case, scene = self._apart(case)
            self._truths[question] = self.client.submit(_trace, case, scene, self.settings, pure=False)
        return self._truths[question]

    def forget(self) -> None:
        """Send scenes again: the workers that had them may be dead."""
        self._scenes.clear()

    def _apart(self, case: Case) -> tuple[Case, Any]:
        scene = case.scene
        if not isinstance(scene, Scene):
            return case, scene
        if id(scene) not in self._scenes:
            self._scenes[id(scene)] = self.client.submit(_scene, scene, pure=False)  # computed again if its worker dies
        return replace(case, scene=one.scene_name(scene)), self._scenes[id(scene)]


def _scene(scene: Scene) -> Scene:
    return scene


def _trace(case: Case, scene: Any, settings: Settings) -> None:
    """Leave the truth of the case in the folder of references. A failure is the case's own, which it will record."""
    with suppress(Exception):
        one.truth_of(replace(case, scene=scene), settings)


def _compute(
    case: Case, scene: Any, settings: Settings, name: str, _truth: None
) -> tuple[dict[str, Any], dict[str, bytes]]:
    return one.run(replace(case, scene=scene), settings, name)


def _result(future: "Future", name: str, case: Case) -> Result | None:
    """The result of a task; None if its worker died, or the worker that had its scene."""
    from distributed.client import FuturesCancelledError
    from distributed.scheduler import KilledWorker

    try:
        return name, *future.result()
    except (KilledWorker, CancelledError, FuturesCancelledError):
        return None
    except Exception as error:  # the task did not reach the case, which records its own errors
        return _failed(name, case, f"{type(error).__name__}: {error}")


def _alone(name: str, case: Case, sent: _Sender) -> Result:
    """The result of a case whose worker died, computed with nothing beside it; a failure after `TRIES` deaths."""
    for _ in range(1, TRIES):
        sent.forget()
        if (result := _result(sent.case(name, case, None), name, case)) is not None:
            return result
    return _failed(name, case, f"its worker process died in each of {TRIES} tries")


def _failed(name: str, case: Case, error: str) -> Result:
    return name, {"case": name, **one.plain(case.columns), **one.failure(error), "aolab": __version__}, {}


def _workers(client: "Client") -> int:
    """How many cases run at a time. Raises `ParameterError` for workers of several threads: GL has one a process."""
    threads: Any = client.nthreads()
    if several := {address: count for address, count in threads.items() if count > 1}:
        raise ParameterError(
            f"{len(several)} of {len(threads)} Dask workers have several threads; an OpenGL context belongs to one: "
            "start them with --nthreads 1"
        )
    return max(1, len(threads))


def _show_dashboard(client: "Client", bar: Any) -> None:
    """Print the address of Dask's dashboard above the bar; without bokeh there is no dashboard."""
    if not bar.disable and importlib.util.find_spec("bokeh"):
        write_line(f"Dask's dashboard: {client.dashboard_link}", sys.stderr)


@contextmanager
def _client(workers: int, scheduler: str | None) -> Iterator["Client"]:
    """A client of the cluster at `scheduler`, or of `workers` processes on this machine, which end with it."""
    try:
        from distributed import Client
    except ImportError as error:
        raise missing("sweep", error) from error
    if scheduler is not None:
        try:
            client = Client(scheduler, timeout=CONNECT)
        except (OSError, TimeoutError, ValueError) as error:
            raise Error(f"no Dask scheduler at {scheduler}: {error}") from error
        with client:
            try:
                client.wait_for_workers(1, timeout=WORKER_STARTS)
            except TimeoutError as error:
                raise Error(f"the Dask scheduler at {scheduler} has no worker ({error})") from error
            yield client
        return
    with local_cluster(workers) as cluster, Client(cluster) as client:
        yield client


FEW, MORE = 2, 32  # rays of the two truths from which the cost of all rays is extrapolated


def estimate(cases: Sequence[Case], settings: Settings) -> float:
    """Seconds that the cases will take in this process, all computed anew.

    A case of each scene, module and size is rendered, and a truth of each scene and size is traced with `FEW` and with
    `MORE` rays; its time grows linearly with the rays.
    """
    frames: dict[Any, float] = {}
    truths: dict[Any, float] = {}

    def truth(case: Case, rays: int) -> float:
        return _seconds(lambda: one.traced(case, replace(settings, rays=rays), cache=False))

    total, asked = 0.0, set[Any]()
    for case in cases:
        place = one.scene_name(case.scene), case.size
        kind = *place, one.module_name(case.module)
        if kind not in frames:
            frames[kind] = _seconds(lambda case=case: one.render(case))
        total += frames[kind]
        question = one.question(case, settings)
        if buffers_of(settings.measures) and question not in asked:
            if place not in truths:
                few, more = truth(case, FEW), truth(case, MORE)
                truths[place] = few + max(0.0, more - few) / (MORE - FEW) * (settings.rays - FEW)
            total += truths[place]
            asked.add(question)
    return total


def _seconds(work: Callable[[], object]) -> float:
    """Seconds of one call; 0 for a call that raises, since its case will fail as quickly."""
    start = time.perf_counter()
    try:
        work()
    except Exception:
        return 0.0
    return time.perf_counter() - start
