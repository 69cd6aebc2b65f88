"""The twin of glsl/ambient_transfer.frag."""

import numpy as np

from ...modules.measures import Measure
from .blocking import blocked
from .inputs import F, Inputs
from .receiver import Texel, marching_receiver, way_along
from .samples import Samples


def ambient_transfer(seen: Inputs, texel: Texel, seed: int) -> Samples:
    """Direction i of n contributes 1 - ã_i or 1 to the denominator (rgb), and 0 or 1 to the numerator (a), over n."""
    radius, steps = seen.number("radius"), int(seen.uniforms["steps"])
    receiver = marching_receiver(seen, texel, seen.number("measure_farthest") * radius)
    kernel = seen.samples("kernel", seed).reshape(-1, 4)
    shares = np.mod(kernel[:, 3] + F(receiver.number) / F(16), F(1))
    lengths = radius * _inverse(seen, shares)
    ways = way_along(receiver, ((kernel[:, :3] @ receiver.frame.T) * lengths[:, None]).astype(F))
    along = np.arange(1, steps + 1, dtype=F) / F(steps)
    points = (receiver.position + ways[:, None] * along[:, None]).astype(F)
    found = blocked(seen, receiver, points, _solid(seen, points))
    is_open = np.logical_not(found.blocked.any(axis=1))[:, None]
    albedo = np.take_along_axis(found.surface()[1], found.blocked.argmax(axis=1)[:, None, None], 1)[:, 0]
    terms = np.column_stack([1 - np.where(is_open, 0, albedo), is_open]) / len(ways)
    return Samples(
        "direction", receiver.position, receiver.normal, receiver.position + ways, points,
        found.blocked, found.position, {"transfer_terms": terms}, {"transfer_terms": terms.sum(axis=0)},
    )  # fmt: skip


def _inverse(seen: Inputs, shares: np.ndarray) -> np.ndarray:
    """(n,) float32: `measureInverse`, in radii, of `shares` (n,)."""
    if "measure_inverse" in seen.uniforms:
        table = np.frombuffer(seen.uniforms["measure_inverse"], F)
        return np.interp(shares, np.linspace(0, 1, len(table)), table).astype(F)
    measure = seen.module.chosen("measure")
    assert isinstance(measure, Measure)
    return measure.inverse(shares.astype(np.float64)).astype(F)


def _solid(seen: Inputs, points: np.ndarray) -> np.ndarray:
    """(...): the depth behind the visible surface that counts as solid, for each point (..., 3)."""
    radius = seen.number("radius")
    if seen.module.values()["silhouette_elimination"]:
        return np.broadcast_to(seen.number("thickness") * radius, points.shape[:-1])
    return F(2) * np.maximum(-points[..., 2], radius)
