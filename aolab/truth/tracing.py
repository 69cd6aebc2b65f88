"""The reference's work: points in chunks, on all cores; then integrals become buffers."""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np

from ..view import View
from .integrals import Setting, integrate
from .lighting import irradiance
from .picture import background, shown
from .points import Points
from .world import World

CHUNK = 16_384  # points a thread has in hand: a few hundred kB an array, which stays within a core's cache

# buffer: the integrals that it is made of (see `integrals.INTEGRANDS`)
BUFFERS: dict[str, tuple[str, ...]] = {
    "visibility": ("open",),
    "standard_error": ("open",),
    "ambient": ("environment",),
    "indirect": ("sender",),
    "bent_normal": ("open", "open_direction"),
    **{f"sh{i}": ("harmonics",) for i in range(4)},
    "obscurance": ("fuzzy",),
    "transfer": ("fuzzy", "closed_albedo"),
    "transfer_multibounce": ("path",),
    "direct": (),
    "radiance": ("environment", "sender"),
    "image": ("environment", "sender"),
}


def trace(
    setting: Setting, points: Points, view: View, rays: int, seed: int, wanted: list[str], progress: bool | None
) -> dict[str, np.ndarray]:
    """The `wanted` buffers, (H, W) or (H, W, channels) float32, top row first; 0 (or NaN) where nothing was drawn."""
    integrals = sorted({integral for name in wanted for integral in BUFFERS[name]})
    lit = bool({"direct", "radiance", "image"} & set(wanted))

    def work(start: int) -> dict[str, np.ndarray]:
        part = points.part(start, start + CHUNK)
        random = np.random.Generator(np.random.SFC64([seed, start]))
        means = integrate(setting, part, rays, integrals, random) if integrals else {}
        if lit:
            means["light"] = irradiance(setting.world, setting.lights, part.position, part.normal)
        return _buffers(means, part, wanted)

    width, height = view.size
    image: dict[str, np.ndarray] = {}
    with _progress(len(points), progress) as advance, _workers() as pool:
        starts = range(0, len(points), CHUNK)
        for start, values in zip(starts, pool.map(work, starts), strict=True):
            pixel = points.pixel[start : start + CHUNK]
            for name, value in values.items():
                if name not in image:
                    empty = np.nan if name == "standard_error" else 0
                    image[name] = np.full((height * width, *value.shape[1:]), empty, np.float32)
                image[name][pixel] = value
            advance(len(pixel))
    for name in wanted:  # a picture without any surface
        ...
    return {name: array.reshape(height, width, *array.shape[1:]) for name, array in image.items()}
