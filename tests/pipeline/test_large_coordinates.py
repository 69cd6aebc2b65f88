"""A scene far from the origin looks as it does at the origin: shaders compute around its centre."""

from dataclasses import replace

import numpy as np
import pytest
import small_scenes
import trimesh

import aolab
from aolab import Camera, Instance, PointLight, Scene, SpotLight

FAR = np.array([500_000.0, 120.0, 4_000_000.0])  # map coordinates: float32 has steps of a quarter there


def there(camera: Camera) -> Camera:
    return replace(camera, eye=tuple(FAR + camera.eye), target=tuple(FAR + camera.target))


def moved(scene: Scene) -> Scene:
    """Everything of a scene that has a place, moved by `FAR`."""
    matrix = np.eye(4)
    matrix[:3, 3] = FAR
    lights = tuple(replace(light, position=tuple(FAR + light.position)) for light in scene.lights)
    instances = tuple(Instance(one.mesh, matrix @ one.world_from_local) for one in scene.instances)
    return Scene(instances, lights, scene.environment, there(scene.camera))


@pytest.mark.parametrize("module", ["ssao", "ssdo", "s3ho"])
def test_pictures_are_the_same(lab, module):
    lights = PointLight((2, 4, 3), (30, 30, 30)), SpotLight((-3, 4, 1), (3, -4, -1), (40, 20, 20))
    near = small_scenes.boxes(lights=lights)
    here, far = (lab.render(scene, module, size=(64, 48)) for scene in (near, moved(near)))
    np.testing.assert_allclose(far["viewZ"], here["viewZ"], rtol=1e-5)
    np.testing.assert_allclose(far["direct"], here["direct"], atol=0.01)
    assert (np.abs(far.image.astype(int) - here.image) > 2).mean() < 0.005


def test_rays_are_the_same():
    near = small_scenes.boxes()
    options = {"size": (32, 24), "rays": 32, "like": "ssao", "buffers": "visibility", "cache": False}
    here, far = (aolab.reference(scene, **options)["visibility"] for scene in (near, moved(near)))
    assert np.nanmean(np.abs(far - here)) < 0.002


def test_a_trimesh_far_away(lab):
    """Its vertices are float64; the mesh is moved to its own centre, before they become float32."""
    shape = trimesh.creation.icosphere(3)
    here = aolab.load(shape)
    far = aolab.load(trimesh.Trimesh(shape.vertices + FAR, shape.faces, process=False))
    np.testing.assert_allclose(far.bounds, here.bounds + FAR, rtol=1e-12)
    pictures = [
        lab.render(scene, "none", size=(48, 48), camera=camera)["viewNormal"]
        for scene, camera in ((here, Camera((0, 0, 3), (0, 0, 0))), (far, there(Camera((0, 0, 3), (0, 0, 0)))))
    ]
    np.testing.assert_allclose(*pictures, atol=0.01)
