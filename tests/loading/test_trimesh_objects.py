"""Objects of trimesh, and of aolab itself."""

import numpy as np
import pytest
import trimesh
from PIL import Image
from trimesh.visual.material import MultiMaterial, PBRMaterial, SimpleMaterial
from trimesh.visual.texture import TextureVisuals

import aolab
from aolab.errors import Notice, ParameterError, SceneError


def moved(x):
    return trimesh.transformations.translation_matrix([x, 0, 0])


def textured(material):
    mesh = trimesh.creation.box()
    mesh.visual = TextureVisuals(uv=np.zeros((8, 2)), material=material)
    return mesh


def test_a_scene_is_returned_as_it_is():
    scene = aolab.load(trimesh.creation.box())
    assert aolab.load(scene) is scene
    with pytest.raises(ParameterError, match="takes none"):
        aolab.load(scene, time=1)


def test_a_trimesh_gets_faceted_normals_and_our_default_material():
    scene = aolab.load(trimesh.creation.box())
    mesh = scene.instances[0].mesh
    assert scene.triangles == 12
    assert scene.source is None
    np.testing.assert_allclose(np.abs(mesh.normals).max(axis=1), 1)
    assert mesh.material.base_color == (0.8, 0.8, 0.8)


def test_normals_given_to_a_trimesh_are_kept():
    box = trimesh.creation.box()
    given = np.tile([0.48, 0.6, 0.64], (8, 1))
    mesh = trimesh.Trimesh(box.vertices, box.faces, vertex_normals=given, process=False)
    np.testing.assert_allclose(aolab.load(mesh).instances[0].mesh.normals, given, atol=1e-7)


def test_one_geometry_in_many_nodes_is_one_mesh():
    box = trimesh.creation.box()
    scene = trimesh.Scene()
    scene.add_geometry(box, node_name="left", transform=moved(-5), geom_name="box")
    scene.graph.update("middle", "left", matrix=moved(2), geometry="box")
    scene.graph.update("right", "world", matrix=moved(5), geometry="box")
    instances = aolab.load(scene).instances
    assert {instance.name: instance.world_from_local[0, 3] for instance in instances} == {
        "left": -5,
        "middle": -3,
        "right": 5,
    }
    assert len({id(instance.mesh) for instance in instances}) == 1


def test_the_camera_of_a_trimesh_scene():
    scene = trimesh.Scene(trimesh.creation.box())
    scene.camera = trimesh.scene.Camera(fov=(60, 40))
    scene.camera_transform = moved(3)
    camera = aolab.load(scene).camera
    assert camera.fov == 40
    assert camera.eye == (3, 0, 0)
    assert camera.target == (3, 0, -1)


def test_pbr_factors_are_linear_and_diffuse_colours_srgb():
    pbr = aolab.load(textured(PBRMaterial(baseColorFactor=[51, 255, 0, 102], alphaMode="MASK", alphaCutoff=0.3)))
    material = pbr.instances[0].mesh.material
    np.testing.assert_allclose(material.base_color, (0.2, 1, 0))
    assert (material.alpha, material.alpha_cutoff) == (pytest.approx(0.4), 0.3)
    simple = aolab.load(textured(SimpleMaterial(diffuse=[51, 255, 0, 255]))).instances[0].mesh.material
    np.testing.assert_allclose(simple.base_color, (((0.2 + 0.055) / 1.055) ** 2.4, 1, 0), atol=1e-6)


@pytest.mark.parametrize("kind", [PBRMaterial, SimpleMaterial])
@pytest.mark.parametrize("mode", ["L", "P", "RGB", "RGBA"])
def test_textures_of_any_mode(kind, mode):
    image = Image.new("RGB", (4, 3), (204, 204, 204)).convert(mode)
    key = "baseColorTexture" if kind is PBRMaterial else "image"
    mesh = textured(kind(**{key: image}))
    scene = trimesh.Scene({"a": mesh, "b": textured(mesh.visual.material)})
    first, second = (instance.mesh.material for instance in aolab.load(scene).instances)
    assert first.texture.pixels.shape == (3, 4, 4)
    assert first.texture.pixels[0, 0].tolist() == [204, 204, 204, 255]
    assert first.base_color == (1, 1, 1)
    assert first.texture is second.texture


def test_a_material_for_each_face_is_said():
    mesh = textured(MultiMaterial([SimpleMaterial(diffuse=[255, 0, 0, 255]), SimpleMaterial()]))
    with pytest.warns(Notice, match="mesh 'mesh' has a material for each face"):
        assert aolab.load(mesh).instances[0].mesh.material.base_color == (1, 0, 0)


def test_points_beside_triangles_are_left_out_with_a_notice():
    scene = trimesh.Scene({"box": trimesh.creation.box(), "cloud": trimesh.PointCloud(np.eye(3))})
    with pytest.warns(Notice, match=r"left out: 'cloud' holds no triangles \(PointCloud\)"):
        assert len(aolab.load(scene).instances) == 1


@pytest.mark.parametrize(
    "source", [trimesh.PointCloud(np.eye(3)), trimesh.Scene(), trimesh.Scene({"c": trimesh.PointCloud(np.eye(3))})]
)
def test_no_triangles(source):
    with pytest.raises(SceneError, match=r"no(thing| triangles)"):
        aolab.load(source)


def test_an_empty_trimesh():
    with pytest.raises(SceneError, match=r"empty|no triangles"):
        aolab.load(trimesh.Trimesh())


def test_a_trimesh_with_nan():
    box = trimesh.creation.box()
    box.vertices[3, 1] = np.nan
    with pytest.warns(aolab.Notice, match="left out: 4 of 12 triangles of mesh 'mesh', whose vertices are not finite"):
        assert aolab.load(box).triangles == 8
    box.vertices[:, 1] = np.nan
    with pytest.raises(SceneError, match="mesh 'mesh': vertex 0 is"):
        aolab.load(box)


def test_a_singular_transform_names_the_node():
    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box(), node_name="flat", transform=np.diag([1, 0, 1, 1]))
    with pytest.raises(SceneError, match="instance 'flat': its transform is singular"):
        aolab.load(scene)


def test_a_camera_without_a_place_is_told():
    """A scene that is made with a camera keeps it out of its graph until a transform is set."""
    scene = trimesh.Scene([trimesh.creation.box()], camera=trimesh.scene.Camera(fov=(40, 30)))
    with pytest.warns(Notice, match="its camera cannot be used"):
        assert aolab.load(scene).triangles == 12
    scene.camera_transform = np.eye(4)
    assert aolab.load(scene).camera.fov == 30


def test_emission_of_a_trimesh():
    assert aolab.load(textured(PBRMaterial(emissiveFactor=[1, 0.5, 0]))).instances[0].mesh.material.emission == (
        1,
        0.5,
        0,
    )
