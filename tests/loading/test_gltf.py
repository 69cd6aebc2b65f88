"""glTF files made by hand: the features that survive, and the faults that are refused."""

import base64
import math
import os
import re
import sys

import numpy as np
import pytest
from gltf_file import GltfFile, png, png_header

import aolab
from aolab.errors import FileError, Notice, ParameterError, SceneError
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


def test_blending_is_a_share_of_the_pixels_and_told(gltf):
    gltf.material(alphaMode="BLEND")
    with pytest.warns(Notice, match=r"material 'paint' is blended: drawn in as many of the pixels as its alpha states"):
        material = aolab.load(gltf.glb()).instances[0].mesh.material
    assert (material.alpha_cutoff, material.blend) == (None, True)


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


def test_an_orthographic_camera(gltf):
    magnified = {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 100}
    gltf.header["cameras"] = [{"type": "orthographic", "orthographic": magnified}]
    gltf.header["nodes"].append({"camera": 0, "translation": [0, 0, 5]})
    gltf.header["scenes"] = [{"nodes": [0, 1]}]
    camera = aolab.load(gltf.glb()).camera
    assert (camera.ortho, camera.near, camera.far, camera.eye) == (4, None, 100, (0, 0, 5))


def test_the_clip_planes_of_a_file_are_kept(gltf):
    gltf.header["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.02, "zfar": 300}}]
    gltf.header["nodes"][0]["camera"] = 0
    camera = aolab.load(gltf.glb()).camera
    assert (camera.near, camera.far) == (0.02, 300)


def test_a_camera_that_sees_nothing_is_told_and_the_scene_framed(gltf):
    gltf.header["cameras"] = [{"name": "blind", "type": "perspective", "perspective": {"yfov": 0, "znear": 0.1}}]
    gltf.header["nodes"][0]["camera"] = 0
    with pytest.warns(Notice, match=r"camera 'blind' cannot be used: fov = 0\.0 is outside"):
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
    with pytest.warns(Notice, match="left out: mesh 'mesh 1' holds lines, no triangles"):
        scene = aolab.load(gltf.glb())
    assert [instance.name for instance in scene.instances] == ["first", "below the lines"]


def refuse(path, match, error=FileError):
    """It is refused, with the file's name and `match` in the text."""
    with pytest.raises(error, match=match) as caught:
        aolab.load(path)
    assert str(path) in str(caught.value)


def test_points_alone_are_refused(gltf):
    gltf.header["meshes"][0]["primitives"][0]["mode"] = 0
    refuse(gltf.glb(), "nothing can be drawn: mesh 'triangle' holds points, no triangles", SceneError)


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
    refuse(path, "is not glTF: its JSON is no object")


def test_a_later_version_that_the_file_needs(gltf):
    gltf.header["asset"]["minVersion"] = "2.1"
    refuse(gltf.glb(), r"needs a reader of glTF 2\.1 \(asset\.minVersion\); only 2\.0 is read")
    gltf.header["asset"]["minVersion"] = "2.0"
    assert aolab.load(gltf.glb()).triangles == 1


def test_elements_that_overlap(gltf):
    gltf.header["bufferViews"][0]["byteStride"] = 4
    refuse(gltf.glb(), r"accessors\[0\]: its elements have 12 bytes, and bufferViews\[0\]\.byteStride is 4")


def test_a_name_that_is_no_text(gltf):
    gltf.header["nodes"][0]["name"] = 5
    assert aolab.load(gltf.glb()).instances[0].name == "5"


def test_a_pointer_of_git_lfs(tmp_path):
    path = tmp_path / "a.glb"
    path.write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n")
    refuse(path, "is a pointer of Git LFS in place of the file; 'git lfs pull' fetches the file")


def test_a_required_extension_that_is_not_read(gltf):
    gltf.header["extensionsRequired"] = ["MPEG_media", "KHR_materials_unlit"]
    refuse(gltf.glb(), "requires MPEG_media, which is not read")


@pytest.mark.parametrize("extension", ["KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"])
def test_a_required_texture_that_is_not_read(gltf, extension):
    """The surface has its base colour."""
    gltf.attribute("TEXCOORD_0", np.zeros((3, 2), np.float32))
    gltf.image(bufferView=gltf.view(b"no picture that is read"))
    gltf.header["textures"] = [{"extensions": {extension: {"source": 0}}}]
    gltf.header["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [1, 0.5, 0, 1]
    gltf.header["extensionsUsed"] = gltf.header["extensionsRequired"] = [extension]
    with pytest.warns(Notice) as caught:
        scene = aolab.load(gltf.glb())
    assert any(f"texture is in no known format ({extension}); drawn without" in str(one.message) for one in caught)
    assert scene.instances[0].mesh.material.base_color == (1, 0.5, 0)


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda file: file["accessors"][0].update(bufferView=7), r"accessors[0].bufferView: index 7 of 1 bufferViews"),
        (lambda file: file["accessors"][0].update(type="VEC9"), 'accessors[0].type: "VEC9" is none of'),
        (lambda file: file["accessors"][0].pop("type"), "accessors[0].type is missing"),
        (lambda file: file["accessors"][0].update(count=-1), "accessors[0].count: -1 is below 0"),
        (lambda file: file["accessors"][0].update(count="many"), 'accessors[0].count: "many" is no whole number'),
        (lambda file: file["accessors"][0].update(sparse={}), "accessors[0].sparse.count is missing"),
        (lambda file: file["nodes"][0].update(mesh=3), "nodes[0].mesh: index 3 of 1 meshes"),
        (lambda file: file["nodes"][0].update(children=[9]), "nodes[0].children[0]: index 9 of 1 nodes"),
        (lambda file: file["nodes"][0].update(matrix=[1, 2]), "nodes[0].matrix holds 2 numbers, not 16"),
        (lambda file: file["nodes"][0].update(scale=[math.inf] * 3), "nodes[0].scale[0]: Infinity is not finite"),
        (lambda file: file["nodes"][0].update(rotation="up"), 'nodes[0].rotation: "up" is no list'),
        (lambda file: file["meshes"][0].pop("primitives"), "meshes[0].primitives is missing"),
        (lambda file: file["meshes"][0]["primitives"][0].update(mode=7), "meshes[0].primitives[0].mode: 7 is above 6"),
        (
            lambda file: file["meshes"][0]["primitives"][0]["attributes"].update(POSITION=9),
            "meshes[0].primitives[0].attributes.POSITION: index 9 of 1 accessors",
        ),
        (lambda file: file.update(materials=[{"alphaMode": "GLASS"}]), 'materials[0].alphaMode: "GLASS" is none of'),
        (lambda file: file.update(materials=3), "materials: 3 is no list"),
    ],
)  # fmt: skip
def test_the_schema_is_checked_and_the_place_named(gltf, change, match):
    change(gltf.header)
    refuse(gltf.glb(), re.escape(f"is no valid glTF: {match}"))


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda file: file["accessors"][0].update(count=4), r"accessors\[0\]: its 4 elements end at byte 48 of .* 36"),
        (lambda file: file["bufferViews"][0].update(byteLength=4000), r"bufferViews\[0\]: bytes 0 to 4000 of buffers"),
        (lambda file: file["accessors"][0].update(type="VEC2"), r"accessors\[0\].type: VEC2 is not VEC3 here"),
        (lambda file: file["nodes"][0].update(children=[0]), "nodes are their own ancestors: nodes must form a tree"),
        (lambda file: file["nodes"].extend([{"children": [0]}] * 2), "'first' is reached twice"),
    ],
)
def test_corrupt_structure(gltf, change, match):
    change(gltf.header)
    refuse(gltf.glb(), match)


