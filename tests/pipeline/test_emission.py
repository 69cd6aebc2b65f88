"""Emission is drawn, and lights other surfaces: in modules, in the truth, past all kinds of occluders."""

from dataclasses import replace

import numpy as np
import pytest
import small_scenes
from small_scenes import box, quad

import aolab
from aolab import Camera, Environment, Material

DARK = Environment.constant((0.0, 0.0, 0.0))
GLOW = (2.0, 1.0, 0.5)
SIZE = (64, 48)


def glowing_wall() -> aolab.Scene:
    """A grey floor, and a black wall up to x = 0 that glows; there is no other light."""
    floor = quad((0, 0, 3), (3, 0, 0), (0, 0, -6), Material((0.8, 0.8, 0.8)))
    wall = box((-0.4, 0, -3), (0, 1, 3), Material((0.0, 0.0, 0.0), emission=GLOW))
    return small_scenes.of(floor, wall, camera=Camera((3, 2.5, 0), (0.5, 0.2, 0), fov=60), sky=DARK)


def test_it_is_drawn(lab):
    frame = lab.render(glowing_wall(), "none", size=SIZE)
    wall = frame.mask & (frame["albedo"].max(axis=2) == 0)
    np.testing.assert_allclose(frame["radiance"][wall], np.tile(GLOW, (wall.sum(), 1)), rtol=1e-3)
    assert frame["radiance"][frame.mask & ~wall].max() == 0
    truth = aolab.reference(glowing_wall(), size=SIZE, rays=2, buffers="radiance", cache=False)
    np.testing.assert_allclose(truth["radiance"][wall], np.tile(GLOW, (wall.sum(), 1)), rtol=1e-3)


def test_the_truth_has_the_light_of_a_wide_ceiling():
    """Under a ceiling that fills the hemisphere but for 1e-4 of its cosine, the radiance is albedo × emission."""
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1), Material((0.5, 0.5, 0.5)))
    ceiling = quad((-100, 1, -100), (200, 0, 0), (0, 0, 200), Material((0.0, 0.0, 0.0), emission=GLOW))
    scene = small_scenes.of(floor, ceiling, camera=Camera((0.5, 0.5, 0.5), (0, 0, 0)), sky=DARK)
    truth = aolab.reference(scene, size=(16, 12), rays=64, buffers="indirect", cache=False)
    floor_seen = truth["albedo"][..., 0] > 0
    np.testing.assert_allclose(
        truth["indirect"][floor_seen], np.tile(np.multiply(GLOW, 0.5), (floor_seen.sum(), 1)), rtol=0.02
    )


@pytest.mark.filterwarnings("ignore::aolab.Notice")  # the meshes are not closed
@pytest.mark.parametrize("occluders", ["depth", "layers", "views"])
def test_ssdo_sends_it(lab, occluders):
    options = {"radius": 1.5, "directions": 64, "steps": 16, "accumulate": 4, "bounces": 1, "occluders": occluders}
    frame = lab.render(glowing_wall(), "ssdo", size=SIZE, **options)
    truth = aolab.reference(glowing_wall(), like=frame, rays=256, buffers="indirect", cache=False)
    lit = truth["indirect"].sum(axis=2) > 0.05
    assert lit.mean() > 0.1
    measured, right = frame["indirect"][lit], truth["indirect"][lit]
    assert measured.mean() == pytest.approx(right.mean(), rel=0.25 if occluders == "views" else 0.15)
    np.testing.assert_allclose(measured.mean(axis=0) / measured.mean(), np.divide(GLOW, np.mean(GLOW)), rtol=0.01)


@pytest.mark.parametrize(("module", "options"), [("s3ho", {"indirect": True}), ("rsm", {}), ("instant_radiosity", {})])
def test_modules_state_that_they_do_not_send_it(lab, module, options):
    scene = glowing_wall().replace(lights=(aolab.DirectionalLight((0, 1, 0)),))  # from below: it lights no front
    with pytest.warns(aolab.Notice, match=f"{module}: .* the emission of surfaces lights no others"):
        frame = lab.render(scene, module, size=SIZE, **options)
    assert frame["indirect"][frame.mask & (frame["albedo"].max(axis=2) > 0)].max() < 0.01


def test_hidden_surfaces_send_it(lab):
    """The wall is seen from behind a screen in front of it: a further view sees it, the camera does not."""
    scene = glowing_wall()
    screen = quad((0.9, 0.35, 3), (0, 0, -6), (0, 2, 0), Material((0.0, 0.0, 0.0)))
    hidden = scene.replace(instances=(*scene.instances, aolab.Instance(screen)))
    camera = Camera((3, 0.9, 0), (0, 0.2, 0), fov=50)
    means = {}
    for occluders in ("depth", "views"):
        frame = lab.render(
            hidden, "ssdo", camera=camera, size=SIZE, radius=1.5, directions=64, bounces=1, occluders=occluders
        )
        means[occluders] = float(frame["indirect"].mean())
    assert means["views"] > 1.1 * means["depth"]


def test_a_scene_without_emission_draws_none(lab):
    scene = glowing_wall()
    dark = [
        replace(one, mesh=replace(one.mesh, material=replace(one.mesh.material, emission=(0.0, 0.0, 0.0))))
        for one in scene.instances
    ]
    frame = lab.render(scene.replace(instances=dark), "ssdo", bounces=1, size=SIZE)
    assert "emission" not in frame
    assert frame["indirect"].max() == 0
