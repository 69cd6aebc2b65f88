"""OBJ and MTL as programs write them: indices, line ends, encodings, materials."""

import numpy as np
import pytest
from gltf_file import png
from PIL import Image

import aolab
from aolab.errors import FileError, Notice
from aolab.loading.obj import MANY
from aolab.pictures.images import linear_from_srgb

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
SQUARE = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
FACE = "usemtl paint\nf 1/1 2/2 3/3 4/4\n"


def write(folder, text, mtl=None, encoding="utf-8"):
    path = folder / "model.obj"
    path.write_bytes(text.encode(encoding))
    if mtl is not None:
        (folder / "model.mtl").write_text(mtl)
    return path


def meshes(path):
    return [instance.mesh for instance in aolab.load(path).instances]


def painted(folder, mtl):
    """The material of a square that MTL text describes."""
    (mesh,) = meshes(write(folder, "mtllib model.mtl\n" + SQUARE + FACE, f"newmtl paint\n{mtl}"))
    return mesh.material


def area(mesh):
    a, b, c = np.moveaxis(mesh.vertices.astype(float)[mesh.faces], 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


# --- faces


def test_a_concave_polygon(tmp_path):
    corners = "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 1 1 0\nv 1 3 0\nv 4 3 0\nv 4 4 0\nv 0 4 0\n"
    (mesh,) = meshes(write(tmp_path, corners + "f 1 2 3 4 5 6 7 8\n"))
    assert area(mesh) == pytest.approx(10)


def test_negative_indices_count_back_from_where_they_stand(tmp_path):
    second = TRIANGLE.replace(" 0\n", " 1\n")
    (mesh,) = meshes(write(tmp_path, f"{TRIANGLE}f -3 -2 -1\n{second}f -3 -2 -1\n"))
    np.testing.assert_array_equal(mesh.vertices[mesh.faces][:, :, 2], [[0, 0, 0], [1, 1, 1]])


@pytest.mark.parametrize(
    ("line", "match"),
    [
        ("f 0 1 2", r"line 4: 'f 0 1 2' has index 0; OBJ counts from 1"),
        ("f 1 2 4", r"line 4: 'f 1 2 4' has vertex 4 of 3"),
        ("f 1 2 -4", r"line 4: 'f 1 2 -4' has vertex -4 of 3"),
        ("f 1/1 2/1 3/1", r"line 4: .* has texture coordinate 1 of 0"),
        ("f 1//7 2//7 3//7", r"line 4: .* has normal 7 of 0"),
        ("f 1 2 three", r"line 4: 'three' is no corner of a face; write 1, 1/2, 1//3 or 1/2/3"),
        ("f 1/1/1/1 2 3", r"line 4: '1/1/1/1' is no corner of a face"),
        ("v 1 two 3\nf 1 2 3", r"line 4: 'v 1 two 3' is not made of numbers"),
        ("v 1 2\nf 1 2 3", r"line 4: 'v 1 2' has 2 numbers; 3 are needed"),
        ("f 1 2 99999999999999999999999", r"line 4: .*is no corner|has vertex"),
    ],
)
def test_a_fault_is_told_with_its_line(tmp_path, line, match):
    with pytest.raises(FileError, match=match):
        aolab.load(write(tmp_path, f"{TRIANGLE}{line}\n"))


def test_each_form_of_a_corner(tmp_path):
    text = SQUARE + "vn 0 0 2\n"
    for form in ("f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 2/2/1 3/3/1", "f 1/1/1 2//1 3/3/1"):
        (mesh,) = meshes(write(tmp_path, f"{text}{form}\n"))
        np.testing.assert_array_equal(mesh.vertices[mesh.faces[0]][:, :2], [(-1, -1), (1, -1), (1, 1)])
        np.testing.assert_allclose(mesh.normals, [[0, 0, 1]] * 3)
        assert (mesh.uv is not None) == ("/" in form.split()[1].replace("//", ""))


def test_seams_split_vertices_and_nothing_else_does(tmp_path):
    text = SQUARE + "vt 0.5 0.5\nf 1/1 2/2 3/3\nf 1/5 3/3 4/4\n"
    (mesh,) = meshes(write(tmp_path, text))
    assert len(mesh.vertices) == 5
    np.testing.assert_array_equal(mesh.uv[mesh.faces[1]], [(0.5, 0.5), (1, 1), (0, 1)])


def test_vertex_colours_are_srgb(tmp_path):
    text = "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n"
    (mesh,) = meshes(write(tmp_path, text))
    np.testing.assert_allclose(mesh.colors[:, :3], [(1, 0, 0), (0, 0.2140411, 0), (0, 0, 1)], atol=1e-6)
    assert mesh.material.base_color == (1, 1, 1)


def test_lines_beside_triangles_are_told(tmp_path):
    with pytest.warns(Notice, match="left out, as they hold no triangles: lines, points"):
        assert aolab.load(write(tmp_path, TRIANGLE + "f 1 2 3\nl 1 2\nl 2 3\np 1\n")).triangles == 1


def test_far_coordinates_keep_their_relief(tmp_path):
    """As at UTM coordinates: float32 has steps of half a unit there."""
    text = "v 500000.1 120.3 4000000.2\nv 500001.1 120.3 4000000.2\nv 500000.1 121.3 4000000.2\nf 1 2 3\n"
    scene = aolab.load(write(tmp_path, text))
    np.testing.assert_allclose(scene.bounds, [[500000.1, 120.3, 4000000.2], [500001.1, 121.3, 4000000.2]], rtol=1e-12)
    assert np.abs(scene.instances[0].mesh.vertices).max() <= 0.5


# --- files


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1"])
def test_line_ends_and_encodings(tmp_path, newline, encoding):
    text = (f"# Müller\n\t v 0 0 0\n\tv\t1 0 0\n{TRIANGLE}f 3 4 \\\n5 # the last\n").replace("\n", newline)
    (mesh,) = meshes(write(tmp_path, text, encoding=encoding))
    np.testing.assert_array_equal(mesh.vertices[mesh.faces[0]], [(0, 0, 0), (1, 0, 0), (0, 1, 0)])


def test_two_names_on_one_line_of_libraries(tmp_path):
    (tmp_path / "a.mtl").write_text("newmtl red\nKd 1 0 0\n")
    (tmp_path / "b c.mtl").write_text("newmtl green\nKd 0 1 0\n")
    (tmp_path / "d.mtl").write_text("newmtl blue\nKd 0 0 1\n")
    text = TRIANGLE + "mtllib a.mtl d.mtl\nmtllib b c.mtl\n"
    text += "".join(f"usemtl {name}\nf 1 2 3\n" for name in ("red", "green", "blue"))
    found = {mesh.material.name: mesh.material.base_color for mesh in meshes(write(tmp_path, text))}
    assert found == {"red": (1, 0, 0), "green": (0, 1, 0), "blue": (0, 0, 1)}


def test_a_material_is_a_part_however_often_it_is_used(tmp_path):
    (tmp_path / "model.mtl").write_text("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n")
    text = "mtllib model.mtl\n" + "".join(f"{TRIANGLE}usemtl {'ab'[i % 2]}\nf -3 -2 -1\n" for i in range(50))
    assert [len(mesh.faces) for mesh in meshes(write(tmp_path, text))] == [25, 25]


def test_a_name_of_100_000_characters_is_shortened(tmp_path):
    path = write(tmp_path, TRIANGLE + f"usemtl {'x' * 100_000}\nf 1 2 3\n")
    with pytest.warns(Notice) as caught:
        aolab.load(path)
    assert all(len(str(one.message)) < 400 for one in caught)


# --- materials


@pytest.fixture
def leaf(tmp_path):
    """A picture, a quarter of which is not transparent; and its alpha, as grey, at another size."""
    pixels = np.full((8, 8, 4), (0, 255, 0, 0), np.uint8)
    pixels[:4, :4, 3] = 255
    Image.fromarray(pixels).save(tmp_path / "leaf.png")
    Image.fromarray(pixels[..., :3]).save(tmp_path / "solid.png")
    Image.fromarray(pixels[::2, ::2, 3]).save(tmp_path / "mask.png")
    return pixels


@pytest.mark.parametrize(
    "mtl",
    [
        "map_Kd leaf.png\n",
        "map_Kd solid.png\nmap_d mask.png\n",
        "map_Kd leaf.png\nmap_d leaf.png\n",
        "map_d mask.png\n",
    ],
)
@pytest.mark.usefixtures("leaf")
def test_alpha_of_a_texture_cuts(tmp_path, lab, mtl):
    material = painted(tmp_path, mtl)
    assert material.alpha_cutoff == 0.5
    assert (material.texture.pixels[..., 3] >= 128).mean() == pytest.approx(0.25, abs=0.03)
    camera = aolab.Camera((0, 0, 5), (0, 0, 0), ortho=2)
    frame = lab.render(aolab.load(tmp_path / "model.obj"), "none", size=(32, 32), camera=camera)
    assert frame.mask.mean() == pytest.approx(0.25, abs=0.04)


@pytest.mark.parametrize(("mask", "color"), [((64, 64), (2, 2)), ((64, 4), (4, 64)), ((8, 8), (32, 32))])
def test_a_mask_of_another_size_keeps_its_holes(tmp_path, mask, color):
    """A comb of which one texel in four is drawn: in fewer texels, all would be a quarter, below the cutoff."""
    alpha = np.zeros(mask[::-1], np.uint8)
    alpha[:, ::4] = 255
    Image.fromarray(alpha).save(tmp_path / "mask.png")
    Image.new("RGB", color, (200, 100, 50)).save(tmp_path / "color.png")
    pixels = painted(tmp_path, "map_Kd color.png\nmap_d mask.png\n").texture.pixels
    assert pixels.shape == (max(mask[1], color[1]), max(mask[0], color[0]), 4)
    assert (pixels[..., 3] >= 128).mean() == pytest.approx(0.25, abs=0.06)
    assert (pixels[..., :3] == (200, 100, 50)).all()


def test_a_picture_without_holes_is_not_cut(tmp_path):
    (tmp_path / "a.png").write_bytes(png((10, 20, 30, 255)))
    assert painted(tmp_path, "map_Kd a.png\n").alpha_cutoff is None


@pytest.mark.parametrize(
    ("options", "scale", "offset", "wrap"),
    [
        ("-o 0.25 0.5 0 -s 2 3 1 -clamp on ", (2, 3), (0.25, 0.5), "clamp"),
        ("-s 2 ", (2, 1), (0, 0), "repeat"),
        ("-blendu on -mm 0 1 -texres 512 -imfchan l -bm 0.2 -boost 1 -cc off -t 0 0 0 ", (1, 1), (0, 0), "repeat"),
    ],
)
@pytest.mark.usefixtures("leaf")
def test_options_of_a_texture(tmp_path, options, scale, offset, wrap):
    material = painted(tmp_path, f"map_Kd {options}leaf.png\n")
    assert material.texture.name == "leaf.png"
    assert material.texture.wrap == (wrap, wrap)
    (mesh,) = meshes(tmp_path / "model.obj")
    corner = mesh.vertices[:, :2] / 2 + 0.5
    np.testing.assert_allclose(mesh.uv, corner * scale + offset)


@pytest.mark.parametrize(
    ("mtl", "alpha", "blend"),
    [("d 0.25", 0.25, True), ("Tr 0.25", 0.75, True), ("d 1", 1, False), ("Tr 1", 1, False), ("d 1\nTr 1", 1, False)],
)
def test_opacity(tmp_path, mtl, alpha, blend):
    """`Tr 1` is how MeshLab writes opaque."""
    if blend:
        with pytest.warns(Notice, match="material 'paint' is blended"):
            material = painted(tmp_path, f"Kd 1 1 1\n{mtl}\n")
    else:
        material = painted(tmp_path, f"Kd 1 1 1\n{mtl}\n")
    assert (material.alpha, material.blend) == (alpha, blend)


def test_emission(tmp_path):
    (tmp_path / "a.png").write_bytes(png((10, 20, 30, 255)))
    material = painted(tmp_path, "Kd 0 0 0\nKe 1 0.5 4\n")
    np.testing.assert_allclose(material.emission, (1, 0.2140411, 4), rtol=1e-6)
    assert painted(tmp_path, "Kd 0 0 0\nmap_Ke a.png\n").emission_texture.name == "a.png"


def test_statements_that_are_no_colours_are_told(tmp_path):
    with pytest.warns(Notice, match="Kd of material 'paint' is 'spectral x.rfl', no colour; left out"):
        assert painted(tmp_path, "Kd spectral x.rfl\n").base_color == (0.8, 0.8, 0.8)
    with pytest.warns(Notice, match=r"Kd of material 'paint' is outside \[0, 1\], and was clipped"):
        assert painted(tmp_path, "Kd 2 0 0\n").base_color == (1, 0, 0)


@pytest.mark.parametrize("name", ["C:\\\\paint\\\\a.png", "/home/bob/a.png"])
def test_a_texture_with_an_absolute_path_is_left_out(tmp_path, name):
    with pytest.warns(Notice, match="its texture .*; drawn without"):
        assert painted(tmp_path, f"Kd 1 0 0\nmap_Kd {name}\n").texture is None


def test_triangles_of_vertices_that_are_not_finite_are_left_out(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\n"
    with pytest.warns(aolab.Notice, match=r"left out: 1 of 2 triangles of mesh '.*', whose vertices are not finite"):
        (mesh,) = meshes(write(tmp_path, text))
    assert len(mesh.faces) == 1


@pytest.mark.parametrize("count", [MANY, MANY + 1])
@pytest.mark.parametrize("tinted", [False, True])
def test_many_materials_that_are_colours(tmp_path, count, tinted):
    """More than `MANY` become one part with the same colours; a glowing one and a textured one stay parts."""
    (tmp_path / "t.png").write_bytes(png((200, 100, 50, 255)))
    levels = np.arange(count) / count
    mtl = "".join(f"newmtl m{i}\nKd {level:.6f} 0.5 1\n" for i, level in enumerate(levels))
    mtl += "newmtl glow\nKe 1 0 0\nnewmtl leaf\nmap_Kd t.png\n"
    tint = " 1 0 1" if tinted else ""
    text = f"mtllib model.mtl\nv 0 0 0{tint}\nv 1 0 0{tint}\nv 0 1 0{tint}\nvt 0 0\n"
    names = [*(f"m{i}" for i in range(count)), "glow", "leaf"]
    found = meshes(write(tmp_path, text + "".join(f"usemtl {name}\nf 1/1 2/1 3/1\n" for name in names), mtl))
    assert len(found) == (count if count <= MANY else 1) + 2
    special = [mesh for mesh in found if mesh.material.texture is not None or any(mesh.material.emission)]
    assert len(special) == 2
    colors = []
    for mesh in found:
        if mesh not in special:
            rgb = np.ones((len(mesh.vertices), 3)) if mesh.colors is None else mesh.colors[:, :3]
            colors += (rgb[mesh.faces[:, 0]] * mesh.material.base_color).tolist()
    expected = linear_from_srgb(np.column_stack([levels, np.full(count, 0.5), np.ones(count)])) * (
        [1, 0, 1] if tinted else 1
    )
    np.testing.assert_allclose(sorted(colors), sorted(expected.tolist()), atol=1e-5)