def test_properties_that_are_null_count_as_absent(gltf):
    gltf.header["nodes"][0].update(skin=None, camera=None, name=None)
    assert aolab.load(gltf.glb()).instances[0].name == "node 0"


def test_a_buffer_too_short(gltf):
    path = gltf.gltf("points.bin")
    (gltf.folder / "points.bin").write_bytes(b"1234")
    refuse(path, r"buffers\[0\] is truncated: 4 of 36 bytes")


def test_a_missing_buffer(gltf):
    path = gltf.gltf("points.bin")
    (gltf.folder / "points.bin").unlink()
    refuse(path, r"buffers\[0\]: the file 'points\.bin' is missing")


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
    refuse(gltf.glb(), r"instance 'first' reaches 1e\+16 units", SceneError)


def test_a_corrupt_png(gltf):
    data = png((1, 2, 3, 4), (64, 64))
    gltf.image(bufferView=gltf.view(data[:60]), name="skin")
    with pytest.warns(Notice, match="material 'paint': image 'skin' is corrupt.*; drawn without"):
        assert aolab.load(gltf.glb()).instances[0].mesh.material.texture is None


def test_a_decompression_bomb_is_refused_before_decoding(gltf):
    gltf.image(bufferView=gltf.view(png_header(60000, 60000)), name="bomb")
    refuse(gltf.glb(), "'bomb' is refused: .*3600000000 pixels")


