"""The white furnace: under a sky of radiance 1, white surfaces send 1 at most. Holds for every module, new ones too."""

from typing import Any

import numpy as np
import pytest
import small_scenes
from module_settings import contexts

from aolab import Scene
from aolab.modules import MODULES, Module

pytestmark = [
    pytest.mark.filterwarnings("ignore:.* meshes are not closed:aolab.errors.Notice"),  # nor is a floor
    pytest.mark.filterwarnings("ignore:.* has no height map:aolab.errors.Notice"),
]

HALF = 2e-3  # roundings to half floats
LIGHTS = {"environment_vpl": 0.025}  # a sum over lights in place of the integral over a constant sky


@pytest.fixture(scope="module")
def furnace(wall) -> Scene:
    """A white floor, wall and box; in the corners between them a bounce may exceed the light."""
    meshes = [instance.mesh for instance in wall.instances]
    return small_scenes.of(*meshes, small_scenes.box((0.3, 0, -0.5), (1, 0.7, 0.3)), camera=wall.camera)


def physical(module: type[Module]) -> list[dict[str, Any]]:
    """The defaults, and one or two other choices, without patches, which make energy as printed."""
    return [way for way in contexts(module, "") if way.get("senders") != "patches" and not way.get("near_field")]


def bounces(module: type[Module]) -> list[dict[str, Any]]:
    """Each single choice that turns a bounce on; none, for a module that always has one."""
    if module().sends():
        return [{}]
    return [way for way in physical(module) if len(way) == 1 and module(**way).sends()]


BOUNCING = [name for name, module in MODULES.items() if bounces(module)]


def radius_of(name: str) -> dict[str, float]:
    return {"radius": 1.0} if "radius" in MODULES[name].model_fields else {}


@pytest.mark.parametrize("name", MODULES)
def test_nothing_sends_more_than_there_is(lab, furnace, name):
    for way in physical(MODULES[name]):
        light = lab.render(furnace, name, **radius_of(name), **way)
        # this filter weighs by the value, so that it mixes the ambient light and the bounce with different weights
        more = 0.05 if way.get("filter") == "wendland" else 0
        assert light["radiance"][light.mask].max() <= 1 + HALF + LIGHTS.get(name, 0) + more, way
        assert light["radiance"][light.mask].min() >= 0, way


@pytest.mark.parametrize("name", BOUNCING)
def test_more_samples_send_no_more(lab, furnace, name):
    for way in bounces(MODULES[name]):
        for samples in ({"directions": 16, "steps": 8}, {"directions": 64, "steps": 16, "filter": "none"}):
            light = lab.render(furnace, name, **radius_of(name), **samples, **way)
            assert light["radiance"][light.mask].max() <= 1 + HALF, (way, samples)


@pytest.mark.parametrize("name", BOUNCING)
def test_a_bounce_replaces_most_of_the_blocked_light(lab, furnace, name):
    """More than half of the light that is missing in dark corners."""
    for way in bounces(MODULES[name]):
        frame = lab.render(furnace, name, size=(128, 96), directions=16, steps=8, **radius_of(name), **way)
        dark = frame.mask & (frame["ambient"][..., 0] < np.quantile(frame["ambient"][frame.mask], 0.05))
        assert dark.sum() > 100
        assert frame["indirect"][dark].mean() > 0.5 * (1 - frame["ambient"][dark]).mean(), way


@pytest.mark.parametrize("strength", [0.3, 1.0, 10.0])
def test_an_occluder_that_lets_light_through_reflects_the_rest(lab, furnace, strength):
    """S3HO's strength: 1 - 1/(1 + λ d) of the light passes, and 1/(1 + λ d) of the direction is the sender's."""
    settings: dict = {"radius": 1.0, "directions": 16, "steps": 8, "size": (128, 96), "filter": "none"}
    frame = lab.render(furnace, "s3ho", indirect=True, strength=strength, **settings)
    assert frame["radiance"][frame.mask].max() <= 1 + HALF
    on_the_floor = frame.mask & (frame.world_normal()[..., 1] > 0.9)
    assert np.median(frame["radiance"][on_the_floor]) > 0.99  # floor and wall face each other: nothing is lost


@pytest.mark.parametrize("way", [{"name": "ssdo", "bounces": 1}, {"name": "s3ho", "indirect": True}])
def test_patches_make_energy(lab, furnace, way):
    """More than 1, and more with more directions, as the pages of both modules state."""
    name, bounce = way["name"], {key: value for key, value in way.items() if key != "name"}
    largest = []
    for directions, steps in ((8, 4), (16, 8)):
        settings = {"directions": directions, "steps": steps, "radius": 1.0, "senders": "patches", "size": (128, 96)}
        frame = lab.render(furnace, name, **settings, **bounce)
        largest.append(np.percentile(frame["radiance"][frame.mask], 99))
    assert 1.05 < largest[0] < largest[1]
