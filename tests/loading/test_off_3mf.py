"""OFF and 3MF."""

import zipfile

import numpy as np
import pytest

import aolab
from aolab.errors import FileError, Notice

SQUARE = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n"


def load(tmp_path, text, name="a.off"):
    (tmp_path / name).write_text(text)
    return aolab.load(tmp_path / name)


@pytest.mark.parametrize(
    "text",
    [
        f"OFF\n4 2 0\n{SQUARE}3 0 1 2\n3 0 2 3\n",
        f"OFF 4 1 0\n{SQUARE}4 0 1 2 3\n",
        f"# a remark\nOFF\n\n4 1 0 # counts\n{SQUARE}4 0 1 2 3\n",
        f"off\r\n4 1\r\n{SQUARE}4 0 1 2 3\r\n",
        "4OFF\n4 1 0\n0 0 0 1\n2 0 0 1\n2 1 0 1\n0 1 0 1\n4 0 1 2 3\n",
    ],
)
def test_polygons(tmp_path, text):
    scene = load(tmp_path, text)
    assert scene.triangles == 2
    np.testing.assert_allclose(np.ptp(scene.bounds, axis=0), (2, 1, 0))


def test_colours_normals_and_coordinates_of_vertices(tmp_path):
    text = "STCNOFF\n3 1 0\n" + "".join(
        f"{x} {y} 0  0 0.6 0.8  1 0 0 1  {x} {y}\n" for x, y in ((0, 0), (1, 0), (0, 1))
    ) + "3 0 1 2\n"  # fmt: skip
    mesh = load(tmp_path, text).instances[0].mesh
    np.testing.assert_allclose(mesh.normals, [(0, 0.6, 0.8)] * 3)
    np.testing.assert_allclose(mesh.colors, [(1, 0, 0, 1)] * 3)
    np.testing.assert_allclose(mesh.uv, mesh.vertices[:, :2])


def test_colours_of_faces(tmp_path):
    mesh = load(tmp_path, f"OFF\n4 2 0\n{SQUARE}3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n").instances[0].mesh
    np.testing.assert_allclose(mesh.colors[mesh.faces][:, :, :3], [[(1, 0, 0)] * 3, [(0, 0, 1)] * 3])


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("OFFSIDE\n", "is no OFF file: it starts with 'OFFSIDE'"),
        ("OFF\n", "the counts of vertices and faces are missing"),
        ("OFF\n1e9 1e9 0\n0 0 0\n", "is truncated: 1000000000 vertices"),
        ("OFF\n-1 1 0\n", "line 2: '-1 1 0' is no count"),
        ("OFF BINARY\n", "only the ASCII form is read"),
        (f"OFF\n4 1 0\n{SQUARE}3 0 1 9\n", "line 7: '3 0 1 9' has vertex 9 of 4, counted from 0"),
        (f"OFF\n4 1 0\n{SQUARE}3 0 1\n", "line 7: '3 0 1' has 2 corners, not 3"),
        (f"OFF\n4 1 0\n{SQUARE}3 0 1 two\n", "line 7: '3 0 1 two' is not made of numbers"),
    ],
)
def test_faults_of_an_off(tmp_path, text, match):
    with pytest.raises(FileError, match=match):
        load(tmp_path, text)


CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
MESH = (
    "<mesh><vertices>"
    + "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in ((0, 0, 0), (2, 0, 0), (0, 3, 0), (0, 0, 4)))
    + "</vertices><triangles>"
    + "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)))
    + "</triangles></mesh>"
)
OBJECT = f'<object id="1" name="wedge">{MESH}</object>'


def model(resources=OBJECT, build='<item objectid="1"/>', head=""):
    namespaces = f'xmlns="{CORE}" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"'
    content = f"<resources>{resources}</resources><build>{build}</build>"
    return f'<?xml version="1.0"?>{head}<model unit="millimeter" {namespaces}>{content}</model>'


