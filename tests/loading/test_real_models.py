"""Models that people use, where the folder with them lies beside the checkout."""

from pathlib import Path

import numpy as np
import pytest

import aolab

MODELS = Path(__file__).parents[3] / "shared" / "models"
pytestmark = pytest.mark.skipif(not MODELS.is_dir(), reason=f"no folder {MODELS}")


def test_bunny():
    scene = aolab.load(MODELS / "bunny.ply")
    (instance,) = scene.instances
    mesh = instance.mesh
    assert (len(mesh.faces), mesh.name, mesh.uv, mesh.material.texture) == (16301, "bunny", None, None)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-6)
    assert scene.radius == pytest.approx(0.126, abs=0.01)


def test_duck():
    scene = aolab.load(MODELS / "Duck.glb")
    mesh = scene.instances[0].mesh
    assert mesh.material.texture.pixels.shape == (512, 512, 4)
    assert mesh.material.base_color == (1, 1, 1)
    # the camera's node stands below one that scales by 0.01
    np.testing.assert_allclose(scene.camera.eye, (4.00113, 4.63264, -4.31078), atol=1e-5)
    assert scene.camera.fov == pytest.approx(np.degrees(0.66059255))
    np.testing.assert_allclose(scene.bounds[1], (0.9618, 1.6397, 0.5393), atol=1e-4)


def test_duck_uv_finds_the_beak():
    """The texel at the UV of the foremost vertex is the beak's orange, which it is not with v upside down."""
    mesh = aolab.load(MODELS / "Duck.glb").instances[0].mesh
    pixels = mesh.material.texture.pixels
    u, v = mesh.uv[np.argmax(mesh.vertices[:, 0])]
    red, green, blue, _ = pixels[int((1 - v) * 512) % 512, int(u * 512) % 512].tolist()
    assert red > 180
    assert green < 0.75 * red
    assert blue < 0.35 * red


def test_milk_truck():
    scene = aolab.load(MODELS / "CesiumMilkTruck.glb")
    wheels = [instance for instance in scene.instances if instance.mesh.name == "Wheels"]
    assert len(scene.instances) == 5
    assert wheels[0].mesh is wheels[1].mesh
    assert sorted(round(wheel.world_from_local[0, 3], 3) for wheel in wheels) == [-1.352, 1.433]
    glass = next(instance.mesh.material for instance in scene.instances if instance.mesh.material.name == "glass")
    assert glass.base_color == (0.0, 0.04050629958510399, 0.021240700036287308)
    textures = {
        id(instance.mesh.material.texture.pixels) for instance in scene.instances if instance.mesh.material.texture
    }
    assert len(textures) == 1


def test_fuze():
    mesh = aolab.load(MODELS / "fuze.obj").instances[0].mesh
    assert mesh.material.texture.name == "fuze uv.jpg"
    assert mesh.material.base_color == (1, 1, 1)
    assert mesh.uv is not None


def test_spot():
    mesh = aolab.load(MODELS / "spot.obj").instances[0].mesh
    assert len(mesh.faces) == 5856
    assert mesh.uv is not None
    assert mesh.material.base_color == (0.8, 0.8, 0.8)
