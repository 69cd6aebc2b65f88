"""OBJ, PLY and STL files, and what is refused before a file is read."""

import os

import numpy as np
import pytest
import trimesh
from gltf_file import png, png_header

import aolab
from aolab.errors import Error, FileError, Notice, ParameterError, SceneError

OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"


def write_obj(folder, text=OBJ, mtl=None, mtllib="model.mtl"):
    if mtl is not None:
        (folder / "model.mtl").write_text(mtl)
        text = f"mtllib {mtllib}\nusemtl paint\n{text}"
    path = folder / "model.obj"
    path.write_text(text)
    return path


def srgb(value):
    return ((value + 0.055) / 1.055) ** 2.4


def only_mesh(path):
    (instance,) = aolab.load(path).instances
    return instance.mesh


def refuse(path, match, error=FileError):
    with pytest.raises(error, match=match) as caught:
        aolab.load(path)
    assert str(path) in str(caught.value)


# OBJ


def test_obj_without_material(tmp_path):
    mesh = only_mesh(write_obj(tmp_path))
    assert mesh.name == "model"
    assert mesh.material.base_color == (0.8, 0.8, 0.8)
    assert mesh.material.texture is None
    np.testing.assert_array_equal(mesh.uv, [[0, 0], [1, 0], [0, 1]])
    np.testing.assert_array_equal(mesh.normals, [[0, 0, 1]] * 3)


@pytest.mark.parametrize("value", [0.4, 0.6])  # 0.4 is also what trimesh gives when there is no Kd
def test_kd_is_srgb(tmp_path, value):
    mesh = only_mesh(write_obj(tmp_path, mtl=f"newmtl paint\nKd {value} 1 0\n"))
    np.testing.assert_allclose(mesh.material.base_color, (srgb(value), 1, 0), atol=1e-6)
    grey = only_mesh(write_obj(tmp_path, mtl=f"newmtl paint\nKd {value} {value} {value}\n"))
    np.testing.assert_allclose(grey.material.base_color, [srgb(value)] * 3, atol=1e-6)


def test_obj_texture_with_a_space_in_its_name(tmp_path):
    (tmp_path / "my paint.png").write_bytes(png((10, 20, 30, 255)))
    mesh = only_mesh(write_obj(tmp_path, mtl="newmtl paint\nmap_Kd my paint.png\n"))
    assert mesh.material.texture.name == "my paint.png"
    assert mesh.material.texture.pixels[0, 0].tolist() == [10, 20, 30, 255]
    assert mesh.material.base_color == (1, 1, 1)


