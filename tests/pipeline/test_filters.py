"""Filters keep constants, mix no two surfaces and remove noise; and the estimate at a lower resolution."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, Material, Module, parameter

FILTERS = ["box4", "bilateral"]


class Pattern(Module):
    """A known picture in place of visibility: a constant, or each pixel's interleaved set, or the albedo's red."""

    name = "pattern"
    kind: int = parameter(0, "0: value; 1: set / 16; 2: red.", ge=0, le=2)
    value: float = parameter(0.625, "The constant.", ge=0, le=1)
    shader = """
#include "lib/sampling.glsl"
const int kind;
uniform float value;
uniform sampler2D albedo;
out float visibility;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (kind == 0) visibility = value;
    else if (kind == 1) visibility = float(interleavedSet(pixel)) / 16.0;
    else visibility = texelFetch(albedo, pixel, 0).r;
}
"""


def steps(camera: Camera | None = None) -> aolab.Scene:
    """A red shelf half a unit before a black wall: a depth gap, across which nothing may bleed."""
    shelf = small_scenes.box((-1, -1, 0), (1, 1, 0.5), Material((1.0, 0.0, 0.0)))
    back = small_scenes.quad((-6, -6, -1), (12, 0, 0), (0, 12, 0), Material((0.0, 0.0, 0.0)))
    return small_scenes.of(back, shelf, camera=camera or Camera((0, 0, 6), (0, 0, 0), fov=50))


@pytest.mark.parametrize("filter", FILTERS)
@pytest.mark.parametrize("scale", [1.0, 0.5, 0.2])
def test_a_constant_stays_what_it_is(lab, boxes, filter, scale):
    frame = lab.render(boxes, Pattern(filter=filter, scale=scale), size=(65, 43))
    np.testing.assert_allclose(frame["visibility"][frame.mask], 0.625, atol=2e-3)


@pytest.mark.parametrize("filter", ["none", *FILTERS])
@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_nothing_bleeds_across_a_depth_gap(lab, filter, scale):
    frame = lab.render(steps(), Pattern(kind=2, filter=filter, scale=scale), size=(64, 64))
    red = frame["albedo"][..., 0]
    assert 0.1 < red.mean() < 0.9
    np.testing.assert_array_equal(frame["visibility"], red)


@pytest.mark.parametrize("filter", FILTERS)
def test_nothing_bleeds_around_a_sharp_edge_between_two_faces(lab, filter):
    """Two walls meet at 90°: the filters tell them apart by the normal."""
    left = small_scenes.quad((-3, -3, 0), (3, 0, -3), (0, 6, 0), Material((1.0, 0.0, 0.0)))
    right = small_scenes.quad((0, -3, -3), (3, 0, 3), (0, 6, 0), Material((0.0, 0.0, 0.0)))
    scene = small_scenes.of(left, right, camera=Camera((0, 0, 5), (0, 0, 0)))
    frame = lab.render(scene, Pattern(kind=2, filter=filter), size=(64, 48))
    seen = frame.mask
    np.testing.assert_allclose(frame["visibility"][seen], frame["albedo"][..., 0][seen], atol=1e-3)  # of half floats


@pytest.mark.parametrize("filter", FILTERS)
@pytest.mark.parametrize("camera", [Camera((0, 5, 5), (0, 0, 0)), Camera((1, 2, 6), (0, 0, 0), up=(0.2, 1, 0))])
def test_the_interleaved_pattern_cancels_on_a_plane(lab, filter, camera):
    """Every window contains each of the 16 sets equally often: their mean, 15/32, is all that is left."""
    frame = lab.render(small_scenes.plane(camera), Pattern(kind=1, filter=filter), size=(64, 48))
    inside = np.zeros((48, 64), bool)
    inside[24:-5, 5:-5] = True  # at the image's border a window holds some pixels twice
    assert frame.mask[inside].all()
    np.testing.assert_allclose(frame["visibility"][inside], 15 / 32, atol=0.02 if filter == "bilateral" else 2e-3)
    assert frame["visibility_raw"][inside].std() > 0.25


def test_box4_is_the_mean_of_a_window_that_ends_at_the_edge(lab):
    """On a wall that faces the camera: rows and columns from -1 to 2, as far as the picture reaches."""
    wall = small_scenes.of(small_scenes.quad((-9, -9, 0), (18, 0, 0), (0, 18, 0)), camera=Camera((0, 0, 4), (0, 0, 0)))
    frame = lab.render(wall, Pattern(kind=1), size=(9, 7))
    raw, filtered = frame["visibility_raw"][::-1], frame["visibility"][::-1]  # counted from the lowest row
    for y, x in np.ndindex(raw.shape):
        window = raw[max(y - 1, 0) : y + 3, max(x - 1, 0) : x + 3]
        assert filtered[y, x] == pytest.approx(window.mean(), abs=2e-3)


@pytest.mark.parametrize("filter", FILTERS)
def test_filters_remove_the_noise_of_an_estimate(lab, wall, filter):
    settings = {"radius": 1.5, "directions": 4, "steps": 4, "thickness": 10.0}
    truth = lab.render(wall, "ssao", filter="none", accumulate=64, size=(96, 72), **settings)["visibility"]
    frame = lab.render(wall, "ssao", filter=filter, size=(96, 72), **settings)
    x, y, _ = np.moveaxis(small_scenes.world_positions(frame, wall.camera), -1, 0)
    floor = (np.abs(y) < 1e-3) & (x > 0.3) & (x < 1.4)
    noise = {name: np.sqrt(((frame[name] - truth)[floor] ** 2).mean()) for name in ("visibility_raw", "visibility")}
    assert noise["visibility"] < 0.5 * noise["visibility_raw"]


def test_the_background_takes_no_part(lab):
    """A square before the sky: its border pixels are filtered among themselves."""
    scene = small_scenes.of(small_scenes.quad((-1, -1, 0), (2, 0, 0), (0, 2, 0)), camera=Camera((0, 0, 4), (0, 0, 0)))
    for filter in FILTERS:
        for scale in (1.0, 0.5):
            frame = lab.render(scene, Pattern, filter=filter, scale=scale, size=(40, 40))
            assert np.isnan(frame["visibility"][~frame.mask]).all()
            np.testing.assert_allclose(frame["visibility"][frame.mask], 0.625, atol=2e-3)


@pytest.mark.parametrize("size", [(1, 1), (2, 1), (1, 5), (3, 3)])
def test_windows_larger_than_the_image(lab, boxes, size):
    camera = Camera((0, 4, 0.01), (0, 0, 0), fov=60)
    for filter in FILTERS:
        for scale in (1.0, 0.5, 0.125):
            frame = lab.render(boxes, Pattern, filter=filter, scale=scale, size=size, camera=camera)
            np.testing.assert_allclose(frame["visibility"], 0.625, atol=2e-3)


def test_half_resolution_is_close_to_full(lab, boxes):
    settings = {"radius": 0.6, "directions": 32, "steps": 8, "size": (160, 120)}
    full, half = (lab.render(boxes, "ssao", scale=scale, **settings) for scale in (1.0, 0.5))
    assert half["visibility_raw"].shape == (60, 80)
    assert half["visibility"].shape == (120, 160)
    error = (half["visibility"] - full["visibility"])[full.mask]
    assert np.sqrt((error**2).mean()) < 0.03
    assert abs(error.mean()) < 0.01
    assert (full["visibility"][full.mask] < 0.9).mean() > 0.05  # there is something to compare


def test_upsampling_follows_the_full_size_silhouettes(lab):
    """At a fifth of the resolution, the red shelf's edge is still at the edge of the full-size depth, to the pixel."""
    frame = lab.render(steps(), Pattern(kind=2, filter="none", scale=0.2), size=(80, 80))
    np.testing.assert_allclose(frame["visibility"], frame["albedo"][..., 0], atol=1 - small_scenes.OPEN)


