"""PLY and STL as programs write them: line ends, texts before the data, polygons, strips."""

import struct

import numpy as np
import pytest
from PIL import Image

import aolab
from aolab.errors import FileError, Notice

POINTS = np.array([(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0)], "<f4")


def only_mesh(path):
    (instance,) = aolab.load(path).instances
    return instance.mesh


def write_ply(path, elements, data, newline="\n", form="binary_little_endian"):
    header = ["ply", f"format {form} 1.0", *elements, "end_header", ""]
    path.write_bytes(newline.join(header).encode("latin-1") + data)
    return path


VERTICES = [f"element vertex {len(POINTS)}", "property float x", "property float y", "property float z"]
FACES = ["element face 2", "property list uchar int vertex_indices"]
MIXED = struct.pack("<B4i", 4, 0, 1, 2, 4) + struct.pack("<B3i", 3, 2, 3, 4)


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_mixed_polygons_of_a_binary_ply(tmp_path, newline):
    mesh = only_mesh(write_ply(tmp_path / "a.ply", VERTICES + FACES, POINTS.tobytes() + MIXED, newline))
    assert len(mesh.faces) == 3
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0), (2, 2, 0))


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_mixed_polygons_of_an_ascii_ply(tmp_path, newline):
    rows = [" ".join(map(str, point)) for point in POINTS.tolist()] + ["4 0 1 2 4", "3 2 3 4", ""]
    data = newline.join(rows).encode()
    mesh = only_mesh(write_ply(tmp_path / "a.ply", VERTICES + FACES, data, newline, "ascii"))
    assert len(mesh.faces) == 3


def test_a_big_endian_ply_with_other_properties(tmp_path):
    vertex = np.dtype([("flag", ">u1"), ("xyz", ">f8", 3), ("q", ">i2")])
    rows = np.zeros(len(POINTS), vertex)
    rows["xyz"] = POINTS
    elements = [f"element vertex {len(POINTS)}", "property uchar flag", *(f"property double {a}" for a in "xyz"),
                "property short quality", "element edge 1", "property int vertex1", "property int vertex2",
                "element face 1", "property uchar flags", "property list uchar uint vertex_index"]  # fmt: skip
    data = rows.tobytes() + struct.pack(">2i", 0, 1) + struct.pack(">2B3I", 7, 3, 0, 1, 2)
    path = write_ply(tmp_path / "a.ply", elements, data, form="binary_big_endian")
    with pytest.warns(Notice, match="left out, as they hold no triangles: lines"):
        mesh = only_mesh(path)
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0), (2, 1, 0))


@pytest.mark.parametrize(("before", "word"), [("\ufeff", "ply"), ("\n ", "ply"), ("", "PLY")])
def test_beginnings_of_a_ply(tmp_path, before, word):
    path = write_ply(tmp_path / "a.ply", VERTICES + FACES, POINTS.tobytes() + MIXED)
    path.write_bytes((before + word).encode() + path.read_bytes()[3:])
    assert len(only_mesh(path).faces) == 3


@pytest.mark.parametrize("comment", ["comment von Müller", "obj_info num_cols 512", "comment"])
def test_comments_of_a_ply(tmp_path, comment):
    path = write_ply(tmp_path / "a.ply", [comment, *VERTICES, *FACES], POINTS.tobytes() + MIXED)
    assert len(only_mesh(path).faces) == 3


def test_triangle_strips(tmp_path):
    """Two strips of one list, with -1 between: 0 1 2 3, and 2 3 4."""
    strip = struct.pack("<i8i", 8, 0, 1, 2, 3, -1, 2, 3, 4)
    elements = [*VERTICES, "element tristrips 1", "property list int int vertex_indices"]
    mesh = only_mesh(write_ply(tmp_path / "a.ply", elements, POINTS.tobytes() + strip))
    found = {tuple(map(tuple, triangle[:, :2].tolist())) for triangle in mesh.vertices[mesh.faces]}
    corners = [tuple(point[:2].tolist()) for point in POINTS]
    # the second triangle of a strip runs the other way round
    assert found == {tuple(corners[i] for i in face) for face in ((0, 1, 2), (2, 1, 3), (2, 3, 4))}


def test_texture_coordinates_of_corners(tmp_path):
    face = struct.pack("<B3iB6f", 3, 0, 1, 2, 6, 0, 0, 1, 0, 1, 1)
    elements = [*VERTICES, "element face 1", "property list uchar int vertex_indices",
                "property list uchar float texcoord"]  # fmt: skip
    mesh = only_mesh(write_ply(tmp_path / "a.ply", elements, POINTS.tobytes() + face))
    np.testing.assert_array_equal(mesh.uv[mesh.faces[0]], [(0, 0), (1, 0), (1, 1)])


@pytest.mark.parametrize(
    ("elements", "match"),
    [
        (["element vertex many"], "has a header line that is not PLY: 'element vertex many'"),
        (["element vertex -1"], "has a header line that is not PLY"),
        (["property float x"], "has a header line that is not PLY"),
        (["element vertex 2", "property half x"], "'property half x'"),
        (["element vertex 1", "property float x"], "has no vertices with x, y and z"),
        (["element vertex 99999999999", "property float x"], r"is truncated: element 'vertex' .* and \d+ are left"),
    ],
)
def test_faults_of_a_ply(tmp_path, elements, match):
    path = write_ply(tmp_path / "a.ply", elements, POINTS.tobytes())
    with pytest.raises(FileError, match=match) as caught:
        aolab.load(path)
    assert str(path) in str(caught.value)