def test_quads_and_polygons_become_triangles(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 0\nf 1 2 3 4\nf 4 3 5\n"
    assert aolab.load(write_obj(tmp_path, text)).triangles == 3


def test_a_missing_mtl_is_a_notice(tmp_path):
    path = write_obj(tmp_path, "mtllib gone.mtl\nusemtl paint\n" + OBJ)
    with (
        pytest.warns(Notice, match=r"material file 'gone\.mtl' is missing; drawn without"),
        pytest.warns(Notice, match="material 'paint' is not defined; drawn in the default grey"),
    ):
        assert only_mesh(path).material.base_color == (0.8, 0.8, 0.8)


def test_a_missing_obj_texture_is_a_notice(tmp_path):
    path = write_obj(tmp_path, mtl="newmtl paint\nKd 1 0 0\nmap_Kd gone.png\n")
    with pytest.warns(Notice, match=r"texture 'gone\.png' is missing"):
        material = only_mesh(path).material
    assert (material.base_color, material.texture) == ((1, 0, 0), None)


@pytest.mark.parametrize(
    "name", ["../x.png", "/etc/hostname", "..\\x.png", "http://example.org/x.png", "file:///x.png"]
)
def test_obj_textures_outside_the_folder_are_not_read(tmp_path, name):
    (tmp_path / "x.png").write_bytes(png((1, 1, 1, 1)))
    (tmp_path / "inner").mkdir()
    path = write_obj(tmp_path / "inner", mtl=f"newmtl paint\nKd 1 0 0\nmap_Kd {name}\n")
    with pytest.warns(Notice, match=r"its texture '.*(outside its folder|a URL).*; drawn without"):
        material = only_mesh(path).material
    assert (material.base_color, material.texture) == ((1, 0, 0), None)


def test_an_mtl_outside_the_folder_is_not_read(tmp_path):
    (tmp_path / "x.mtl").write_text("newmtl paint\nKd 1 0 0\n")
    (tmp_path / "inner").mkdir()
    path = write_obj(tmp_path / "inner", mtl="", mtllib="../x.mtl")
    with (
        pytest.warns(Notice, match=r"'\.\./x\.mtl' lies outside its folder"),
        pytest.warns(Notice, match="'paint' is not defined"),
    ):
        assert only_mesh(path).material.base_color == (0.8, 0.8, 0.8)


def test_a_corrupt_obj_texture(tmp_path):
    (tmp_path / "x.png").write_bytes(png((1, 1, 1, 1))[:40])
    path = write_obj(tmp_path, mtl="newmtl paint\nmap_Kd x.png\n")
    with pytest.warns(Notice, match=r"image 'x\.png' is corrupt.*; drawn without"):
        assert only_mesh(path).material.texture is None


def test_an_obj_texture_bomb(tmp_path):
    (tmp_path / "x.png").write_bytes(png_header(50000, 50000))
    refuse(write_obj(tmp_path, mtl="newmtl paint\nmap_Kd x.png\n"), r"image 'x\.png' is refused")


def test_obj_index_out_of_range(tmp_path):
    refuse(write_obj(tmp_path, OBJ.replace("3/3", "9/3")), r"line 7: 'f 1/1 2/2 9/3' has vertex 9 of 3")


def test_obj_with_words_for_numbers(tmp_path):
    refuse(write_obj(tmp_path, OBJ + "f 1/1 2/2 three\n"), "line 8: 'three' is no corner of a face")


def test_obj_with_nan(tmp_path):
    refuse(write_obj(tmp_path, OBJ.replace("v 1 0 0", "v nan 0 0")), "mesh 'model': vertex 1 is", SceneError)


def test_obj_of_points_alone(tmp_path):
    refuse(write_obj(tmp_path, "v 0 0 0\nv 1 0 0\n"), "no triangles: it holds no geometry", SceneError)


def test_old_obj_and_mtl_are_latin_1(tmp_path):
    (tmp_path / "möbel.png").write_bytes(png((1, 2, 3, 255)))
    path = write_obj(tmp_path, "# Müller\n" + OBJ, mtl="newmtl paint\nmap_Kd möbel.png\n")
    for file in (path, tmp_path / "model.mtl"):
        file.write_bytes(file.read_text().encode("latin-1"))
    assert only_mesh(path).material.texture.name == "möbel.png"


def test_binary_rubbish_named_obj(tmp_path):
    path = tmp_path / "model.obj"
    path.write_bytes(bytes(range(256)) * 8)
    refuse(path, "no triangles|cannot read", Error)


# PLY and STL


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_ply_vertex_colours_are_srgb(tmp_path, encoding):
    box = trimesh.creation.box()
    box.visual.vertex_colors = np.array([[188, 255, 0, 128]] * 8, np.uint8)
    path = tmp_path / "box.ply"
    box.export(path, encoding=encoding)
    mesh = only_mesh(path)
    assert mesh.name == "box"
    np.testing.assert_allclose(mesh.colors, [[srgb(188 / 255), 1, 0, 128 / 255]] * len(mesh.colors), atol=1e-6)
    assert mesh.material.base_color == (1, 1, 1)


def test_ply_face_colours(tmp_path):
    box = trimesh.creation.box()
    box.visual.face_colors = np.array([[255, 0, 0, 255]] * 6 + [[0, 0, 255, 255]] * 6, np.uint8)
    path = tmp_path / "box.ply"
    box.export(path)
    mesh = only_mesh(path)
    corners = mesh.colors[mesh.faces]
    np.testing.assert_array_equal(corners[:6, :, :3], np.broadcast_to([1, 0, 0], (6, 3, 3)))
    np.testing.assert_array_equal(corners[6:, :, :3], np.broadcast_to([0, 0, 1], (6, 3, 3)))
    np.testing.assert_allclose(np.abs(mesh.normals).max(axis=1), 1)  # still a box


def test_ply_normals_are_kept(tmp_path):
    sphere = trimesh.creation.icosphere(1)
    path = tmp_path / "sphere.ply"
    sphere.export(path, vertex_normal=True)
    mesh = only_mesh(path)
    assert len(mesh.vertices) == len(sphere.vertices)
    np.testing.assert_allclose(mesh.normals, sphere.vertex_normals, atol=1e-6)


PLY = "ply\nformat ascii 1.0\n{comment}element vertex 3\n"
PLY += "property float x\nproperty float y\nproperty float z\n{uv}{faces}"
FACES = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"


def write_ply(folder, rows, face="3 0 1 2\n", comment="", uv=""):
    path = folder / "model.ply"
    path.write_text(PLY.format(comment=comment, uv=uv, faces=FACES if face else "end_header\n") + rows + face)
    return path


def test_ply_of_points_alone(tmp_path):
    refuse(write_ply(tmp_path, "0 0 0\n1 0 0\n0 1 0\n", face=""), "its 3 vertices are points", SceneError)


def test_ply_index_out_of_range(tmp_path):
    path = write_ply(tmp_path, "0 0 0\n1 0 0\n0 1 0\n", face="3 0 1 7\n")
    refuse(path, r"mesh 'model': triangle 0 has indices \[0, 1, 7\]", SceneError)


def test_ply_with_infinity(tmp_path):
    refuse(write_ply(tmp_path, "0 0 0\n1 0 0\n0 inf 0\n"), "mesh 'model': vertex 2 is .*inf", SceneError)


def test_ply_truncated(tmp_path):
    path = tmp_path / "model.ply"
    trimesh.creation.icosphere(2).export(path)
    path.write_bytes(path.read_bytes()[:-200])
    refuse(path, "is truncated: it ends within element 'face'")


@pytest.mark.parametrize("name", ["x.png", "../x.png"])
def test_ply_texture(tmp_path, name):
    (tmp_path / "x.png").write_bytes(png((9, 8, 7, 255)))
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "x.png").write_bytes(png((9, 8, 7, 255)))
    uv = "property float s\nproperty float t\n"
    path = write_ply(
        tmp_path / "inner", "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n", comment=f"comment TextureFile {name}\n", uv=uv
    )
    if name == "../x.png":
        with pytest.warns(Notice, match="outside its folder.*; drawn without"):
            assert only_mesh(path).material.texture is None
    else:
        mesh = only_mesh(path)
        assert mesh.material.texture.pixels[0, 0].tolist() == [9, 8, 7, 255]
        np.testing.assert_array_equal(mesh.uv[mesh.vertices[:, 0] == 1], [[1, 0]])


