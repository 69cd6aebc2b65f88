"""Ctrl-C at any line of a frame leaves the lab whole: later pictures are right, and no two frames share a texture."""

import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import aolab
from aolab.modules import MODULES
from aolab.modules.occluders import Depth, Height, Product

PACKAGE = Path(aolab.__file__).parent
FOLDERS = ("pipeline", "gl", "modules")  # where textures are taken and given back, and where they are chosen
TWO = Product(first=Depth(), second=Height())
Place = tuple[str, int]


def lines_of(call) -> list[Place]:
    """The lines of the folders that a call runs."""
    places: dict[Place, None] = {}
    _traced(call, lambda place: places.setdefault(place))
    return list(places)


def interrupted_at(call, place: Place) -> bool:
    """Is there a KeyboardInterrupt at the first run of this line? The line may not run this time."""

    def stop(here: Place) -> None:
        if here == place:
            sys.settrace(None)
            raise KeyboardInterrupt

    try:
        _traced(call, stop)
    except KeyboardInterrupt:
        return True
    return False


@cache
def _is_watched(file: str) -> bool:
    return any(file.startswith(str(PACKAGE / folder)) for folder in FOLDERS)


def _traced(call, at_line) -> None:
    def local(frame, event, _argument):
        if event == "line":
            at_line((frame.f_code.co_filename, frame.f_lineno))
        return local

    def each(frame, _event, _argument):
        return local if _is_watched(frame.f_code.co_filename) else None

    sys.settrace(each)
    try:
        call()
    finally:
        sys.settrace(None)


@pytest.mark.slow
def test_an_interrupt_at_every_line():
    lab, scene = aolab.Lab((24, 16)), aolab.load("boxes")

    def render() -> aolab.Frame:
        return lab.render(scene, "ssdo", bounces=1, occluders="layers").complete()

    names = ("image", "viewZ", "bounce")
    before = render()
    right = {name: before[name].copy() for name in names}
    places = lines_of(lambda: render().complete())
    assert len(places) > 200
    interrupts = 0
    for place in places:
        interrupts += interrupted_at(lambda: render().complete(), place)
        now = render()
        now["image"]  # read at once; the other buffers after the next interrupt and the next frame
        for frame in (before, now):
            for name in names if frame is before else ("image",):
                np.testing.assert_array_equal(frame[name], right[name], err_msg=f"{name}, after {place}")
        before = now
    assert interrupts > 0.9 * len(places)


@pytest.mark.parametrize(
    "module", [MODULES["ssdo"](bounces=1), MODULES["ssao"](occluders=TWO)], ids=["ssdo", "product"]
)
def test_an_interrupt_in_the_parameters_stays_an_interrupt(module):
    """pydantic turns an exception in a serializer, KeyboardInterrupt too, into an error that sweeps record."""
    places = lines_of(lambda: module.replace().values())
    assert places
    for place in places:
        assert interrupted_at(lambda: module.replace().values(), place), place
