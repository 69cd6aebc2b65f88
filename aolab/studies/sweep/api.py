"""`aolab.sweep`: many renders in one call, as a table."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...gl import context
from ...version import __version__
from . import schedule
from .case import Settings
from .plan import Plan, as_list, cameras_of, check_scenes, draw_of, measures_of, sizes_of
from .records import Records

if TYPE_CHECKING:
    from .table import SweepTable


def sweep(
    scenes: Any,
    modules: Any = "ssao",
    *,
    size: Any = (480, 270),
    seed: int | Iterable[int] = 0,
    camera: Any = None,
    accumulate: int = 1,
    measures: Any = None,
    reference: bool = True,
    rays: int = 256,
    zip: Mapping[str, Iterable[Any]] | None = None,
    random: Mapping[str, Any] | None = None,
    samples: int = 16,
    sampler: str = "sobol",
    images: bool = False,
    buffers: Iterable[str] = (),
    folder: str | Path | None = None,
    workers: int = 0,
    scheduler: str | None = None,
    shard: str | None = None,
    retry_failed: bool = False,
    on_error: str = "record",
    progress: bool | None = None,
    **parameters: Any,
) -> "SweepTable":
    """Render every combination of scenes, modules, sizes, cameras, seeds and parameters; returns a row a case.

    A keyword that is a module's parameter takes a value or a list of values; all combinations are rendered. `zip` has
    lists that go together, `random` distributions such as `{"radius": ("loguniform", 0.1, 1)}`, of which `samples`
    points are drawn by a `sobol` sequence, or `uniform`. A module that lacks a parameter is rendered without it.

    `measures` are names (`rmse`, `ambient.rmse`, `visibility.border.rmse`, `visibility.mean`) or functions of
    `(frame)` or `(frame, truth)` that return a number or numbers by name. With `reference`, the truth of a case
    answers its module's question (radius, falloff), and cases that share a question share the truth.

    With `folder`, each case is written as it ends: a second call computes only the rest; `retry_failed` repeats
    failures; `images` and `buffers` are written too. `workers` processes share the work, or the Dask cluster at
    `scheduler`; `shard` is "i/n", one part of n. `on_error` is "record" (a row with its error) or "raise".

    The table is a pandas DataFrame; `.attrs` holds how it was made, `.to_xarray()` needs xarray.
    Raises `ParameterError` for a name or value that no case could use, before any work.
    """
    settings = Settings(measures_of(measures, reference), reference, rays, images, tuple(buffers))
    plan = Plan(
        scenes=as_list(scenes),
        modules=as_list(modules),
        sizes=sizes_of(size),
        seeds=as_list(seed),
        cameras=cameras_of(camera),
        accumulate=accumulate,
        settings=settings,
        grid={name: as_list(value) for name, value in parameters.items()},
        zipped={name: as_list(value) for name, value in (zip or {}).items()},
        random={name: draw_of(name, value) for name, value in (random or {}).items()},
        samples=samples,
        sampler=sampler,
    )
    return run_plan(
        plan,
        Path(folder) if folder is not None else None,
        workers=workers,
        scheduler=scheduler,
        shard=shard,
        retry_failed=retry_failed,
        on_error=on_error,
        progress=progress,
    )


def run_plan(plan: Plan, folder: Path | None, *, shard: str | None = None, **how: Any) -> "SweepTable":
    """Run a plan, or a shard of it, and return its table; in `folder`, write the table once all records are there."""
    from .table import SweepTable  # imports pandas: a missing extra is refused before the work

    check_scenes(plan)
    cases = plan.cases(how.get("progress"))
    mine = schedule.shard_of(cases, shard)
    about = description(plan)
    records = Records(folder) if folder is not None else None
    if records:
        records.keep_plan({**about, "cases": len(cases)})
    rows = schedule.run(mine, plan.settings, records=records, **how)
    table = SweepTable.of(rows, about)
    if records and shard is None:
        records.write_table(table)
    return table


def description(plan: Plan) -> dict[str, Any]:
    """How a sweep is made, as plain values: `.attrs` of its table."""
    inputs = ["scene", "module", "width", "height", "seed", "camera", *plan.grid, *plan.zipped, *plan.random]
    return {
        "aolab": __version__,
        "renderer": context.renderer(),
        "scenes": plan.scene_labels,
        "modules": plan.module_labels,
        "rays": plan.settings.rays if plan.settings.reference else 0,
        "inputs": inputs,
        "measures": [one if isinstance(one, str) else one.__name__ for one in plan.settings.measures],
    }
