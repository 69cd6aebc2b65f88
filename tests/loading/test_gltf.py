"""glTF files made by hand: what survives, and what is refused."""

import base64
import math
import os

import numpy as np
import pytest
from gltf_file import GltfFile, png, png_header

import aolab
from aolab.errors import FileError, Notice, SceneError
from aolab.scene.lights import DirectionalLight, PointLight, SpotLight

HALF_TURN_Z = [0, 0, 1, 0]
TURN_Y = [0, math.sqrt(0.5), 0, math.sqrt(0.5)]  # +90° about y: -z becomes -x


@pytest.fixture
def gltf(tmp_path):
    return GltfFile(tmp_path)


def test_geometry_of_glb_and_gltf_agree(gltf):
    for path in (gltf.glb(), gltf.gltf(), gltf.gltf("points.bin", "other.gltf")):
        (instance,) = aolab.load(path).instances
        np.testing.assert_array_equal(instance.mesh.vertices, [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
        np.testing.assert_array_equal(instance.mesh.normals, [[0, 0, 1]] * 3)
        assert (instance.name, instance.mesh.name) == ("first", "triangle")


def test_source_and_name_are_the_files(gltf):
    path = gltf.glb("lamp.glb")
    assert aolab.load(str(path)).source == str(path)
    assert aolab.load(path).name == "lamp"


def test_given_normals_are_kept(gltf):
    given = np.array([[0, 0.6, 0.8]] * 3, np.float32)
    gltf.attribute("NORMAL", given)
    np.testing.assert_array_equal(aolab.load(gltf.glb()).instances[0].mesh.normals, given)


def test_node_transforms_multiply_down_the_tree(gltf):
    gltf.header["nodes"] = [
        {"translation": [1, 2, 3], "scale": [2, 2, 2], "children": [1]},
        {"rotation": HALF_TURN_Z, "mesh": 0},
    ]
    (instance,) = aolab.load(gltf.glb()).instances
    np.testing.assert_allclose(instance.world_from_local @ [1, 0, 0, 1], [-1, 2, 3, 1], atol=1e-12)
    assert instance.name == "node 1"


def test_a_mirrored_node_keeps_its_negative_determinant(gltf):
    gltf.header["nodes"][0]["matrix"] = np.diag([-1.0, 1, 1, 1]).T.reshape(-1).tolist()
    (instance,) = aolab.load(gltf.glb()).instances
    assert np.linalg.det(instance.world_from_local[:3, :3]) == pytest.approx(-1)
    np.testing.assert_allclose(aolab.load(gltf.glb()).bounds, [[-1, 0, 0], [0, 1, 0]])


def test_a_mesh_of_two_nodes_is_one_mesh(gltf):
    gltf.header["meshes"][0]["primitives"].append(dict(gltf.header["meshes"][0]["primitives"][0]))
    gltf.header["nodes"] = [{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b", "translation": [5, 0, 0]}]
    gltf.header["scenes"] = [{"nodes": [0, 1]}]
    instances = aolab.load(gltf.glb()).instances
    assert [instance.name for instance in instances] == ["a", "a", "b", "b"]
    assert instances[0].mesh is instances[2].mesh
    assert instances[1].mesh is instances[3].mesh
    assert instances[0].mesh is not instances[1].mesh


def test_without_scenes_the_roots_are_drawn(gltf):
    del gltf.header["scenes"], gltf.header["scene"]
    assert len(aolab.load(gltf.glb()).instances) == 1


def test_base_color_is_linear_and_not_rounded(gltf):
    gltf.material(pbrMetallicRoughness={"baseColorFactor": [0.0212, 0.5, 1, 0.25]}, alphaMode="MASK", alphaCutoff=0.2)
    material = aolab.load(gltf.glb()).instances[0].mesh.material
    assert material.base_color == (0.0212, 0.5, 1)
    assert (material.alpha, material.alpha_cutoff, material.name) == (0.25, 0.2, "paint")


def test_specular_glossiness_gives_its_diffuse_colour(gltf):
    gltf.material(extensions={"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.1, 0.2, 0.3, 1]}})
    assert aolab.load(gltf.glb()).instances[0].mesh.material.base_color == (0.1, 0.2, 0.3)


def test_mask_has_gltfs_default_cutoff(gltf):
    gltf.material(alphaMode="MASK")
    assert aolab.load(gltf.glb()).instances[0].mesh.material.alpha_cutoff == 0.5


def test_blend_becomes_a_mask_and_says_so(gltf):
    gltf.material(alphaMode="BLEND")
    with pytest.warns(Notice, match=r"'paint' is blended; drawn as a mask, cut at alpha 0\.5"):
        scene = aolab.load(gltf.glb())
    assert scene.instances[0].mesh.material.alpha_cutoff == 0.5


@pytest.mark.parametrize("where", ["bufferView", "file", "percent", "data"])
def test_texture(gltf, where):
    data = png((255, 0, 128, 64))
    if where == "bufferView":
        gltf.image(bufferView=gltf.view(data), mimeType="image/png")
    elif where == "data":
        gltf.image(uri="data:image/png;base64," + base64.b64encode(data).decode())
    else:
        (gltf.folder / "a b.png").write_bytes(data)
        gltf.image(uri="a%20b.png" if where == "percent" else "a b.png")
    gltf.attribute("TEXCOORD_0", np.array([[0, 0], [1, 0], [0, 0.25]], np.float32))
    mesh = aolab.load(gltf.gltf()).instances[0].mesh
    assert mesh.material.texture.pixels[0, 0].tolist() == [255, 0, 128, 64]
    assert mesh.material.base_color == (1, 1, 1)
    np.testing.assert_array_equal(mesh.uv, [[0, 1], [1, 1], [0, 0.75]])  # v up


def test_a_texture_uses_the_uv_set_it_names_and_integers_are_fractions(gltf):
    gltf.image(bufferView=gltf.view(png((1, 2, 3, 255))))
    gltf.header["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1
    gltf.attribute("TEXCOORD_0", np.zeros((3, 2), np.float32))
    gltf.attribute("TEXCOORD_1", np.array([[0, 0], [65535, 0], [0, 65535]], np.uint16))
    np.testing.assert_allclose(aolab.load(gltf.glb()).instances[0].mesh.uv, [[0, 1], [1, 1], [0, 0]])


def test_two_materials_share_one_image(gltf):
    gltf.image(bufferView=gltf.view(png((9, 9, 9, 255))))
    gltf.attribute("TEXCOORD_0", np.zeros((3, 2), np.float32))
    gltf.header["materials"].append({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
    gltf.header["meshes"].append({"primitives": [{**gltf.header["meshes"][0]["primitives"][0], "material": 1}]})
    gltf.header["nodes"].append({"mesh": 1})
    gltf.header["scenes"] = [{"nodes": [0, 1]}]
    first, second = aolab.load(gltf.glb()).instances
    assert first.mesh.material.texture is second.mesh.material.texture
    assert first.mesh.material is not second.mesh.material


@pytest.mark.parametrize("has_material", [False, True])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_vertex_colours_are_linear(gltf, dtype, has_material):
    full = 1 if dtype == np.float32 else np.iinfo(dtype).max
    gltf.attribute("COLOR_0", np.array([[full, full * 0.2, 0, full]] * 3).astype(dtype))
    if has_material:
        gltf.material(pbrMetallicRoughness={"baseColorFactor": [0.5, 0.5, 0.5, 1]})
    mesh = aolab.load(gltf.glb()).instances[0].mesh
    np.testing.assert_allclose(mesh.colors, [[1, 0.2, 0, 1]] * 3)
    assert mesh.material.base_color == ((0.5,) * 3 if has_material else (1, 1, 1))


def test_camera_of_a_scaled_node(gltf):
    gltf.header["cameras"] = [{"type": "perspective", "perspective": {"yfov": math.pi / 3, "znear": 0.1}}]
    gltf.header["nodes"] += [
        {"scale": [2, 2, 2], "children": [2]},
        {"camera": 0, "translation": [1, 0, 0], "rotation": TURN_Y, "children": [3]},
        {"mesh": 0, "name": "on the camera"},
    ]
    gltf.header["scenes"] = [{"nodes": [0, 1]}]
    scene = aolab.load(gltf.glb())
    assert scene.camera.fov == pytest.approx(60)
    np.testing.assert_allclose(scene.camera.eye, (2, 0, 0), atol=1e-12)
    np.testing.assert_allclose(np.subtract(scene.camera.target, scene.camera.eye), (-1, 0, 0), atol=1e-12)
    np.testing.assert_allclose(scene.camera.up, (0, 1, 0), atol=1e-12)
    assert [instance.name for instance in scene.instances] == ["first", "on the camera"]


def test_an_orthographic_camera_is_replaced_and_said(gltf):
    gltf.header["cameras"] = [{"type": "orthographic", "orthographic": {}}]
    gltf.header["nodes"][0]["camera"] = 0
    with pytest.warns(Notice, match="orthographic"):
        scene = aolab.load(gltf.glb())
    np.testing.assert_allclose(scene.camera.target, (0.5, 0.5, 0))


def test_lights(gltf):
    kinds = [
        {"type": "directional", "intensity": 3, "color": [1, 0.5, 0]},
        {"type": "point", "intensity": 7},
        {"type": "spot", "spot": {"innerConeAngle": math.radians(10), "outerConeAngle": math.radians(20)}},
    ]
    gltf.header["extensions"] = {"KHR_lights_punctual": {"lights": kinds}}
    gltf.header["extensionsUsed"] = gltf.header["extensionsRequired"] = ["KHR_lights_punctual"]
    gltf.header["nodes"][0]["children"] = [1, 2, 3]
    gltf.header["nodes"] += [
        {"rotation": TURN_Y, "translation": [0, index, 0], "extensions": {"KHR_lights_punctual": {"light": index}}}
        for index in range(3)
    ]
    scene = aolab.load(gltf.glb())
    sun, bulb, spot = scene.lights
    assert isinstance(sun, DirectionalLight)
    assert sun.irradiance == (3, 1.5, 0)
    np.testing.assert_allclose(sun.direction, (-1, 0, 0), atol=1e-12)
    assert bulb == PointLight((0, 1, 0), (7, 7, 7))
    assert isinstance(spot, SpotLight)
    np.testing.assert_allclose([spot.inner, spot.outer], (10, 20))
    assert spot.position == (0, 2, 0)
    assert scene.environment.name == "sky"


def test_a_spot_of_90_degrees_is_narrowed(gltf):
    gltf.header["extensions"] = {
        "KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": math.pi / 2}}]}
    }
    gltf.header["nodes"][0]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
    with pytest.warns(Notice, match=r"'first'.*narrowed to 89\.9"):
        assert aolab.load(gltf.glb()).lights[0].outer == 89.9


def test_lines_beside_triangles_are_left_out_with_a_notice(gltf):
    gltf.header["meshes"].append({"primitives": [{**gltf.header["meshes"][0]["primitives"][0], "mode": 1}]})
    gltf.header["nodes"][0]["children"] = [1]
    gltf.header["nodes"] += [{"mesh": 1, "children": [2]}, {"mesh": 0, "name": "below the lines"}]
    with pytest.warns(Notice, match="left out 1 of 2 primitives"):
        scene = aolab.load(gltf.glb())
    assert [instance.name for instance in scene.instances] == ["first", "below the lines"]


def test_skins_are_said(gltf):
    gltf.header["skins"] = [{"joints": [0]}]
    with pytest.warns(Notice, match="rest pose"):
        aolab.load(gltf.glb())


def refuse(path, match, error=FileError):
    """It is refused, with the file's name and `match` in the text."""
    with pytest.raises(error, match=match) as caught:
        aolab.load(path)
    assert str(path) in str(caught.value)


def test_points_alone_are_refused(gltf):
    gltf.header["meshes"][0]["primitives"][0]["mode"] = 0
    refuse(gltf.glb(), "points, lines or triangle fans, not triangles", SceneError)


def test_a_scene_without_meshes_is_refused(gltf):
    gltf.header["nodes"] = [{"name": "alone"}]
    refuse(gltf.glb(), "no triangles: it holds no geometry", SceneError)


def test_bad_magic(gltf):
    path = gltf.glb()
    path.write_bytes(b"PK\3\4" + path.read_bytes()[4:])
    refuse(path, "is not a GLB file")


@pytest.mark.parametrize("left", [8, 30, 300, -1])
def test_truncated_glb(gltf, left):
    path = gltf.glb()
    path.write_bytes(path.read_bytes()[:left])
    refuse(path, "truncated|not a GLB")


def test_old_versions(gltf):
    gltf.header["asset"]["version"] = "1.0"
    refuse(gltf.glb(), r"glTF version is 1\.0; only 2 is read")


def test_broken_json(gltf):
    path = gltf.gltf()
    path.write_text("{" + path.read_text())
    refuse(path, "JSON cannot be parsed")
    path.write_text("[1, 2]")
    refuse(path, "its JSON is a list")


def test_a_required_extension_that_is_not_read(gltf):
    gltf.header["extensionsRequired"] = ["KHR_draco_mesh_compression", "KHR_materials_unlit"]
    refuse(gltf.glb(), "requires KHR_draco_mesh_compression, which is not read")


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda file: file.header["accessors"][0].update(bufferView=7), "IndexError"),
        (lambda file: file.header["accessors"][0].update(count=4), "cannot read .* as glTF"),
        (lambda file: file.header["accessors"][0].update(sparse={}), "accessor 0 is sparse"),
        (lambda file: file.header["accessors"][0].pop("bufferView"), "accessor 0 has no data"),
        (lambda file: file.header["bufferViews"][0].update(byteLength=4000), "bufferView 0 is bytes 0 to 4000"),
        (lambda file: file.header["nodes"][0].update(mesh=3), "cannot read .* as glTF: IndexError"),
        (lambda file: file.header["nodes"][0].update(children=[9]), "refers to node 9, but has 1 nodes"),
        (lambda file: file.header["nodes"][0].update(children=[0]), "'first' is reached twice"),
        (lambda file: file.header["nodes"][0].update(matrix=[1, 2]), "cannot read .* as glTF"),
        (lambda file: file.header["meshes"][0].pop("primitives"), "as glTF: KeyError: 'primitives'"),
    ],
)
def test_corrupt_structure(gltf, change, match):
    change(gltf)
    refuse(gltf.glb(), match)


def test_a_buffer_too_short(gltf):
    path = gltf.gltf("points.bin")
    (gltf.folder / "points.bin").write_bytes(b"1234")
    refuse(path, "buffer 0 is truncated: 4 of 36 bytes")


def test_a_missing_buffer(gltf):
    path = gltf.gltf("points.bin")
    (gltf.folder / "points.bin").unlink()
    refuse(path, r"buffer 'points\.bin' is missing")


def test_nan_names_file_mesh_and_vertex(gltf):
    gltf.header["accessors"][0]["bufferView"] = gltf.view(
        np.array([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], np.float32).tobytes()
    )
    refuse(gltf.glb(), "mesh 'triangle': vertex 2 is .*nan", SceneError)


def test_index_out_of_range(gltf):
    gltf.header["meshes"][0]["primitives"][0]["indices"] = gltf.accessor(np.array([0, 1, 3], np.uint16))
    refuse(gltf.glb(), r"mesh 'triangle': triangle 0 has indices \[0, 1, 3\], but there are 3 vertices", SceneError)


def test_a_singular_transform_names_the_node(gltf):
    gltf.header["nodes"][0]["scale"] = [1, 0, 1]
    refuse(gltf.glb(), "instance 'first': its transform is singular", SceneError)


def test_an_enormous_scene(gltf):
    gltf.header["nodes"][0]["scale"] = [1e16, 1e16, 1e16]
    refuse(gltf.glb(), r"reaches 1e\+16 units", SceneError)


def test_a_corrupt_png(gltf):
    data = png((1, 2, 3, 4), (64, 64))
    gltf.image(bufferView=gltf.view(data[:60]), name="skin")
    refuse(gltf.glb(), "image 'skin' is corrupt")


def test_a_decompression_bomb_is_refused_before_decoding(gltf):
    gltf.image(bufferView=gltf.view(png_header(60000, 60000)), name="bomb")
    refuse(gltf.glb(), "'bomb' is refused: .*3600000000 pixels")


def test_a_missing_texture_is_a_notice(gltf):
    gltf.image(uri="gone.png")
    gltf.header["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [0.5, 0.25, 0, 1]
    with pytest.warns(Notice, match=r"the texture 'gone\.png' of material 'paint' is missing"):
        material = aolab.load(gltf.gltf()).instances[0].mesh.material
    assert material.texture is None
    assert material.base_color == (0.5, 0.25, 0)


OUTSIDE = ["../x.png", "%2e%2e/x.png", "sub/../../x.png", "..\\x.png", "/etc/hostname", "link.png"]
URLS = ["http://example.org/x.png", "file:///etc/hostname", "HTTPS://example.org/x.png", "C:/x.png"]


@pytest.mark.parametrize("uri", OUTSIDE + URLS)
@pytest.mark.parametrize("what", ["image", "buffer"])
def test_references_that_leave_the_folder_are_refused(tmp_path, what, uri):
    (tmp_path / "x.png").write_bytes(png((1, 1, 1, 1)))
    (tmp_path / "model").mkdir()
    os.symlink(tmp_path / "x.png", tmp_path / "model" / "link.png")
    file = GltfFile(tmp_path / "model")
    if what == "image":
        file.image(uri=uri)
        path = file.gltf()
    else:
        path = file.gltf()
        path.write_text(path.read_text().replace(file.header["buffers"][0]["uri"], uri.replace("\\", "\\\\")))
    refuse(path, "outside its folder" if uri in OUTSIDE else "a URL or absolute path")
