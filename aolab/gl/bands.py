"""A long draw in bands: a call of OpenGL cannot be interrupted, so Python sees Ctrl-C between two of them."""

from collections.abc import Iterator
from time import perf_counter

from ..scene.view import Region
from . import context
from .program import Program

PATIENCE = 0.3  # seconds of a band
BLOCK = 4  # rows that llvmpipe shades together, at least one such block a band


def bands(program: Program, region: Region) -> Iterator[Region]:
    """The regions (x, y, width, height) that the caller draws one by one, in place of `region`. For software renderers.

    A draw whose last one was shorter than `PATIENCE` is a single band.
    """
    x, y, width, height = region
    top = y + height
    while y < top:
        cost = program.seconds_a_pixel * width
        blocks = max(1, int(PATIENCE / cost / BLOCK)) if cost else 1  # of the first draw, the cost is not known
        rows = min(BLOCK * blocks, top - y)
        start = perf_counter()
        yield x, y, width, rows
        context.get().finish()
        program.seconds_a_pixel = (perf_counter() - start) / (width * rows)
        y += rows
