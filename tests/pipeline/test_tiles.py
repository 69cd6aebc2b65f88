"""On a software renderer, a filter is drawn in tiles where values differ; elsewhere the estimate stays as it is."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
import pytest
import small_scenes
from scipy.ndimage import maximum_filter

import aolab
from aolab.gl import context
from aolab.modules.buffers import Buffer
from aolab.modules.estimate import Estimate
from aolab.modules.filters import Filter
from aolab.modules.filters.base import over_sources
from aolab.modules.passes import Pass
from aolab.pipeline.tiles import PIXELS

SIZE = (99, 69)
SPOTS = [(3, 4), (40, 6), (41, 62), (98, 68)]  # (column, row), row 0 at the bottom


class Spots(aolab.Module):
    """`spots` is 1, and 0.5 in the last channel at a few pixels, where alone `other` is not 0."""

    outputs: ClassVar = {"spots": "RGBA16F", "other": "RGBA16F"}
    buffers: ClassVar = tuple(Buffer(name, 4, "RGBA16F", "", 0, "numbers", "For a test.") for name in outputs)
    shader = f"""
    out vec4 spots;
    out vec4 other;
    void main() {{
        ivec2 pixel = ivec2(gl_FragCoord.xy);
        bool here = {" || ".join(f"pixel == ivec2{spot}" for spot in SPOTS)};
        spots = vec4(1.0, 1.0, 1.0, here ? 0.5 : 1.0);
        other = vec4(0.0, 0.0, here ? 0.5 : 0.0, 0.0);
    }}
    """
    decides: ClassVar = "spots"

    def passes(self) -> list[Pass]:
        return [Pass("spots", self.shader, self.outputs, background={"spots": 1.0, "other": 0.0})]

    def estimate(self) -> Estimate:
        return Estimate(self.passes(), self.outputs, decides=self.decides)


class Marks(Filter):
    """Writes 0.25, so that the result shows where the filter is drawn."""

    name = "marks"

    def reach(self) -> int | None:
        return 2

    def passes(self, formats: Mapping[str, str]) -> list[Pass]:
        text = '#include "lib/sources.glsl"\nvoid main() { for (int i = 0; i < sources; ++i) results[i] = vec4(0.25); }'
        return [over_sources("filter", text, formats)]


@pytest.fixture(scope="module")
def wall() -> aolab.Scene:
    """A surface at every pixel."""
    camera = aolab.Camera(eye=(0, 0, 5), target=(0, 0, 0))
    return small_scenes.of(small_scenes.quad((-9, -9, 0), (18, 0, 0), (0, 18, 0)), camera=camera)


def spots() -> np.ndarray:
    """Which pixels are spots, row 0 at the bottom."""
    there = np.zeros(SIZE[::-1], bool)
    there[tuple(np.transpose(SPOTS)[::-1])] = True
    return there


def test_a_filter_is_drawn_where_values_differ_within_its_reach(lab, wall):
    if not context.is_software():
        pytest.skip("on hardware, filters are drawn everywhere")
    frame = lab.render(wall, Spots(filter=Marks()), size=SIZE)
    differs = np.pad(maximum_filter(spots(), 5), [(0, -side % PIXELS) for side in SIZE[::-1]])
    tiles = differs.reshape(differs.shape[0] // PIXELS, PIXELS, -1, PIXELS).any(axis=(1, 3))
    assert 4 < tiles.sum() < 20
    drawn = tiles.repeat(PIXELS, 0).repeat(PIXELS, 1)[: SIZE[1], : SIZE[0]][::-1, :, None]
    for name in Spots.outputs:
        expected = np.where(drawn, 0.25, frame.channels(f"{name}_raw"))
        np.testing.assert_array_equal(frame.channels(name), expected, err_msg=name)


class Undecided(Spots):
    """Filtered everywhere."""

    decides: ClassVar = ""


def test_no_output_decides_or_no_reach_and_the_filter_is_drawn_everywhere(lab, wall):
    class AnyReach(Marks):
        name = "any_reach"

        def reach(self) -> int | None:
            return None

    for module in (Undecided(filter=Marks()), Spots(filter=AnyReach())):
        np.testing.assert_array_equal(lab.render(wall, module, size=SIZE).channels("spots"), 0.25)


@pytest.mark.parametrize("filter", ["box4", "bilateral", "wendland"])
def test_a_filter_changes_nothing_beyond_its_reach(lab, wall, filter):
    module = Undecided(filter=filter)
    chosen = module.chosen("filter")
    assert isinstance(chosen, Filter)
    assert (reach := chosen.reach())
    frame = lab.render(wall, module, size=SIZE)
    changed = frame.channels("other").any(axis=-1)[::-1]
    assert changed.sum() > 2 * len(SPOTS)
    assert not (changed & np.logical_not(maximum_filter(spots(), 2 * reach + 1))).any()
    tiled = lab.render(wall, Spots(filter=filter), size=SIZE)
    for name in Spots.outputs:
        np.testing.assert_array_equal(tiled.channels(name), frame.channels(name), err_msg=name)


@pytest.mark.parametrize("filter", ["box4", "wendland"])
@pytest.mark.parametrize("scale", [0.37, 0.5, 0.95])
def test_tiles_change_no_upsampled_result(lab, wall, filter, scale):
    frame = lab.render(wall, Undecided(filter=filter, scale=scale), size=SIZE)
    tiled = lab.render(wall, Spots(filter=filter, scale=scale), size=SIZE)
    for name in Spots.outputs:
        np.testing.assert_array_equal(tiled.channels(name), frame.channels(name), err_msg=name)
    assert 0 < frame.channels("other").any(axis=-1).mean() < 0.5
