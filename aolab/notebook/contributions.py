"""The contribution of each direction to a module's raw buffers: the twins of the loops in the modules' shaders."""

from functools import lru_cache

import numpy as np

from ..errors import ParameterError
from ..maths.harmonics import MAX_BANDS, basis
from ..modules import S3HO, SSAO, SSBN, SSDO
from ..modules.marched import Marched
from ..scene.environment import Environment
from ..scene.prefiltered import Table, octahedral_uv
from .replay import Samples

LARGEST = 65504.0  # of float16 (IEEE 754 binary16)


def contributions(
    module: Marched, samples: Samples, environment: Environment, world_from_view: np.ndarray
) -> dict[str, np.ndarray]:
    """{buffer: (N, channels)} of one sample set: the sum over the N directions is the raw buffer's texel.

    `ssao` with a `power` other than 1 is an exception: the power applies to the sum. `world_from_view` (3, 3).
    Raises `ParameterError` for a module whose outputs include no `visibility` and that is not built in.
    """
    count = len(samples.directions)
    open_ = samples.open.astype(np.float64)
    world = samples.directions.astype(np.float64) @ world_from_view.T
    if isinstance(module, SSDO):
        table = _table(module.tables()["prefiltered_environment"], environment)
        column, row = np.minimum(octahedral_uv(world) * len(table), len(table) - 1).astype(int).T
        light = np.column_stack([table[row, column], np.ones(count)]) / count
        parts = {"open_light": light * open_[:, None]}
        return parts | ({"all_light": light} if module.estimator == "blocked" else {})
    if isinstance(module, SSBN):
        weights = 0.5 / (samples.kernel[:, 2] / np.linalg.norm(samples.kernel[:, :3], axis=1))
        uniform = module.weighting == "uniform"
        weights = weights if uniform else np.ones(count)
        blocked = (1 - open_) * weights
        share = blocked / weights.sum() if uniform else blocked / count
        return {"blocked_direction": np.column_stack([world * blocked[:, None] / count, share])}
    if isinstance(module, S3HO):
        distance = np.take_along_axis(samples.along, samples.first[:, None], 1)[:, 0]
        distance = distance * np.linalg.norm(samples.kernel[:, :3], axis=1)  # radii
        share = (1 - open_) / (1 + module.strength * distance)
        values = np.pi / count * share[:, None] * basis(samples.directions, MAX_BANDS)
        return {f"occlusion{i}": values[:, 4 * i : 4 * i + 4] for i in range(4)}
    if isinstance(module, SSAO) or "visibility" in module.outputs:
        return {"visibility": open_[:, None] / count}
    raise ParameterError(
        f"microscope: the sum of the module {module.name} is unknown; known are ssao, ssdo, ssbn, s3ho, and modules "
        "with the output 'visibility'"
    )


@lru_cache(maxsize=4)
def _table(make: Table, environment: Environment) -> np.ndarray:
    return make(environment)


def summed(module: Marched, parts: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """{buffer: (channels,)}: the texel of one sample set, from its contributions."""
    sums = {name: np.minimum(values.sum(axis=0), LARGEST) for name, values in parts.items()}
    if isinstance(module, SSAO):
        sums["visibility"] = sums["visibility"] ** module.power
    return sums