def write(tmp_path, text, name="3D/3dmodel.model", more=()):
    path = tmp_path / "a.3mf"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, text)
        for other, content in more:
            archive.writestr(other, content)
    return path


def test_a_3mf_has_z_up(tmp_path):
    scene = aolab.load(write(tmp_path, model()))
    assert [instance.name for instance in scene.instances] == ["wedge"]
    np.testing.assert_allclose(scene.bounds, [(0, 0, -3), (2, 4, 0)], atol=1e-12)
    np.testing.assert_allclose(aolab.load(tmp_path / "a.3mf", up_axis="y").bounds, [(0, 0, 0), (2, 3, 4)])


def test_components_and_transforms(tmp_path):
    """Row vectors are multiplied from the left: the last three numbers are the translation."""
    resources = OBJECT + (
        '<object id="2"><components><component objectid="1"/>'
        '<component objectid="1" transform="2 0 0 0 1 0 0 0 1 10 0 0"/></components></object>'
    )
    build = '<item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 100"/>'
    scene = aolab.load(write(tmp_path, model(resources, build)), up_axis="y")
    assert scene.instances[0].mesh is scene.instances[1].mesh
    np.testing.assert_allclose(scene.bounds, [(0, 0, 100), (14, 3, 104)])


def test_the_relationships_name_the_model(tmp_path):
    kind = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
    relations = f'<Relationships><Relationship Target="/3D/other.model" Type="{kind}"/></Relationships>'
    path = write(tmp_path, model(), "3D/other.model", [("_rels/.rels", relations), ("3D/3dmodel.model", "<broken")])
    assert aolab.load(path).triangles == 4


def test_materials_are_told_to_be_unread(tmp_path):
    path = write(tmp_path, model('<m:colorgroup id="5"><m:color color="#FF0000"/></m:colorgroup>' + OBJECT))
    with pytest.warns(Notice, match="read, but not used: color, colorgroup"):
        aolab.load(path)


BOMB = '<!DOCTYPE m [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]>'
TWICE = '<object id="{}"><components><component objectid="{}"/><component objectid="{}"/></components></object>'
NESTED = OBJECT + "".join(TWICE.format(i, i - 1, i - 1) for i in range(2, 40))


@pytest.mark.parametrize(
    ("text", "match"),
    [
        (model(head=BOMB), "declares a document type, which is refused"),
        (model(head='<!DOCTYPE m SYSTEM "http://example.org/x.dtd">'), "declares a document type"),
        (model() + "<", "its XML is broken at line 1"),
        (model(build='<item objectid="7"/>'), "refers to object '7', which is not defined"),
        (model(OBJECT.replace('z="4"', "")), "its <vertex> lacks 'z'"),
        (model(OBJECT.replace('z="4"', 'z="four"')), "holds a vertex or triangle that is not made of numbers"),
        (model(build='<item objectid="1" transform="1 0"/>'), "its transform '1 0' is not twelve numbers"),
        (model(NESTED, '<item objectid="39"/>'), "components deep; the limit is 32|places more than 100000 objects"),
        (model('<object id="1"><components><component objectid="1"/></components></object>'), "components deep"),
    ],
)
def test_faults_of_a_3mf(tmp_path, text, match):
    with pytest.raises(FileError, match=match):
        aolab.load(write(tmp_path, text))


def test_an_archive_that_unpacks_to_more_than_the_memory(tmp_path):
    path = write(tmp_path, b"\0" * 30_000_000)
    assert path.stat().st_size < 100_000
    with pytest.raises(FileError, match="in the archive is refused: it needs 30 MB"):
        aolab.load(path, memory="10MB")


@pytest.mark.parametrize("damage", [slice(0, 30), slice(40, 60), slice(-30, None)])
def test_a_broken_archive(tmp_path, damage):
    data = bytearray(write(tmp_path, model()).read_bytes())
    data[damage] = bytes(len(data[damage]))
    (tmp_path / "a.3mf").write_bytes(data)
    with pytest.raises(FileError, match="is no readable 3MF file"):
        aolab.load(tmp_path / "a.3mf")
