"""Grade many folders: a process and a time limit for each, so that none can stop the others."""

import csv
import io
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

from ..cores import cores
from ..errors import Error, FileError, ParameterError
from .check import MARK, exercise_of
from .exercise import Exercise
from .results import Result

LIMIT = 120.0  # seconds a folder; on two cores, an exercise takes 5 to 15


@dataclass(frozen=True)
class Graded:
    """A folder, its result, and the seconds that it took."""

    folder: Path
    result: Result
    seconds: float

    @property
    def columns(self) -> dict[str, object]:
        """A row of the table: totals, then the points of each check, then the hints."""
        result = self.result
        checks = {
            f"{step.name} {place} {check.kind}": f"{check.score:g}"
            for step in result.steps
            for place, check in enumerate(step.checks, 1)
        }
        hints = "; ".join(f"{step.name}: {step.mistake}" for step in result.steps if step.mistake)
        totals = {"score": f"{result.score:g}", "points": f"{result.points:g}", "seconds": f"{self.seconds:.1f}"}
        texts = {"error": result.error, "hints": hints}
        return {"folder": str(self.folder), "exercise": result.exercise, **totals, **texts, **checks}


@dataclass
class Processes:
    """The processes of checks that run beside each other; `end` ends them all, and each one that starts later."""

    running: set[subprocess.Popen[str]] = field(default_factory=set)
    ended: threading.Event = field(default_factory=threading.Event)

    def end(self) -> None:
        self.ended.set()
        for process in list(self.running):
            _kill(process)


def checked_apart(
    folder: str | Path,
    *,
    only: str | None = None,
    seed: int = 0,
    name: str | Path | None = None,
    limit: float = LIMIT,
    processes: Processes | None = None,
) -> Result:
    """As `check`, in a process of its own that is ended after `limit` seconds, as by an endless loop in a shader.

    The process is one of `processes`. Raises `ParameterError` and `FileError` for a folder without an exercise.
    """
    one = exercise_of(Path(folder), name)
    with tempfile.TemporaryDirectory() as place:
        out = Path(place) / "result.json"
        order = {"folder": str(folder), "only": only, "seed": seed, "name": None if name is None else str(name)}
        command = [sys.executable, "-m", "aolab.course.worker", json.dumps(order), str(out)]
        ended, reason = _run(command, limit, processes or Processes())
        if out.is_file():
            return Result.from_dict(json.loads(out.read_text(encoding="utf-8")))
    if ended is None:
        return _failed(one, f"stopped after {limit:g} s: a loop may never end, or the time limit is too short")
    return _failed(one, reason or f"the check ended with code {ended}")


def _run(command: Sequence[str], limit: float, processes: Processes) -> tuple[int | None, str]:
    """The exit code, None after the time limit, and the last line of the error output."""
    process = subprocess.Popen(
        command,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        start_new_session=os.name == "posix",
    )
    try:
        processes.running.add(process)
        if processes.ended.is_set():
            _kill(process)
        _, errors = process.communicate(timeout=limit)
    except BaseException as error:
        _kill(process)
        process.communicate()
        if isinstance(error, subprocess.TimeoutExpired):
            return None, ""
        raise
    finally:
        processes.running.discard(process)
    lines = [line for line in errors.splitlines() if line.strip()]
    return process.returncode, lines[-1] if lines else ""


def _kill(process: subprocess.Popen[str]) -> None:
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL) if os.name == "posix" else process.kill()


def _failed(one: Exercise, error: str) -> Result:
    from .check import nothing

    return Result(one.name, one.spec.title, tuple(nothing(step, error) for step in one.spec.steps), error)


def grade(
    folders: Iterable[str | Path],
    *,
    seed: int = 0,
    name: str | Path | None = None,
    limit: float = LIMIT,
    workers: int | None = None,
    done: Callable[[Graded], None] = lambda graded: None,
) -> list[Graded]:
    """Check many folders in `workers` processes at a time (by default one for each core), in the order of `folders`.

    `done` is called with each result when it is there. An error or an interrupt ends the processes. A folder whose
    exercise is unknown has 0 points and an error.
    """
    wanted = [Path(folder) for folder in folders]
    if not wanted:
        raise ParameterError("no folder to grade")
    if missing := [folder for folder in wanted if not folder.is_dir()]:
        raise FileError(f"no folder {missing[0]}")

    def one(folder: Path) -> Graded:
        start = perf_counter()
        try:
            result = checked_apart(located(folder), seed=seed, name=name, limit=limit, processes=processes)
        except Error as error:
            result = Result("", "", error=str(error))
        graded = Graded(folder, result, perf_counter() - start)
        if not processes.ended.is_set():
            done(graded)
        return graded

    processes = Processes()
    with ThreadPoolExecutor(max(1, workers or cores())) as pool:
        try:
            return list(pool.map(one, wanted))
        except BaseException:  # an interrupt
            pool.shutdown(wait=False, cancel_futures=True)
            processes.end()
            raise


def located(folder: Path) -> Path:
    """The folder with the file aolab.toml: `folder`, or its only subfolder that has one, as of an unpacked archive."""
    if (folder / MARK).is_file():
        return folder
    inside = [path.parent for path in folder.glob(f"*/{MARK}")]
    return inside[0] if len(inside) == 1 else folder


def table(graded: Sequence[Graded]) -> str:
    """The results as CSV; each check has a column."""
    heads = list(dict.fromkeys(name for one in graded for name in one.columns))
    text = io.StringIO()
    writer = csv.DictWriter(text, heads, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(one.columns for one in graded)
    return text.getvalue()
