"""Objects of pyrender, where it is installed; no GL is used."""

import numpy as np
import pytest
import trimesh

import aolab
from aolab.errors import Notice, SceneError
from aolab.scene.lights import DirectionalLight, PointLight

pyrender = pytest.importorskip("pyrender", reason="pyrender is an extra", exc_type=Exception)


def moved(x, y=0.0, z=0.0):
    return trimesh.transformations.translation_matrix([x, y, z])


def test_meshes_poses_and_instances():
    scene = pyrender.Scene()
    mesh = pyrender.Mesh.from_trimesh(trimesh.creation.box(), smooth=False, poses=np.stack([moved(0), moved(1)]))
    parent = scene.add(mesh, name="parent", pose=moved(0, 5))
    scene.add(mesh, name="child", pose=moved(0, 0, 3), parent_node=parent)
    instances = aolab.load(scene).instances
    places = [(instance.name, *instance.world_from_local[:3, 3]) for instance in instances]
    assert places == [("parent", 0, 5, 0), ("parent", 1, 5, 0), ("child", 0, 5, 3), ("child", 1, 5, 3)]
    assert len({id(instance.mesh) for instance in instances}) == 1
    np.testing.assert_allclose(np.abs(instances[0].mesh.normals).max(axis=1), 1)


def test_material_texture_and_colours():
    material = pyrender.MetallicRoughnessMaterial(
        baseColorFactor=[0.1, 0.2, 0.3, 1], alphaMode="MASK", alphaCutoff=0.25,
        baseColorTexture=np.full((2, 3, 3), 77, np.uint8),
    )  # fmt: skip
    corners = np.eye(3, dtype=np.float32)
    primitive = pyrender.Primitive(
        positions=corners, indices=[[0, 1, 2]], texcoord_0=corners[:, :2], color_0=corners, material=material, mode=4
    )
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh([primitive]))
    mesh = aolab.load(scene).instances[0].mesh
    np.testing.assert_allclose(mesh.material.base_color, (0.1, 0.2, 0.3), atol=1e-6)
    assert mesh.material.alpha_cutoff == 0.25
    assert mesh.material.texture.pixels[0, 0].tolist() == [77, 77, 77, 255]
    np.testing.assert_array_equal(mesh.colors[:, :3], corners)
    np.testing.assert_array_equal(mesh.uv, corners[:, :2])


def test_lights_camera_and_ambient():
    scene = pyrender.Scene(ambient_light=[0.1, 0.2, 0.3])
    scene.add(pyrender.Mesh.from_trimesh(trimesh.creation.box()))
    scene.add(pyrender.DirectionalLight(color=[1, 0.5, 0], intensity=2))
    scene.add(pyrender.PointLight(intensity=3), pose=moved(1, 2, 3))
    scene.add(pyrender.SpotLight(innerConeAngle=np.radians(10), outerConeAngle=np.radians(20)))
    scene.add(pyrender.PerspectiveCamera(yfov=np.radians(50)), pose=moved(0, 0, 9))
    loaded = aolab.load(scene)
    sun, bulb, spot = loaded.lights
    assert sun == DirectionalLight((0, 0, -1), (2, 1, 0))
    assert bulb == PointLight((1, 2, 3), (3, 3, 3))
    np.testing.assert_allclose([spot.inner, spot.outer], [10, 20])
    assert loaded.camera.fov == pytest.approx(50)
    assert loaded.camera.eye == (0, 0, 9)
    assert loaded.camera.near == pyrender.PerspectiveCamera(yfov=1).znear
    np.testing.assert_allclose(loaded.environment.radiance[0, 0], (0.1, 0.2, 0.3))


def test_points_are_left_out():
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh.from_points(np.eye(3)))
    with pytest.raises(SceneError, match="nothing can be drawn: 'mesh' holds no triangles"):
        aolab.load(scene)
    scene.add(pyrender.Mesh.from_trimesh(trimesh.creation.box()))
    with pytest.warns(Notice, match="left out: 'mesh' holds no triangles"):
        assert aolab.load(scene).triangles == 12


def test_other_pyrender_objects():
    with pytest.raises(SceneError, match=r"cannot draw a pyrender\.Mesh; give a pyrender\.Scene"):
        aolab.load(pyrender.Mesh.from_trimesh(trimesh.creation.box()))


def test_an_orthographic_camera():
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh.from_trimesh(trimesh.creation.box()))
    scene.add(pyrender.OrthographicCamera(xmag=3, ymag=2), pose=moved(0, 0, 9))
    assert aolab.load(scene).camera.ortho == 4
