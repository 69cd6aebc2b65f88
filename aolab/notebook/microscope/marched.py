"""The twins of shaders that march directions: ssao, ssdo, ssbn and s3ho."""

from functools import lru_cache

import numpy as np

from ...maths.harmonics import MAX_BANDS, basis, clamped_cosine
from ...scene.environment import Environment
from ...scene.prefiltered import Table, octahedral_uv
from .inputs import Inputs
from .march import March, march
from .receiver import Texel, world
from .samples import Samples

LARGEST = 65504.0  # of float16 (IEEE 754 binary16)


def visibility(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The open share of the directions; of any shader that includes lib/march.glsl and has that output."""
    found = march(seen, texel, seed)
    return found.samples({"visibility": found.open[:, None] / len(found.ways)})


def ssao(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The twin of glsl/ssao.frag. The power applies to the sum of the contributions."""
    found = march(seen, texel, seed)
    parts = found.open[:, None] / len(found.ways)
    return found.samples({"visibility": parts}, {"visibility": parts.sum(axis=0) ** seen.number("power")})


def ssdo(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The twin of glsl/ssdo.frag."""
    found = march(seen, texel, seed)
    environment = seen.scene.environment
    assert environment is not None  # Scene sets it
    table = _table(seen.module.tables()["prefiltered_environment"], environment)
    column, row = np.minimum(octahedral_uv(world(seen, found.directions)) * len(table), len(table) - 1).astype(int).T
    light = np.column_stack([table[row, column], np.ones(len(column))]) / len(column)
    parts = {"open_light": light * found.open[:, None], "all_light": light}
    parts = {name: parts[name] for name in seen.module.estimate().outputs}
    return found.samples(parts, {name: np.minimum(part.sum(axis=0), LARGEST) for name, part in parts.items()})


@lru_cache(maxsize=4)
def _table(make: Table, environment: Environment) -> np.ndarray:
    return make(environment)


def ssbn(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The twin of glsl/ssbn.frag."""
    found = march(seen, texel, seed)
    weights = 0.5 / (found.kernel[:, 2] / np.linalg.norm(found.kernel[:, :3], axis=1))
    uniform = seen.uniforms["uniform_weights"]
    weights = weights if uniform else np.ones(len(weights))
    blocked = ~found.open * weights
    share = blocked / weights.sum() if uniform else blocked / len(blocked)
    direction = world(seen, found.directions) * blocked[:, None] / len(blocked)
    return found.samples({"blocked_direction": np.column_stack([direction, share])})


def s3ho(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """The twin of glsl/s3ho.moments.frag and s3ho.frag. `plain` subtracts the open directions from the whole cosine."""
    found = march(seen, texel, seed)
    blocked = blocked_share(seen, found)
    plain = seen.uniforms["plain"]
    share = blocked - 1 if plain else blocked
    whole = clamped_cosine(found.receiver.normal) if plain else np.zeros(MAX_BANDS**2)
    parts = np.pi / len(share) * share[:, None] * basis(found.directions, MAX_BANDS)
    columns = {f"occlusion{i}": np.s_[..., 4 * i : 4 * i + 4] for i in range(4)}
    return found.samples(
        {name: parts[column] for name, column in columns.items()},
        {name: (whole + parts.sum(axis=0))[column] for name, column in columns.items()},
    )


def blocked_share(seen: Inputs, found: March) -> np.ndarray:
    """(N,): `blockedShare` of glsl/s3ho.blocked.glsl."""
    distance = np.take_along_axis(found.along, found.first, 1)[:, 0] * np.linalg.norm(found.kernel[:, :3], axis=1)
    return ~found.open / (1 + seen.number("strength") * distance)
