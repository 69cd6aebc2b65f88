"""`aolab sweep`."""

import json
from pathlib import Path
from typing import Annotated, Any

from typer import Argument, Exit, Option

from . import options


def sweep(
    spec: Annotated[
        Path, Argument(metavar="SPEC.toml", help="The cases: scene, module, table [parameters]. See docs/sweeps.md.")
    ],
    folder: Annotated[
        Path | None, Option("-o", "--output", metavar="DIR", help="The folder of the records and of the table.")
    ] = None,
    workers: Annotated[int, Option(metavar="N", help="Worker processes on this machine; 0 computes here.")] = 0,
    scheduler: Annotated[str | None, Option(metavar="ADDRESS", help="A Dask scheduler, tcp://HOST:PORT.")] = None,
    shard: Annotated[str | None, Option(metavar="I/N", help="Part I of N, from 0: for job arrays.")] = None,
    only_list: Annotated[bool, Option("--dry-run", help="List the cases and estimate the time.")] = False,
    retry_failed: Annotated[bool, Option("--retry-failed", help="Compute failed cases again.")] = False,
    as_json: options.Json = False,
) -> None:
    """Render many cases into one table. A second call computes only the cases that are missing."""
    from ..errors import ParameterError
    from ..studies.sweep import schedule
    from ..studies.sweep.api import run_plan
    from ..studies.sweep.plan import check_scenes, read_spec

    plan = read_spec(spec)
    if only_list:
        check_scenes(plan)
        cases = schedule.shard_of(plan.cases(), shard)
        titles, seconds = [case.title for case in cases], schedule.estimate(cases, plan.settings)
        lines = [*titles, f"{len(titles)} cases, about {seconds:.0f} s in one process"]
        print(json.dumps({"cases": titles, "seconds": seconds}, indent=2) if as_json else "\n".join(lines))
        return
    if folder is None:
        raise ParameterError("sweep: the folder of the records is missing; name it with -o DIR")
    if workers and scheduler:
        raise ParameterError("--workers starts processes here, --scheduler uses a cluster: give one of them")
    table = run_plan(plan, folder, workers=workers, scheduler=scheduler, shard=shard, retry_failed=retry_failed)
    print(table.to_json(orient="records", indent=2) if as_json else f"{_report(table)}\n{folder}")
    if len(table.good) < len(table):
        raise Exit(1)


def _report(table: Any) -> str:
    """How many cases succeeded, and each failed case with its error."""
    failed = table[table["status"] != "ok"]
    lines = [f"{len(table) - len(failed)} of {len(table)} cases succeeded"]
    lines += [f"  {row.scene} {row.module} seed={row.seed} ({row.case}): {row.error}" for row in failed.itertuples()]
    notes = table["notes"].value_counts() if "notes" in table else {}
    lines += [f"  {count} cases: {note}" for note, count in notes.items() if note]
    return "\n".join(lines)
