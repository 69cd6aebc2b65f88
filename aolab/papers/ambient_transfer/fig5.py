"""Ambient transfer, figure 5: obscurance of 1, 4 and 8 samples, without and with interleaved sampling."""

from statistics import median

import numpy as np

from ...gl.texture import Size
from ...modules.ambient_transfer import AmbientTransfer
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .corner import beside_the_wall, corner

COUNTS = (1, 4, 8)
PRINTED = {1: (720, 625), 4: (700, 415), 8: (430, 299)}  # frames per second without and with, NV8800, 800×600
PLAIN = AmbientTransfer(radius=1.0, steps=1, filter="none")
INTERLEAVED = PLAIN.replace(filter="box4")
MOST = 0.75  # of the error that interleaving may leave; 16 independent samples would leave a quarter


def fig5(size: Size = (320, 180), seeds: int = 6) -> Figure:
    """A corner by 1, 4 and 8 samples a pixel. Both columns have 16 rotations; the right one has the filter, too.

    Numbers: the root mean square error against a converged estimate, as a mean over the seeds; the time of the passes;
    and the variance of the ratio with shared samples over that with separate ones.
    """
    scene, lab = corner(), shared_lab()
    exact = lab.render(scene, PLAIN, size=size, directions=64, accumulate=16)
    near, _ = beside_the_wall(exact, 0.03, 0.95)
    numbers: dict = {}
    needs, pictures = [], []
    for count in COUNTS:
        found = {"without": PLAIN.replace(directions=count), "with": INTERLEAVED.replace(directions=count)}
        errors, times = {}, {}
        for name, module in found.items():
            frames = [lab.render(scene, module, size=size, seed=seed) for seed in range(seeds)]
            errors[name] = float(np.mean([rmse(one["obscurance"], exact["obscurance"], near) for one in frames]))
            times[name] = median(
                sum(cost for step, cost in one.timings.items() if "transfer" in step) for one in frames[1:]
            )
            pictures.append((f"{count} samples, {name}: rmse {errors[name]:.3f}", gray(frames[0]["obscurance"])))
        numbers[f"{count} samples"] = {"rmse": errors, "ms": times, "printed fps": list(PRINTED[count])}
        left = errors["with"] / errors["without"]
        needs.append(Need(f"the error with interleaving over that without, {count} samples", left, below=MOST))
    one, eight = (numbers[f"{count} samples"]["rmse"]["with"] for count in (1, 8))
    needs.append(Need("the error of 8 samples over that of 1, with interleaving", eight / one, below=0.7))
    numbers["variance of the ratio, shared over separate samples"] = ratio = _shared_over_separate(size, seeds)
    needs.append(Need("the variance of the transfer by shared samples over that by separate ones", ratio, below=0.6))
    claim = (
        "Interleaved sampling multiplies the effective number of samples for the cost of a box filter, and the ratio "
        "of two sums over the same samples compensates their errors"
    )
    return figure("Ambient transfer, Fig. 5", claim, needs, numbers, pictures, 2)


def _shared_over_separate(size: Size, seeds: int) -> float:
    """Weighted importance sampling: the variance of numerator / denominator, with the same and with other samples."""
    frames = [shared_lab().render(corner(), PLAIN, size=size, directions=8, seed=seed) for seed in range(2 * seeds)]
    near, _ = beside_the_wall(frames[0], 0.05, 0.8)
    terms = np.array([frame.channels("transfer_terms")[near] for frame in frames])
    shared = terms[..., 3:] / terms[..., :3]
    separate = terms[..., 3:] / np.roll(terms, 1, axis=0)[..., :3]
    return float(shared.var(axis=0).mean() / separate.var(axis=0).mean())
