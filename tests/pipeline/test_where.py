"""Passes that are drawn over surfaces, or over tiles of the picture, give the values of the passes over all pixels."""

from dataclasses import replace

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, Environment
from aolab.modules import MODULES
from aolab.modules.estimate import Estimate

SIZE = (99, 69)  # the last tiles of a row have 3 pixels, those of a column 5
DRAWN_THERE = [
    name for name, module in MODULES.items() if module.shader and any(p.background for p in module().passes())
]
FILTERS = "none", "box4", "bilateral", "wendland"


def scene() -> aolab.Scene:
    """Boxes on a floor, with background above and at one side."""
    return small_scenes.boxes(Camera(eye=(0.5, 1.5, 9), target=(1.5, 1.8, 0), fov=45)).replace(
        environment=Environment.sky()
    )


def over_all(lab: aolab.Lab, monkeypatch, module: aolab.Module, **options) -> aolab.Frame:
    """The frame of passes that know no background."""
    whole = type(module).estimate

    def estimate(self: aolab.Module) -> Estimate:
        made = whole(self)
        return replace(made, passes=[replace(one, background={}) for one in made.passes])

    with monkeypatch.context() as patch:
        patch.setattr(type(module), "estimate", estimate)
        return lab.render(scene(), module, size=SIZE, **options).complete()


def test_these_methods_are_drawn_there():
    assert set(DRAWN_THERE) == {"ssao", "ssbn", "s3ho", "instant_radiosity"}


@pytest.mark.parametrize("filter", FILTERS)
@pytest.mark.parametrize("name", DRAWN_THERE)
def test_buffers_are_those_of_passes_over_all_pixels(lab, monkeypatch, name, filter):
    module = MODULES[name](radius=1.0, filter=filter, **({"indirect": True} if name == "s3ho" else {}))
    plain = over_all(lab, monkeypatch, module)
    lab.render(scene(), "none", size=SIZE).complete()  # other values in the textures that the pool lends
    fast = lab.render(scene(), module, size=SIZE).complete()
    assert 0.1 < fast.mask.mean() < 0.9
    for buffer in module.estimate().outputs:
        for one in (buffer, f"{buffer}_raw"):
            np.testing.assert_array_equal(fast.channels(one), plain.channels(one), err_msg=one)


def test_averaged_frames_are_those_of_passes_over_all_pixels(lab, monkeypatch):
    module = aolab.SSAO(radius=1.0)
    plain = over_all(lab, monkeypatch, module, accumulate=3)
    fast = lab.render(scene(), module, size=SIZE, accumulate=3)
    np.testing.assert_array_equal(fast.channels("visibility"), plain.channels("visibility"))


def test_a_subclass_with_its_own_shader_decides_about_the_background(lab):
    class Half(aolab.SSAO):
        shader = "out float visibility; void main() { visibility = 0.5; }"

    class Quarter(aolab.SSBN):
        shader = "out vec4 blocked_direction; void main() { blocked_direction = vec4(0.25); }"

    np.testing.assert_array_equal(lab.render(scene(), Half(), size=SIZE).channels("visibility"), 0.5)
    np.testing.assert_array_equal(lab.render(scene(), Quarter(), size=SIZE).channels("blocked_direction"), 0.25)


@pytest.mark.parametrize("far", [None, 5.0])
def test_a_surface_at_the_far_plane_is_a_surface(lab, far):
    wall = small_scenes.of(small_scenes.quad((-9, -9, 0), (18, 0, 0), (0, 18, 0)))
    frame = lab.render(wall, "ssao", camera=Camera(eye=(0, 0, 5), target=(0, 0, 0), near=0.1, far=far), size=SIZE)
    assert frame.mask.all()
    picture = frame.image.copy()
    assert frame.complete().timings["direct"] >= 0
    np.testing.assert_allclose(
        picture.astype(int), lab.render(wall, "ssao", camera=frame.camera, size=SIZE).complete().image, atol=1
    )


def test_a_picture_after_another_frame_is_its_own(lab):
    module = aolab.SSAO(radius=1.0)
    expected = lab.render(scene(), module, size=SIZE).image
    waiting = lab.render(scene(), module, size=SIZE)
    lab.render(scene(), module, size=SIZE, camera=Camera(eye=(0, 9, 0.1), target=(0, 0, 0))).complete("image")
    np.testing.assert_array_equal(waiting.image, expected)