CUBE = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def ascii_stl(name="cube", end="endsolid\n", newline="\n"):
    text = f"solid {name}\n"
    for start in (0, 3):
        vertices = "".join(f"      vertex {x} {y}e0 {z}\n" for x, y, z in CUBE[start : start + 3])
        text += f"  facet normal 0 0 1\n    outer loop\n{vertices}    endloop\n  endfacet\n"
    return (text + end).replace("\n", newline)


@pytest.mark.parametrize(
    "data",
    [
        ascii_stl().encode(),
        b" " + ascii_stl().encode(),
        b"\n\t" + ascii_stl().encode(),
        ascii_stl().encode("utf-8-sig"),
        ascii_stl("Würfel").encode("latin-1"),
        ascii_stl("").encode(),
        ascii_stl(newline="\r\n").encode(),
        ascii_stl(newline="\r").encode(),
        ascii_stl(newline=" ").encode(),
        ascii_stl().upper().encode(),
        ascii_stl(end="endsolid cube\n\0\0\0").encode(),
        ascii_stl(end="endsolid cube\nexported at noon\n").encode(),
        ascii_stl("the outer loop").encode(),
        ascii_stl("facet of vertex 1 2 3").encode(),
        ascii_stl().partition("\n")[2].encode(),  # without "solid"
        ascii_stl().encode("utf-16"),
        ascii_stl().encode("utf-16-le"),
    ],
)
def test_an_ascii_stl(tmp_path, data):
    (tmp_path / "a.stl").write_bytes(data)
    mesh = only_mesh(tmp_path / "a.stl")
    assert len(mesh.faces) == 2
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0), (1, 1, 0))


def binary_stl(header=b"binary", tail=b""):
    rows = np.zeros(2, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]))
    rows["corners"] = np.reshape(CUBE, (2, 3, 3))
    return header.ljust(80, b"\0")[:80] + struct.pack("<I", 2) + rows.tobytes() + tail


@pytest.mark.parametrize(
    ("header", "tail"),
    [
        (b"binary", b""),
        (b"binary", b"a remark"),
        (b"solid a binary file that begins as text", b""),
        (b"solid a binary file that begins as text", b"a remark"),
        (b"solid " + b" " * 74, b""),
    ],
)
def test_a_binary_stl(tmp_path, header, tail):
    (tmp_path / "a.stl").write_bytes(binary_stl(header, tail))
    assert len(only_mesh(tmp_path / "a.stl").faces) == 2


@pytest.mark.parametrize(
    ("data", "match"),
    [
        (
            ascii_stl().replace("vertex 1 1", "vertex 1").encode(),
            "is truncated or corrupt: 2 facets hold 5",
        ),
        (ascii_stl().replace("vertex 1 1e0 0", "vertex 1 one 0").encode(), "vertex 4 holds b'one', no number"),
        (ascii_stl()[:-60].encode(), "is truncated or corrupt: 2 facets hold"),
        (b"solid nothing\nendsolid\n", "0 facets hold 0|is empty"),
    ],
)
def test_faults_of_an_stl(tmp_path, data, match):
    (tmp_path / "a.stl").write_bytes(data)
    with pytest.raises(aolab.Error, match=match):
        aolab.load(tmp_path / "a.stl")


def test_a_text_without_its_end_is_told(tmp_path):
    (tmp_path / "a.stl").write_text(ascii_stl(end=""))
    with pytest.warns(Notice, match="does not end with 'endsolid', and may be truncated"):
        assert len(only_mesh(tmp_path / "a.stl").faces) == 2


def test_parts_of_a_ply_that_are_not_drawn_are_told(tmp_path):
    elements = [*VERTICES, "element material 1", "property uchar shine", *FACES]
    elements[:0] = ["comment TextureFile a.png", "comment TextureFile b.png"]
    Image.new("RGB", (2, 2)).save(tmp_path / "a.png")
    path = write_ply(tmp_path / "a.ply", elements, POINTS.tobytes() + b"\7" + MIXED)
    with pytest.warns(Notice) as caught:
        only_mesh(path)
    told = "\n".join(str(one.message) for one in caught)
    assert "read, but not used: element 'material'" in told
    assert "all but the first of its 2 textures were left out" in told
    assert "its texture 'a.png' was left out: neither vertices nor faces have coordinates for it" in told


def test_strips_beside_coloured_faces(tmp_path):
    elements = [*VERTICES, *FACES, *(f"property uchar {name}" for name in ("red", "green", "blue"))]
    elements += ["element tristrips 1", "property list int int vertex_indices"]
    elements[4] = "element face 1"
    data = POINTS.tobytes() + struct.pack("<B3i3B", 3, 0, 1, 2, 255, 0, 0) + struct.pack("<4i", 3, 0, 2, 4)
    with pytest.warns(Notice, match="colours and texture coordinates of faces were left out, as strips have none"):
        assert len(only_mesh(write_ply(tmp_path / "a.ply", elements, data)).faces) == 2