def test_a_missing_texture_is_a_notice(gltf):
    gltf.image(uri="gone.png")
    gltf.header["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [0.5, 0.25, 0, 1]
    with pytest.warns(Notice, match=r"material 'paint': its texture 'gone\.png' is missing; drawn without"):
        material = aolab.load(gltf.gltf()).instances[0].mesh.material
    assert material.texture is None
    assert material.base_color == (0.5, 0.25, 0)


OUTSIDE = ["../x.png", "%2e%2e/x.png", "sub/../../x.png", "..\\x.png", "/etc/hostname", "link.png"]
URLS = ["http://example.org/x.png", "file:///etc/hostname", "HTTPS://example.org/x.png", "C:/x.png"]


@pytest.mark.parametrize("uri", OUTSIDE + URLS)
@pytest.mark.parametrize("what", ["image", "buffer"])
def test_references_that_leave_the_folder_are_not_read(tmp_path, what, uri):
    """Without its buffer a file is refused; without a texture it is drawn."""
    (tmp_path / "x.png").write_bytes(png((1, 1, 1, 1)))
    (tmp_path / "model").mkdir()
    os.symlink(tmp_path / "x.png", tmp_path / "model" / "link.png")
    file = GltfFile(tmp_path / "model")
    reason = "outside its folder" if uri in OUTSIDE else "a URL or absolute path"
    if what == "image":
        file.image(uri=uri)
        with pytest.warns(Notice, match=reason):
            assert aolab.load(file.gltf()).instances[0].mesh.material.texture is None
    else:
        path = file.gltf()
        path.write_text(path.read_text().replace(file.header["buffers"][0]["uri"], uri.replace("\\", "\\\\")))
        refuse(path, reason)


# parts that cannot be drawn, and what is told


def light(gltf, **light):
    gltf.header.setdefault("extensions", {"KHR_lights_punctual": {"lights": []}})
    lights = gltf.header["extensions"]["KHR_lights_punctual"]["lights"]
    lights.append({"type": "point", **light})
    gltf.header["nodes"].append({
        "translation": [0, 0, 2.0 + len(lights)],
        "extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}},
    })  # fmt: skip
    gltf.header["scenes"][0]["nodes"].append(len(gltf.header["nodes"]) - 1)


def test_lights_beyond_the_shadow_maps_have_no_shadow(gltf):
    for _ in range(44):
        light(gltf)
    with pytest.warns(Notice, match="2 of its 44 lights cast no shadow: shadow maps hold 256 tiles"):
        scene = aolab.load(gltf.glb())
    assert [one.shadow for one in scene.lights] == [True] * 42 + [False] * 2


def test_shadows_are_limited_by_a_parameter(gltf):
    for _ in range(7):
        light(gltf)
    scene = aolab.load(f"{gltf.glb()}?shadows=2")  # and nothing is told
    assert [one.shadow for one in scene.lights] == [True] * 2 + [False] * 5


def test_photometric_lights_are_scaled_together(gltf):
    """A sun of 100,000 lux and a lamp of 1,000 candela, about 3 units away, under a sky whose radiance is 1."""
    light(gltf, type="directional", intensity=100_000)
    light(gltf, type="point", intensity=1000)
    with pytest.warns(Notice, match=r"its lights are photometric, about 1e\+05 lux at the surfaces: multiplied by 3"):
        sun, lamp = aolab.load(gltf.glb()).lights
    assert sun.irradiance[0] == pytest.approx(3.4, rel=0.01)
    assert sun.irradiance[0] / lamp.intensity[0] == pytest.approx(100)


def test_a_light_that_cannot_be_is_left_out(gltf):
    light(gltf, intensity=-1, name="dark")
    light(gltf, intensity=1)
    with pytest.warns(Notice, match="light 'dark' was left out: PointLight: intensity = .* is negative"):
        assert len(aolab.load(gltf.glb()).lights) == 1


def test_properties_that_are_not_read_are_told_from_the_file(gltf):
    gltf.material(
        occlusionTexture={"index": 0, "strength": 1},
        pbrMetallicRoughness={"metallicFactor": 1, "roughnessFactor": 0.5},
        extensions={"KHR_materials_clearcoat": {}, "ACME_glitter": {}},
        extras={"anything": 1},
    )
    gltf.header["extensionsUsed"] = ["KHR_materials_clearcoat", "KHR_lights_punctual"]
    names = "ACME_glitter, KHR_materials_clearcoat, materials.metallicFactor, "
    with pytest.warns(Notice, match=re.escape(f"read, but not used: {names}materials.occlusionTexture")):
        aolab.load(gltf.glb())


def test_many_parts_left_out_are_one_notice(gltf):
    for index in range(20):
        gltf.header["nodes"].append({"mesh": 0, "scale": [0, 0, 0], "name": f"hidden {index}"})
        gltf.header["scenes"][0]["nodes"].append(index + 1)
    with pytest.warns(Notice, match="left out: instance 'hidden 0': .*; and 17 more") as caught:
        assert len(aolab.load(gltf.glb()).instances) == 1
    assert len(caught) == 1


def test_a_name_of_100_000_characters_is_shortened(gltf):
    gltf.header["nodes"][0].update(name="n" * 100_000, scale=[0, 0, 0])
    with pytest.raises(SceneError) as caught:
        aolab.load(gltf.glb())
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize("installed", [True, False])
def test_draco_that_cannot_be_decoded(gltf, monkeypatch, installed):
    """The plain arrays are drawn, where the file has some; else the part is left out, and the other one drawn."""
    if installed:
        pytest.importorskip("DracoPy", reason="the extra draco")
        reason = r"mesh 'triangle': bufferViews\[1\] is no readable Draco mesh"
    else:
        monkeypatch.setitem(sys.modules, "DracoPy", None)
        reason = r"mesh 'triangle' is compressed with Draco, and the decoder is missing: .*pip install DracoPy"
    primitive = gltf.header["meshes"][0]["primitives"][0]
    draco = {"bufferView": gltf.view(b"no Draco"), "attributes": {"POSITION": 0}}
    primitive["extensions"] = {"KHR_draco_mesh_compression": draco}
    gltf.header["extensionsUsed"] = ["KHR_draco_mesh_compression"]
    with pytest.warns(Notice, match=f"drawn from its plain arrays: {reason}"):
        assert aolab.load(gltf.glb()).triangles == 1
    del gltf.header["accessors"][0]["bufferView"]
    refuse(gltf.glb(), reason, SceneError)
    corners = gltf.accessor(np.float32([(0, 0, 0), (0, 2, 0), (0, 0, 2)]))
    gltf.header["meshes"][0]["primitives"].append({"attributes": {"POSITION": corners}})
    with pytest.warns(Notice, match=f"left out: {reason}"):
        assert aolab.load(gltf.glb()).bounds[1].tolist() == [0, 2, 2]


def test_draco_indices_without_plain_ones_are_no_fallback(gltf):
    """The corners alone would be drawn in the wrong order."""
    primitive = gltf.header["meshes"][0]["primitives"][0]
    primitive["indices"] = gltf.accessor(np.uint16([0, 1, 2]))
    del gltf.header["accessors"][1]["bufferView"]
    draco = {"bufferView": gltf.view(b"no Draco"), "attributes": {"POSITION": 0}}
    primitive["extensions"] = {"KHR_draco_mesh_compression": draco}
    refuse(gltf.glb(), "nothing can be drawn: mesh 'triangle'", SceneError)


@pytest.mark.parametrize("installed", [True, False])
def test_meshopt_that_cannot_be_decoded(gltf, monkeypatch, installed):
    """The plain bytes are drawn, where the file has some; else the part is left out."""
    if installed:
        pytest.importorskip("meshopt", reason="the extra meshopt")
        reason = r"bufferViews\[0\] is no readable meshopt data"
    else:
        monkeypatch.setitem(sys.modules, "meshopt", None)
        reason = r"bufferViews\[0\] is compressed with meshopt, and the decoder is missing: .*pip install meshopt"
    place = gltf.header["bufferViews"][gltf.view(b"no meshopt")]
    meshopt = {**place, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}
    gltf.header["bufferViews"][0]["extensions"] = {"EXT_meshopt_compression": meshopt}
    gltf.header["extensionsUsed"] = ["EXT_meshopt_compression"]
    with pytest.warns(Notice, match=f"drawn from its plain arrays: {reason}"):
        assert aolab.load(gltf.glb()).triangles == 1
    gltf.header["bufferViews"][0]["buffer"] = 1
    gltf.more_buffers = [{"byteLength": 36, "extensions": {"EXT_meshopt_compression": {"fallback": True}}}]
    refuse(gltf.glb(), reason)


def test_the_memory_of_meshopt_is_limited(gltf):
    pytest.importorskip("meshopt", reason="the extra meshopt")
    meshopt = {"buffer": 0, "byteLength": 4, "byteStride": 256, "count": 2**33, "mode": "ATTRIBUTES"}
    gltf.header["bufferViews"][0]["extensions"] = {"KHR_meshopt_compression": meshopt}
    refuse(gltf.glb(), r"bufferViews\[0\] is refused: it needs 2.2 TB of memory")


def test_animation_parameters(gltf):
    with pytest.raises(ParameterError, match="time and animation need an animation, and the file has none"):
        aolab.load(gltf.glb(), time=1)
    times, values = gltf.accessor(np.float32([0, 1])), gltf.accessor(np.float32([(0, 0, 0), (1, 0, 0)]))
    gltf.header["animations"] = [{
        "name": "walk",
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [{"input": times, "output": values}],
    }]  # fmt: skip
    path = gltf.glb()
    assert aolab.load(f"{path}?time=0.5").bounds[0, 0] == 0.5
    assert aolab.load(path, time=0.25, animation=0).source == f"{path}?time=0.25&animation=0"
    with pytest.raises(ParameterError, match="animation = 'wlak' is unknown; did you mean 'walk'"):
        aolab.load(path, animation="wlak")
    with pytest.raises(ParameterError, match=r"time = 'soon' is not valid. The time of the file's animation"):
        aolab.load(path, time="soon")


def test_a_chain_of_2000_nodes(gltf):
    """In time linear in its length: 37 s before, for the pose of each node was looked up along the whole chain."""
    gltf.header["nodes"] = [{"translation": [0, 0, 1], "children": [index + 1]} for index in range(1999)]
    gltf.header["nodes"].append({"mesh": 0})
    assert aolab.load(gltf.glb()).bounds[0, 2] == 1999


def test_primitives_that_share_vertices_keep_those_they_use(gltf):
    gltf.header["meshes"][0]["primitives"] = [
        {"attributes": {"POSITION": 0}, "indices": gltf.accessor(np.uint16([0, 1, 2]))},
        {"attributes": {"POSITION": gltf.accessor(np.float32(np.random.default_rng(1).random((500, 3))))},
         "indices": gltf.accessor(np.uint16([7, 300, 12]))},
    ]  # fmt: skip
    assert [len(instance.mesh.vertices) for instance in aolab.load(gltf.glb()).instances] == [3, 3]


def test_the_memory_of_a_file_is_limited(gltf):
    gltf.image(bufferView=gltf.view(png((1, 2, 3, 255), (400, 400))))
    gltf.attribute("TEXCOORD_0", np.zeros((3, 2), np.float32))
    with pytest.raises(
        FileError, match=r"image 'image 0' is refused: it needs 640 KB of memory beside the .* KB in use"
    ):
        aolab.load(gltf.glb(), memory="100KB")
    gltf.header["accessors"][0].update(count=2_000_000_000)
    del gltf.header["accessors"][0]["bufferView"]
    refuse(gltf.glb(), r"accessors\[0\] is refused: it needs 24 GB of memory")


def test_an_animation_of_something_else_is_told(gltf):
    """KHR_animation_pointer moves any property; without its name in extensionsUsed it would pass in silence."""
    times, values = gltf.accessor(np.float32([0, 1])), gltf.accessor(np.float32([0, 1]))
    gltf.header["animations"] = [{
        "channels": [{"sampler": 0, "target": {"path": "pointer"}}],
        "samplers": [{"input": times, "output": values}],
    }]  # fmt: skip
    with pytest.warns(Notice, match="read, but not used: animations of pointer"):
        aolab.load(gltf.glb(), time=0.5)