class Many(Module):
    """Six buffers, more than a pass takes: the noise pattern, each at its own level."""

    name = "many"
    outputs = {"visibility": "R16F", **{f"level{i}": "RGBA16F" for i in range(5)}}  # noqa: RUF012
    shader = """
#include "lib/sampling.glsl"
layout(location = 0) out float visibility;
layout(location = 1) out vec4 level0;
layout(location = 2) out vec4 level1;
layout(location = 3) out vec4 level2;
layout(location = 4) out vec4 level3;
layout(location = 5) out vec4 level4;
void main() {
    float noise = float(interleavedSet(ivec2(gl_FragCoord.xy))) / 16.0;
    visibility = noise;
    level0 = vec4(noise, 0.0, 0.0, 1.0);
    level1 = vec4(0.0, noise, 0.25, 0.0);
    level2 = vec4(0.5);
    level3 = vec4(noise, 0.5, noise, 0.5);
    level4 = vec4(0.0, 0.0, 0.0, noise);
}
"""


@pytest.mark.parametrize("settings", [{"filter": "box4"}, {"filter": "bilateral"}, {"scale": 0.5}, {"accumulate": 3}])
def test_many_buffers_are_treated_as_each_would_be_alone(lab, plane, settings):
    together = lab.render(plane, Many, **settings)
    inside = (slice(8, -8), slice(8, -8))
    noise = together["visibility"][inside]
    assert noise.std() < 0.5 * together["visibility_raw"].std()
    np.testing.assert_allclose(together["level0"][inside][..., 0], noise, atol=2e-3)
    np.testing.assert_allclose(together["level0"][inside][..., 1:] - (0, 0, 1), 0, atol=2e-3)
    np.testing.assert_allclose(together["level1"][inside][..., 1], noise, atol=2e-3)
    np.testing.assert_allclose(together["level1"][inside][..., 2], 0.25, atol=2e-3)
    np.testing.assert_allclose(together["level2"][inside], 0.5, atol=1e-3)
    np.testing.assert_allclose(together["level3"][inside][..., 2], noise, atol=2e-3)
    np.testing.assert_allclose(together["level4"][inside][..., 3], noise, atol=2e-3)