def test_a_missing_ply_texture_is_a_notice_and_nothing_else(tmp_path, capsys):
    path = write_ply(tmp_path, "0 0 0\n1 0 0\n0 1 0\n", comment="comment TextureFile gone.png\n")
    with pytest.warns(Notice, match=r"texture 'gone\.png' is missing"):
        aolab.load(path)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("kind", ["stl", "stl_ascii"])
def test_stl_is_welded_for_its_normals(tmp_path, kind):
    path = tmp_path / "sphere.stl"
    trimesh.creation.icosphere(3).export(path, file_type=kind)
    mesh = only_mesh(path)
    assert mesh.name == "sphere"
    np.testing.assert_allclose(mesh.normals, mesh.vertices / np.linalg.norm(mesh.vertices, axis=1)[:, None], atol=0.01)


def test_stl_truncated(tmp_path):
    path = tmp_path / "sphere.stl"
    trimesh.creation.icosphere(3).export(path)
    path.write_bytes(path.read_bytes()[:-100])
    refuse(path, "is truncated or no STL file: 63984 of 64084 bytes")


# before reading


def test_a_missing_file_suggests_the_nearest(tmp_path):
    write_obj(tmp_path)
    refuse(tmp_path / "modle.obj", r"no file .*; did you mean 'model\.obj'\?")


def test_a_missing_folder(tmp_path):
    refuse(tmp_path / "gone" / "model.obj", "there is no folder")


def test_a_directory_lists_its_models(tmp_path):
    write_obj(tmp_path)
    refuse(tmp_path, r"is a directory; give a file in it \(model\.obj\)")


