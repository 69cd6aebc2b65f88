"""The picture of a single pass is the picture of the plain passes."""

from dataclasses import replace

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, Environment, Instance
from aolab.gl.program import Programs
from aolab.modules import MODULES, Module
from aolab.pipeline.lighting import in_one_pass
from aolab.pipeline.plan import Plan

SIZE = (48, 32)
LAMPS = (
    aolab.DirectionalLight((-0.4, -1.0, -0.3), (1.5, 1.2, 0.9)),
    aolab.SpotLight((2, 3, 2), (-0.5, -1, -0.5), (20.0, 10.0, 5.0)),
    aolab.PointLight((-1, 2, 1), (3.0, 4.0, 5.0)),
)
PLAIN = {"direct", "ambient", "compose"}
OPTIONS = [
    *((name, {}) for name in MODULES),
    ("s3ho", {"lights": "sharp"}),
    ("ssdo", {"estimator": "plain"}),
    ("ssbn", {"weighting": "uniform"}),
    ("ssao", {"scale": 0.5}),
]


def scene(camera: Camera | None = None) -> aolab.Scene:
    """Boxes under three lamps and a sky with a sun; one box glows. Sky is seen past the floor."""
    lit = small_scenes.boxes(camera or Camera(eye=(0.5, 1.5, 9), target=(0, 1.2, 0), fov=45), LAMPS)
    *others, last = lit.instances
    glowing = replace(last.mesh, material=replace(last.mesh.material, emission=(2.0, 1.0, 0.2)))
    return lit.replace(instances=(*others, Instance(glowing)), environment=Environment.sky())


def plan(module: Module) -> Plan:
    return Plan(module, Programs().declared)


def check(frame: aolab.Frame, plain: aolab.Frame) -> None:
    """The compilers may round the two differently: at most a code of 255 apart."""
    picture = frame.image
    assert set(frame.timings) & {"image", *PLAIN} == {"image"}
    assert set(plain.complete().timings) >= PLAIN
    assert "image" not in plain.timings
    assert 0.1 < frame.mask.mean() < 0.95
    np.testing.assert_allclose(picture.astype(int), plain.image, atol=1)


@pytest.mark.filterwarnings("ignore::aolab.Notice")  # the bulb has no reflective shadow map
@pytest.mark.parametrize(("name", "options"), OPTIONS, ids=[f"{name} {options}" for name, options in OPTIONS])
def test_it_is_that_of_the_plain_passes(lab, name, options):
    module = MODULES[name](**options)
    if not in_one_pass(plan(module)):
        assert "image" not in lab.render(scene(), module, size=SIZE).complete("image").timings
        return
    check(lab.render(scene(), module, size=SIZE), lab.render(scene(), module, size=SIZE))


def test_these_methods_have_it():
    without = {"rsm", "environment_vpl", "instant_radiosity"}
    assert {name for name, module in MODULES.items() if not in_one_pass(plan(module()))} == without


@pytest.mark.parametrize(
    "settings",
    [
        {"camera": Camera((3, 0.5, 6), (0, 0.8, 0), ortho=5.0)},
        {"exposure": 0.3, "tone_map": "linear"},
        {"seed": 3, "accumulate": 3},
    ],
)
def test_of_every_view_and_display(lab, settings):
    check(*(lab.render(scene(), "ssao", size=SIZE, **settings) for _ in range(2)))


def test_steps_that_read_each_other_stay_plain(lab):
    """A bounce reads the light, and so may a step of the module's own."""
    assert not in_one_pass(plan(MODULES["ssdo"](bounces=1)))
    assert not in_one_pass(plan(MODULES["ssao"](fill=4)))
    assert not in_one_pass(plan(MODULES["ambient_transfer"](albedo_source="radiance")))
    assert not in_one_pass(plan(MODULES["s3ho"](indirect=True)))

    class Red(aolab.SSAO):
        def lighting(self):
            direct, ambient = super().lighting()
            red = "out vec4 ambient;\nvoid main() { ambient = vec4(1.0, 0.0, 0.0, 1.0); }\n"
            return [direct, aolab.Pass("ambient", red, ambient.outputs)]

    frame = lab.render(scene().replace(lights=()), Red(), size=SIZE, tone_map="linear")
    assert not in_one_pass(plan(Red()))
    inside = frame.mask & (frame["radiance"].max(axis=2) <= 1)
    assert inside.any()
    np.testing.assert_array_equal(frame.image[inside], np.tile((255, 0, 0), (inside.sum(), 1)))


def test_complete_computes_what_is_named(lab):
    frame = lab.render(scene(), "ssao", size=SIZE)
    assert not {"image", *PLAIN} & set(frame.complete("visibility").timings)
    assert not PLAIN & set(frame.complete("image").timings)
    before = frame.image.copy()
    assert set(frame.complete("image", "ambient").timings) >= {"image", *PLAIN}
    np.testing.assert_array_equal(frame.image, before)


def test_the_sky_of_a_still_camera_is_drawn_once():
    """The first picture draws the background alone, the second a whole sky, which is copied from then on."""
    lab, lit = aolab.Lab(SIZE), scene()
    first, second, third = (lab.render(lit, "ssao").image for _ in range(3))
    np.testing.assert_array_equal(second, first)
    np.testing.assert_array_equal(third, first)
    fewer = lit.replace(instances=lit.instances[:-2])  # where these were, sky is seen
    other = lit.replace(camera=replace(lit.camera, eye=(1.0, 1.5, 9)))
    night = lit.replace(environment=Environment.constant((0.02, 0.03, 0.1)))
    for changed, settings in ((fewer, {}), (other, {}), (night, {}), (lit, {"exposure": 0.5}), (lit, {})):
        for _ in range(3):
            fresh = aolab.Lab(SIZE).render(changed, "ssao", **settings).image
            np.testing.assert_array_equal(lab.render(changed, "ssao", **settings).image, fresh)
