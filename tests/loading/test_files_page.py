"""The table of docs/files.md: each cell against a small file of its feature and format. A cell that lies is red."""

import re
import warnings
import zipfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_file import GltfFile, png
from PIL import Image

import aolab

FORMATS = ("glTF", "OBJ", "PLY", "STL", "OFF", "3MF")
# the words that a cell may state; a cell's first one counts, and a case measures one of them
WORDS = ("left out", "not used", "not drawn", "made", "linear", "sRGB", "share of pixels", "refused", "read",
         "the first", "kept", "drawn", "y", "z")  # fmt: skip
TRIANGLE = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
NOTCHED = [(0, 0, 0), (4, 0, 0), (4, 1, 0), (1, 1, 0), (1, 3, 0), (4, 3, 0), (4, 4, 0), (0, 4, 0)]  # area 10, a fan 16
HALF = 0.5**2.2  # linear, of an sRGB value of 0.5; 0.214 by the exact curve
CASES: dict[tuple[str, str], Callable[[Path], str]] = {}


def table() -> dict[tuple[str, str], str]:
    """The cells of the page by row and format."""
    page = (Path(__file__).parents[2] / "docs" / "files.md").read_text()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in page.splitlines() if line.startswith("|")]
    assert [head.split(" ")[0] for head in rows[0][1:]] == list(FORMATS)
    rows = [row for row in rows[2:] if not row[0].startswith("**")]
    return {(row[0], name): cell for row in rows for name, cell in zip(FORMATS, row[1:], strict=True)}


CELLS = {place: cell for place, cell in table().items() if cell != "–"}


def case(row: str, *formats: str) -> Callable[[Any], Any]:
    """A function (folder, format) that makes a file with the row's feature, and returns the word it measures."""

    def keep(function: Any) -> Any:
        for name in formats:
            CASES[row, name] = partial(function, name=name)
        return function

    return keep


@pytest.mark.parametrize(("row", "name"), CELLS)
def test_a_cell_is_true(row, name, tmp_path):
    assert (row, name) in CASES, "a cell without a case: add one to this file"
    stated = re.search("|".join(rf"\b{word}\b" for word in WORDS), CELLS[row, name])
    assert stated is not None, f"the cell holds none of {WORDS}"
    assert stated[0] == CASES[row, name](tmp_path)


def test_no_case_has_lost_its_cell():
    assert {*CASES} == {*CELLS}


# --- files