def test_an_unknown_extension_lists_the_known(tmp_path):
    path = tmp_path / "model.blend"
    path.write_bytes(b"x")
    refuse(
        path, r"unknown extension '\.blend'; export it as \.glb from Blender; known: \.glb, \.gltf, \.obj, \.ply, \.stl"
    )


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".obj", ".ply", ".stl", ".off", ".3mf"])
def test_an_empty_file(tmp_path, suffix):
    path = tmp_path / f"model{suffix}"
    path.touch()
    refuse(path, "is empty")


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".ply", ".stl", ".off", ".3mf"])
def test_rubbish(tmp_path, suffix):
    path = tmp_path / f"model{suffix}"
    path.write_bytes(b"this is no model, whatever its name says" * 10)
    refuse(path, "corrupt|not a GLB|truncated|is no (PLY|OFF) file", Error)


@pytest.mark.parametrize("source", ["https://example.org/model.glb", "file:///models/model.glb"])
def test_a_url_is_not_fetched(source):
    with pytest.raises(FileError, match="is a URL; download"):
        aolab.load(source)


def test_upper_case_extension(tmp_path):
    path = write_obj(tmp_path).rename(tmp_path / "MODEL.OBJ")
    assert aolab.load(path).triangles == 1


def test_the_parameters_of_a_file(tmp_path):
    path = write_obj(tmp_path)
    with pytest.raises(ParameterError, match=r"model\.obj: a file has no parameter 'upaxis'; did you mean 'up_axis'\?"):
        aolab.load(path, upaxis=2)
    with pytest.raises(ParameterError, match=r"up_axis = 'x' is not valid. The file's axis that points up"):
        aolab.load(f"{path}?up_axis=x")
    with pytest.raises(ParameterError, match="parameter 'up_axis' is given twice"):
        aolab.load(f"{path}?up_axis=z", up_axis="z")
    with pytest.raises(ParameterError, match="'up' is not key=value"):
        aolab.load(f"{path}?up")
    with pytest.raises(ParameterError, match="time and animation are for glTF; Wavefront OBJ has no animations"):
        aolab.load(path, time=1)


@pytest.mark.parametrize("query", [True, False])
def test_a_file_with_z_up(tmp_path, query):
    """x stays, z becomes y, y becomes -z; the source makes the same scene again."""
    path = write_obj(tmp_path, "v 0 0 0\nv 1 0 2\nv 0 3 4\nf 1 2 3\n")
    scene = aolab.load(f"{path}?up_axis=z") if query else aolab.load(path, up_axis="z")
    np.testing.assert_allclose(scene.bounds, [[0, 0, -3], [1, 4, 0]], atol=1e-12)
    assert scene.source == f"{path}?up_axis=z"
    np.testing.assert_array_equal(aolab.load(scene.source).bounds, scene.bounds)


def test_a_file_whose_name_holds_a_question_mark(tmp_path):
    path = write_obj(tmp_path).rename(tmp_path / "what?.obj")
    assert aolab.load(path).triangles == 1


def test_an_unknown_object():
    with pytest.raises(ParameterError, match=r"cannot load a builtins\.int; known: a name of scenes/"):
        aolab.load(3)


def test_a_pipe_is_refused_and_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.glb")
    refuse(tmp_path / "a.glb", "is a named pipe; give a regular file")
    os.mkfifo(tmp_path / "model.mtl")
    with (
        pytest.warns(Notice, match=r"'model\.mtl' is a named pipe; give a regular file; drawn without"),
        pytest.warns(Notice, match="'paint' is not defined"),
    ):
        aolab.load(write_obj(tmp_path, "mtllib model.mtl\nusemtl paint\n" + OBJ))


@pytest.mark.parametrize("suffix", [".glb", ".obj", ".stl"])
def test_a_sparse_file_of_20_gb_is_not_read(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    path.touch()
    os.truncate(path, 20_000_000_000)
    refuse(path, "the file is refused: it needs 20 GB of memory, and the limit is 2 GB")


def test_the_model_that_comes_with_aolab_is_found_anywhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene = aolab.load("knot.glb")
    assert (scene.source, scene.name) == ("knot.glb", "knot")
    assert aolab.load("knot.glb?shadows=0").source == "knot.glb?shadows=0"
    (tmp_path / "knot.glb").write_bytes(b"")
    with pytest.raises(FileError, match="is empty"):
        aolab.load("knot.glb")  # a file of that name in the folder comes first