def test_a_crease_within_the_planes_tolerance_is_still_two_surfaces(lab):
    """Two walls meet at 90°, far away: there a pixel's step off a plane is within 0.2 % of the distance."""
    left = small_scenes.quad((-3, -3, 0), (3, 0, -3), (0, 6, 0), Material((1.0, 0.0, 0.0)))
    right = small_scenes.quad((0, -3, -3), (3, 0, 3), (0, 6, 0), Material((0.0, 0.0, 0.0)))
    far = small_scenes.of(left, right, camera=Camera((0, 0, 40), (0, 0, 0), fov=8))
    frame = lab.render(far, Pattern(kind=2, filter="box4"), size=(64, 64))
    np.testing.assert_allclose(frame["visibility"], frame["albedo"][..., 0], atol=1e-3)  # of half floats


@pytest.mark.parametrize(
    "settings", [{"filter": "box4"}, {"filter": "bilateral"}, {"filter": "none", "scale": 0.5}], ids=str
)
def test_surfaces_are_told_apart_by_a_step_of_a_fifth_of_a_percent_of_the_distance(lab, settings):
    """Two parallel walls side by side, one a little farther away: PLANE_TOLERANCE in glsl/lib/filter.glsl."""

    def mixed(step: float) -> float:
        """The largest share of one wall in a pixel of the other."""
        near = small_scenes.quad((-3, -3, 0), (3, 0, 0), (0, 6, 0), Material((1.0, 0.0, 0.0)))
        far = small_scenes.quad((0, -3, -5 * step), (3, 0, 0), (0, 6, 0), Material((0.0, 0.0, 0.0)))
        scene = small_scenes.of(near, far, camera=Camera((0, 0, 5), (0, 0, 0)))
        frame = lab.render(scene, Pattern(kind=2, **settings), size=(65, 48))
        return float(np.abs(frame["visibility"] - frame["albedo"][..., 0])[frame.mask].max())

    assert mixed(0.0015) > 0.15
    assert mixed(0.0025) < 1e-3