def load(path: Path, **options: Any) -> tuple[aolab.Scene, str]:
    """The scene, and the notices."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        scene = aolab.load(path, **options)
    return scene, "\n".join(str(one.message) for one in caught)


def text(folder: Path, name: str, content: str) -> Path:
    (folder / name).write_text(content)
    return folder / name


def lines(word: str, rows: Any) -> str:
    return "".join(" ".join([word, *map(str, row)]).strip() + "\n" for row in rows)


def obj(folder: Path, content: str, mtl: str | None = None) -> Path:
    if mtl is not None:
        text(folder, "a.mtl", "newmtl m\n" + mtl)
        content = "mtllib a.mtl\nusemtl m\n" + content
    return text(folder, "a.obj", content)


def ply(
    folder: Path, vertices: Any, faces: Any, vertex: str = "", face: str = "", more: str = "", tail: str = ""
) -> Path:
    """Properties as in "uchar red, uchar green"."""
    head = f"ply\nformat ascii 1.0\n{more if more.startswith('comment') else ''}element vertex {len(vertices)}\n"
    head += "".join(f"property {one}\n" for one in ["float x", "float y", "float z", *filter(None, vertex.split(", "))])
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
    head += "".join(f"property {one}\n" for one in filter(None, face.split(", ")))
    head += ("" if more.startswith("comment") else more) + "end_header\n"
    return text(folder, "a.ply", head + lines("", vertices) + lines("", faces) + tail)


def off(folder: Path, vertices: Any, faces: Any, kind: str = "OFF") -> Path:
    return text(folder, "a.off", f"{kind}\n{len(vertices)} {len(faces)} 0\n" + lines("", vertices) + lines("", faces))


def stl(folder: Path, *triangles: Any) -> Path:
    facets = "".join(
        f"facet normal 0 0 0\nouter loop\n{lines('vertex', corners)}endloop\nendfacet\n" for corners in triangles
    )
    return text(folder, "a.stl", f"solid a\n{facets}endsolid a\n")


def threemf(folder: Path, vertices: Any, faces: Any, items: str = '<item objectid="1"/>', resources: str = "") -> Path:
    vertex = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in vertices)
    triangle = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    model = '<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" '
    model += f'xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"><resources>{resources}'
    model += f'<object id="1"><mesh><vertices>{vertex}</vertices><triangles>{triangle}</triangles></mesh></object>'
    with zipfile.ZipFile(folder / "a.3mf", "w") as archive:
        archive.writestr("3D/3dmodel.model", f"{model}</resources><build>{items}</build></model>")
    return folder / "a.3mf"


def made(folder: Path, name: str, vertices: Any = TRIANGLE, faces: Any = ((0, 1, 2),)) -> Path:
    """A file of triangles in any format."""
    counted = [(3, *face) for face in faces]
    if name == "glTF":
        file = GltfFile(folder)
        file.attribute("POSITION", np.array(vertices, np.float32))
        file.header["meshes"][0]["primitives"][0]["indices"] = file.accessor(np.array(faces, np.uint16).reshape(-1))
        return file.glb()
    if name == "OBJ":
        return obj(folder, lines("v", vertices) + lines("f", np.add(faces, 1).tolist()))
    if name == "STL":
        return stl(folder, *[[vertices[corner] for corner in face] for face in faces])
    write = {"PLY": ply, "OFF": off}.get(name)
    return threemf(folder, vertices, faces) if write is None else write(folder, vertices, counted)


def only(path: Path, **options: Any) -> Any:
    """The only mesh of a file."""
    (instance,) = load(path, **options)[0].instances
    return instance.mesh


def area(mesh: Any) -> float:
    a, b, c = np.moveaxis(mesh.vertices.astype(float)[mesh.faces], 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def noticed(path: Path, *words: str) -> str:
    """ "left out" if notices have all the words and a triangle is drawn."""
    scene, notices = load(path)
    assert scene.triangles == 1
    return "left out" if all(word in notices for word in words) else f"no notice: {notices}"


def space(values: Any) -> str:
    """Whether a stored 0.5 was taken as linear or as sRGB."""
    value = float(np.asarray(values).reshape(-1)[0])
    return "linear" if abs(value - 0.5) < 0.01 else "sRGB" if abs(value - 0.214) < 0.01 else f"neither: {value}"


def drawn(found: bool) -> str:
    return "drawn" if found else "not drawn"


# --- geometry


@case("triangles", *FORMATS)
def triangles(folder, name):
    return drawn(load(made(folder, name))[0].triangles == 1)


@case("polygons, also concave", "OBJ", "PLY", "OFF")
def polygons(folder, name):
    corners = range(len(NOTCHED))
    if name == "OBJ":
        path = obj(folder, lines("v", NOTCHED) + lines("f", [[corner + 1 for corner in corners]]))
    else:
        path = (ply if name == "PLY" else off)(folder, NOTCHED, [(len(NOTCHED), *corners)])
    return drawn(area(only(path)) == pytest.approx(10))


@case("triangle strips and fans", "glTF")
def strips_and_fans(folder, name):
    file = GltfFile(folder)
    file.attribute("POSITION", np.array([*TRIANGLE, (1, 1, 0)], np.float32))
    areas = []
    for mode, order in ((5, [0, 1, 2, 3]), (6, [0, 1, 3, 2])):
        primitive = file.header["meshes"][0]["primitives"][0]
        primitive.update(mode=mode, indices=file.accessor(np.array(order, np.uint8)))
        areas.append(area(only(file.glb())))
    return drawn(areas == pytest.approx([1, 1]))


@case("triangle strips and fans", "PLY")
def strips(folder, name):
    strip = "element tristrips 1\nproperty list int int vertex_indices\n"
    return drawn(
        area(only(ply(folder, [*TRIANGLE, (1, 1, 0)], [], more=strip, tail="4 0 1 2 3\n"))) == pytest.approx(1)
    )


@case("points, lines", "glTF")
def points_of_gltf(folder, name):
    file = GltfFile(folder)
    file.header["meshes"][0]["primitives"] += [{"attributes": {"POSITION": 0}, "mode": mode} for mode in (0, 1)]
    return noticed(file.glb(), "holds points", "holds lines")


@case("points, lines", "OBJ")
def points_of_obj(folder, name):
    return noticed(obj(folder, lines("v", TRIANGLE) + "f 1 2 3\np 1\nl 1 2\n"), "points", "lines")


@case("points, lines", "PLY")
def points_of_ply(folder, name):
    edges = "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
    return noticed(ply(folder, TRIANGLE, [(3, 0, 1, 2)], more=edges, tail="0 1\n"), "left out", "lines")


@case("curves, surfaces", "OBJ")
def curves(folder, name):
    text = lines("v", TRIANGLE) + "f 1 2 3\ncstype bezier\ndeg 2\ncurv 0 1 1 2 3\nsurf 0 1 0 1 1 2 3\nend\n"
    return noticed(obj(folder, text), "curves", "surfaces")


@case("normals", *FORMATS)
def normals(folder, name):
    tilted = (0, 0.6, 0.8)
    if name == "glTF":
        file = GltfFile(folder)
        file.attribute("NORMAL", np.array([tilted] * 3, np.float32))
        path = file.glb()
    elif name == "OBJ":
        path = obj(folder, lines("v", TRIANGLE) + lines("vn", [tilted]) + "f 1//1 2//1 3//1\n")
    elif name in ("PLY", "OFF"):
        rows = [(*corner, *tilted) for corner in TRIANGLE]
        path = off(folder, rows, [(3, 0, 1, 2)], "NOFF") if name == "OFF" else None
        path = path or ply(folder, rows, [(3, 0, 1, 2)], vertex="float nx, float ny, float nz")
    elif name == "STL":
        path = stl(folder, TRIANGLE)
        path.write_text(path.read_text().replace("normal 0 0 0", "normal 0 0.6 0.8"))
    else:
        path = made(folder, name)
    found = only(path).normals[0]
    return "drawn" if found == pytest.approx(tilted) else "made" if found == pytest.approx((0, 0, 1)) else str(found)


@case("degenerate triangles", *FORMATS)
def degenerate(folder, name):
    return noticed(made(folder, name, [*TRIANGLE, (2, 0, 0)], [(0, 1, 2), (0, 1, 3)]), "degenerate")


@case("sparse and quantized accessors", "glTF")
def sparse(folder, name):
    file = GltfFile(folder)
    view = file.view(np.array([(0, 0, 0, 0), (127, 0, 0, 0), (0, 127, 0, 0)], np.int8).tobytes())
    file.header["bufferViews"][view]["byteStride"] = 4
    file.header["accessors"][0].update(bufferView=view, componentType=5120, normalized=True)
    places, values = file.view(b"\2"), file.view(np.array([0, -127, 0], np.int8).tobytes())
    file.header["accessors"][0]["sparse"] = {
        "count": 1, "indices": {"bufferView": places, "componentType": 5121}, "values": {"bufferView": values}
    }  # fmt: skip
    file.header["extensionsUsed"] = ["KHR_mesh_quantization"]
    return drawn(load(file.glb())[0].bounds.tolist() == [[0, -1, 0], [1, 0, 0]])


@case("Draco (extra `draco`)", "glTF")
def draco(folder, name):
    DracoPy = pytest.importorskip("DracoPy", reason="the extra draco")
    file = GltfFile(folder)
    data = DracoPy.encode(np.array(TRIANGLE, np.float32) * 3, np.array([[0, 1, 2]], np.uint32), quantization_bits=20)
    attributes = {"POSITION": DracoPy.decode(data).attributes[0]["unique_id"]}
    del file.header["accessors"][0]["bufferView"]
    extension = {"KHR_draco_mesh_compression": {"bufferView": file.view(data), "attributes": attributes}}
    file.header["meshes"][0]["primitives"][0]["extensions"] = extension
    return drawn(area(only(file.glb())) == pytest.approx(4.5, rel=1e-3))


@case("meshopt (extra `meshopt`)", "glTF")
def meshopt(folder, name):
    library = pytest.importorskip("meshopt", reason="the extra meshopt")
    file = GltfFile(folder)
    view = file.header["bufferViews"][file.view(library.encode_gltf_buffer(np.array(TRIANGLE, "f4") * 3, "ATTRIBUTES"))]
    extension = {**view, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}
    file.header["bufferViews"][0]["extensions"] = {"EXT_meshopt_compression": extension}
    return drawn(area(only(file.glb())) == pytest.approx(4.5))


# --- placement


@case("nodes, instances", "glTF")
def nodes(folder, name):
    file = GltfFile(folder)
    file.header["nodes"] = [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 2]}, {"children": [0, 1], "scale": [2] * 3}]
    file.header["scenes"] = [{"nodes": [2]}]
    return drawn(load(file.glb())[0].bounds[1].tolist() == [2, 2, 4])


@case("nodes, instances", "3MF")
def components(folder, name):
    items = '<item objectid="1"/><item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>'
    return drawn(load(threemf(folder, TRIANGLE, [(0, 1, 2)], items))[0].bounds[1, 0] == 6)


@case("`EXT_mesh_gpu_instancing`", "glTF")
def instancing(folder, name):
    file = GltfFile(folder)
    places = {"TRANSLATION": file.accessor(np.array([(0, 0, 0), (5, 0, 0)], np.float32))}
    file.header["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": places}}
    return drawn(load(file.glb())[0].bounds[1, 0] == 6)


@case("skins, morph targets, animations", "glTF")
def moving(folder, name):
    file = GltfFile(folder)
    primitive = file.header["meshes"][0]["primitives"][0]
    primitive["targets"] = [{"POSITION": file.accessor(np.array([(0, 0, 1)] * 3, np.float32))}]
    file.attribute("JOINTS_0", np.zeros((3, 4), np.uint8))
    file.attribute("WEIGHTS_0", np.array([(1, 0, 0, 0)] * 3, np.float32))
    file.header["skins"] = [{"joints": [1]}]
    file.header["nodes"] = [{"mesh": 0, "skin": 0}, {"translation": [0, 10, 0]}]
    file.header["scenes"] = [{"nodes": [0, 1]}]
    times = file.accessor(np.array([0, 2], np.float32))
    outputs = [0, 1], [(0, 10, 0), (20, 10, 0)]
    file.header["animations"] = [{
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}},
                     {"sampler": 1, "target": {"node": 1, "path": "translation"}}],
        "samplers": [{"input": times, "output": file.accessor(np.array(output, np.float32))} for output in outputs],
    }]  # fmt: skip
    return drawn(load(file.glb(), time=1)[0].bounds[0].tolist() == [10, 10, 0.5])


@case("a node without extent (a scale of 0)", "glTF", "3MF")
def without_extent(folder, name):
    if name == "glTF":
        file = GltfFile(folder)
        file.header["nodes"].append({"mesh": 0, "scale": [0, 0, 0]})
        file.header["scenes"] = [{"nodes": [0, 1]}]
        path = file.glb()
    else:
        items = '<item objectid="1"/><item objectid="1" transform="0 0 0 0 0 0 0 0 0 5 0 0"/>'
        path = threemf(folder, TRIANGLE, [(0, 1, 2)], items)
    return noticed(path, "left out: instance", "singular")


@case("nodes that are not visible (`KHR_node_visibility`)", "glTF")
def hidden(folder, name):
    file = GltfFile(folder)
    file.header["nodes"].append({"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": False}}})
    file.header["scenes"] = [{"nodes": [0, 1]}]
    return drawn(load(file.glb())[0].triangles > 1)


# --- surfaces


@case("base colour, linear or sRGB", "glTF", "OBJ")
def base_color(folder, name):
    if name == "OBJ":
        path = obj(folder, lines("v", TRIANGLE) + "f 1 2 3\n", "Kd 0.5 0.5 0.5\n")
    else:
        file = GltfFile(folder)
        file.material(pbrMetallicRoughness={"baseColorFactor": [0.5, 0.5, 0.5, 1]})
        path = file.glb()
    return space(only(path).material.base_color)


@case("base colour, linear or sRGB", "3MF")
def base_materials(folder, name):
    red = '<basematerials id="9"><base name="red" displaycolor="#FF0000"/></basematerials>'
    notices = load(threemf(folder, TRIANGLE, [(0, 1, 2)], resources=red))[1]
    return "not used" if "not used: basematerials" in notices else notices


@case("vertex colours", "glTF", "OBJ", "PLY", "OFF")
def vertex_colors(folder, name):
    rows = [(*corner, 0.5, 0.5, 0.5) for corner in TRIANGLE]
    if name == "glTF":
        file = GltfFile(folder)
        file.attribute("COLOR_0", np.full((3, 3), 0.5, np.float32))
        path = file.glb()
    elif name == "OBJ":
        path = obj(folder, lines("v", rows) + "f 1 2 3\n")
    elif name == "PLY":
        rows = [(*corner, 128, 128, 128) for corner in TRIANGLE]
        path = ply(folder, rows, [(3, 0, 1, 2)], vertex="uchar red, uchar green, uchar blue")
    else:
        path = off(folder, [(*row, 1) for row in rows], [(3, 0, 1, 2)], "COFF")
    mesh = only(path)
    assert mesh.material.base_color == (1, 1, 1)
    return space(mesh.colors)


@case("baked occlusion of vertices (`_OCCLUSION`, see below)", "glTF")
def occlusion(folder, name):
    file = GltfFile(folder)
    file.attribute("_OCCLUSION", np.array([0.25, 0.5, 1], np.float32))
    return "read" if only(file.glb()).visibility.reshape(-1).tolist() == [0.25, 0.5, 1] else "not read"


@case("face colours", "PLY", "OFF")
def face_colors(folder, name):
    if name == "PLY":
        path = ply(folder, TRIANGLE, [(3, 0, 1, 2, 128, 128, 128)], face="uchar red, uchar green, uchar blue")
    else:
        path = off(folder, TRIANGLE, [(3, 0, 1, 2, 128, 128, 128)])
    return space(only(path).colors)


def has_texture(mesh: Any) -> bool:
    return mesh.material.texture is not None and mesh.material.texture.pixels[0, 0, 0] == 9 and mesh.uv[1, 0] == 1


@case("texture of the base colour", "glTF", "OBJ", "PLY")
def texture(folder, name):
    (folder / "t.png").write_bytes(png((9, 8, 7, 255)))
    uv = [(0, 0), (1, 0), (0, 1)]
    if name == "glTF":
        file = GltfFile(folder)
        file.attribute("TEXCOORD_0", np.array(uv, np.float32))
        file.image(uri="t.png")
        path = file.glb()
    elif name == "OBJ":
        path = obj(folder, lines("v", TRIANGLE) + lines("vt", uv) + "f 1/1 2/2 3/3\n", "map_Kd t.png\n")
    else:
        rows = [(*corner, *at) for corner, at in zip(TRIANGLE, uv, strict=True)]
        path = ply(folder, rows, [(3, 0, 1, 2)], vertex="float s, float t", more="comment TextureFile t.png\n")
    return drawn(has_texture(only(path)))


@case("texture of the base colour", "3MF")
def texture_of_3mf(folder, name):
    resource = '<m:texture2d id="7" path="/3D/Textures/t.png" contenttype="image/png"/>'
    notices = load(threemf(folder, TRIANGLE, [(0, 1, 2)], resources=resource))[1]
    return "not used" if "not used: texture2d" in notices else notices


@case("wrap, filter and transform of textures", "glTF", "OBJ")
def sampler(folder, name):
    (folder / "t.png").write_bytes(png((9, 8, 7, 255)))
    if name == "glTF":
        file = GltfFile(folder)
        file.attribute("TEXCOORD_0", np.array([(0, 0), (1, 0), (0, 1)], np.float32))
        file.image(uri="t.png")
        file.header["samplers"] = [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9729}]
        file.header["textures"][0]["sampler"] = 0
        info = file.header["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
        info["extensions"] = {"KHR_texture_transform": {"scale": [2, 2]}}
        path, wrap = file.glb(), ("clamp", "mirror")
    else:
        content = lines("v", TRIANGLE) + lines("vt", [(0, 0), (1, 0), (0, 1)]) + "f 1/1 2/2 3/3\n"
        path, wrap = obj(folder, content, "map_Kd -s 2 2 2 -clamp on t.png\n"), ("clamp", "clamp")
    mesh = only(path)
    read = mesh.material.texture
    filtered = name == "OBJ" or (read.nearest and not read.mipmaps)
    return drawn(read.wrap == wrap and filtered and mesh.uv[1, 0] == 2)


@case("cut-outs", "glTF", "OBJ")
def cutouts(folder, name):
    (folder / "t.png").write_bytes(png((9, 8, 7, 100)))
    Image.new("L", (2, 2), 100).save(folder / "mask.png")
    if name == "glTF":
        file = GltfFile(folder)
        file.material(alphaMode="MASK", alphaCutoff=0.25)
        return drawn(only(file.glb()).material.alpha_cutoff == 0.25)
    square = lines("v", TRIANGLE) + lines("vt", [(0, 0), (1, 0), (0, 1)]) + "f 1/1 2/2 3/3\n"
    found = [only(obj(folder, square, mtl)).material for mtl in ("map_Kd t.png\n", "map_d mask.png\n")]
    return drawn(all(one.alpha_cutoff is not None and one.texture.pixels[0, 0, 3] == 100 for one in found))


@case("blending", "glTF", "OBJ")
def blending(folder, name):
    if name == "glTF":
        file = GltfFile(folder)
        file.material(alphaMode="BLEND", pbrMetallicRoughness={"baseColorFactor": [1, 1, 1, 0.25]})
        paths = [file.glb()]
    else:
        paths = [obj(folder, lines("v", TRIANGLE) + "f 1 2 3\n", "d 0.25\n")]
    for path in paths:
        scene, notices = load(path)
        material = scene.instances[0].mesh.material
        if not (material.blend and material.alpha == 0.25 and "as many of the pixels as its alpha states" in notices):
            return notices
    return "share of pixels"


@case("single-sided surfaces", "glTF")
def sides(folder, name):
    file = GltfFile(folder)
    file.material(doubleSided=True)
    both = only(file.glb()).material.double_sided
    file.material()
    return drawn(both and not only(file.glb()).material.double_sided)


@case("emission", "glTF", "OBJ")
def emission(folder, name):
    if name == "glTF":
        file = GltfFile(folder)
        file.material(emissiveFactor=[1, 0, 0], extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 4}})
        return drawn(only(file.glb()).material.emission == (4, 0, 0))
    (folder / "t.png").write_bytes(png((9, 8, 7, 255)))
    content = lines("v", TRIANGLE) + lines("vt", [(0, 0), (1, 0), (0, 1)]) + "f 1/1 2/2 3/3\n"
    material = only(obj(folder, content, "Ke 4 0 0\nmap_Ke t.png\n")).material
    return drawn(material.emission == (4, 0, 0) and material.emission_texture is not None)


@case("normal maps, tangents", "glTF")
def normal_maps(folder, name):
    file = GltfFile(folder)
    file.attribute("TEXCOORD_0", np.array([(0, 0), (1, 0), (0, 1)], np.float32))
    file.attribute("TANGENT", np.array([(0, 1, 0, -1)] * 3, np.float32))
    file.attribute("NORMAL", np.array([(0, 0, 1)] * 3, np.float32))
    file.image(bufferView=file.view(png((128, 128, 255, 255))))
    file.header["materials"][0].update(normalTexture={"index": 0, "scale": 0.5})
    mesh = only(file.glb())
    return drawn(mesh.material.normal_scale == 0.5 and mesh.tangents[0].tolist() == [0, 1, 0, -1])


@case("normal maps, tangents", "OBJ")
@case("height maps", "OBJ")
def bumps(folder, name):
    content = lines("v", TRIANGLE) + lines("vt", [(0, 0), (1, 0), (0, 1)]) + "f 1/1 2/2 3/3\n"
    (folder / "blue.png").write_bytes(png((128, 128, 255, 255)))
    (folder / "grey.png").write_bytes(png((90, 90, 90, 255)))
    statements = {"norm blue.png": "normal", "map_bump blue.png": "normal", "disp grey.png": "height",
                  "map_bump grey.png": "height"}  # fmt: skip
    found = []
    for statement, kind in statements.items():
        material = only(obj(folder, content, statement + "\n")).material
        found.append((material.normal_texture if kind == "normal" else material.height) is not None)
    return drawn(all(found))


@case("metal, roughness, clear coat, ...", "glTF", "OBJ")
def metal(folder, name):
    if name == "glTF":
        file = GltfFile(folder)
        file.material(pbrMetallicRoughness={"metallicFactor": 1}, extensions={"KHR_materials_clearcoat": {}})
        path, names = file.glb(), ("KHR_materials_clearcoat", "metallicFactor")
    else:
        path, names = obj(folder, lines("v", TRIANGLE) + "f 1 2 3\n", "Pm 1\nPc 0.5\nPs 0\n"), ("Pm", "Pc")
    notices = load(path)[1]
    return "not used" if "not used" in notices and all(one in notices for one in names) else notices


@case("KTX2, DDS, AVIF textures", "glTF")
def other_textures(folder, name):
    for extension in ("KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"):
        file = GltfFile(folder)
        file.attribute("TEXCOORD_0", np.zeros((3, 2), np.float32))
        file.image(bufferView=file.view(b"no picture that is read"))
        file.header["textures"] = [{"extensions": {extension: {"source": 0}}}]
        file.header["extensionsRequired"] = [extension]
        if noticed(file.glb(), extension, "drawn without") != "left out":
            return "no notice"
    return "left out"


# --- scene


@case("perspective and orthographic camera", "glTF")
def cameras(folder, name):
    file = GltfFile(folder)
    file.header["cameras"] = [
        {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 3, "znear": 0.1, "zfar": 9}},
        {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
    ]
    file.header["nodes"] += [{"camera": 0}, {"camera": 1}]
    found = []
    for order in ([0, 1, 2], [0, 2, 1]):
        file.header["scenes"] = [{"nodes": order}]
        camera = load(file.glb())[0].camera
        found.append(camera.fov if camera.ortho is None else camera.ortho)
    return "the first" if found == pytest.approx([6, np.degrees(1)]) else str(found)


@case("clip planes of the camera", "glTF")
def clip_planes(folder, name):
    file = GltfFile(folder)
    file.header["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.25, "zfar": 9}}]
    file.header["nodes"].append({"camera": 0})
    file.header["scenes"] = [{"nodes": [0, 1]}]
    camera = load(file.glb())[0].camera
    return "kept" if (camera.near, camera.far) == (0.25, 9) else "lost"


@case("lights", "glTF")
def lights(folder, name):
    file = GltfFile(folder)
    kinds = [{"type": kind, "intensity": 2} for kind in ("directional", "point")] + [{"type": "spot", "spot": {}}]
    file.header["extensions"] = {"KHR_lights_punctual": {"lights": kinds}}
    file.header["nodes"] += [{"extensions": {"KHR_lights_punctual": {"light": index}}} for index in range(3)]
    file.header["scenes"] = [{"nodes": [0, 1, 2, 3]}]
    kinds = [type(light).__name__ for light in load(file.glb())[0].lights]
    return drawn(kinds == ["DirectionalLight", "PointLight", "SpotLight"])


@case("up axis", *FORMATS)
def up_axis(folder, name):
    path = made(folder, name, [(0, 0, 0), (1, 0, 0), (0, 0, 1)])
    up = load(path)[0].bounds[1].tolist() == [1, 1, 0]  # z has become y
    return "z" if up else "y"
