"""Normal maps of glTF, and the bump, displacement and normal maps of OBJ."""

from pathlib import Path

import numpy as np
import pytest
from gltf_file import GltfFile, png
from PIL import Image

import aolab
from aolab import Material, Notice

UV = np.array([(0, 0), (1, 0), (0, 1)], np.float32)
NORMALS = np.array([(0, 0, 1)] * 3, np.float32)


@pytest.fixture
def gltf(tmp_path: Path) -> GltfFile:
    """A triangle with a normal map that leans to +x."""
    made = GltfFile(tmp_path)
    made.attribute("TEXCOORD_0", UV)
    made.attribute("NORMAL", NORMALS)
    made.image(uri="bumps.png")
    (tmp_path / "bumps.png").write_bytes(png((204, 128, 230, 255)))
    made.material(normalTexture={"index": 0, "scale": 0.5})
    return made


def loaded(path: Path) -> aolab.Mesh:
    return aolab.load(path).instances[0].mesh


def test_a_normal_texture_and_its_scale_are_read(gltf):
    mesh = loaded(gltf.glb())
    assert mesh.material.normal_texture is not None
    assert mesh.material.normal_texture.pixels[0, 0, :3].tolist() == [204, 128, 230]
    assert mesh.material.normal_scale == 0.5
    assert mesh.tangents is not None
    # v of glTF grows downwards, and green is up: with u along x and v along y, the bitangent is along -y
    np.testing.assert_allclose(mesh.tangents, [(1, 0, 0, -1)] * 3, atol=1e-6)


def test_given_tangents_are_kept(gltf):
    given = np.array([(0, 1, 0, 1)] * 3, np.float32)
    gltf.attribute("TANGENT", given)
    np.testing.assert_array_equal(loaded(gltf.glb()).tangents, given)


def test_tangents_without_a_normal_map_are_left_out(gltf):
    gltf.attribute("TANGENT", np.array([(0, 1, 0, 1)] * 3, np.float32))
    gltf.material()
    assert loaded(gltf.glb()).tangents is None


def test_a_normal_texture_with_other_uv_than_the_color_is_left_out(gltf):
    gltf.material(pbrMetallicRoughness={"baseColorTexture": {"index": 0}}, normalTexture={"index": 0, "texCoord": 1})
    with pytest.warns(Notice, match="material 'paint': its normal texture was left out, as its UV are not those"):
        assert loaded(gltf.glb()).material.normal_texture is None


def test_a_normal_texture_without_uv_is_named(gltf):
    del gltf.header["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]
    with pytest.warns(Notice, match="a normal map or a height map but no uv; drawn without"):
        assert not loaded(gltf.glb()).material.bends_normals


# --- OBJ


def painted(folder: Path, mtl: str, values: object = ((0, 255), (51, 102))) -> Material:
    """The material of a square with these statements; gray.png and blue.png stand beside it."""
    Image.fromarray(np.array(values, np.uint8)).save(folder / "gray.png")
    (folder / "blue.png").write_bytes(png((128, 128, 255, 255)))
    (folder / "m.mtl").write_text("newmtl m\n" + mtl)
    text = "mtllib m.mtl\nusemtl m\n"
    text += "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
    (folder / "m.obj").write_text(text)
    return loaded(folder / "m.obj").material


@pytest.mark.parametrize("keyword", ["map_bump", "map_Bump", "bump", "disp"])
@pytest.mark.parametrize(
    ("options", "expected"),
    [("", ((0, 1), (0.2, 0.4))), ("-bm 0.5 ", ((0, 0.5), (0.1, 0.2))), ("-mm -0.1 0.5 ", ((-0.1, 0.4), (0.0, 0.1)))],
)
def test_a_gray_bump_map_is_a_height_map(tmp_path, keyword, options, expected):
    height = painted(tmp_path, f"{keyword} {options}gray.png\n").height
    assert height is not None
    assert height.name == "gray.png"
    np.testing.assert_allclose(height.heights, expected, atol=1e-6)


def test_a_clamped_bump_map_is_clamped(tmp_path):
    height = painted(tmp_path, "map_bump -clamp on gray.png\n").height
    assert height is not None
    assert height.wrap == ("clamp", "clamp")


@pytest.mark.parametrize("statement", ["norm blue.png", "map_Bump -bm 0.5 blue.png"])
def test_a_blue_bump_map_holds_normals(tmp_path, statement):
    material = painted(tmp_path, statement + "\n")
    assert material.height is None
    assert material.normal_texture is not None
    assert material.normal_scale == (0.5 if "-bm" in statement else 1.0)


def test_a_bump_map_with_another_transform_is_left_out(tmp_path):
    with pytest.warns(Notice, match="map_bump of material 'm' was left out, as its UV are not those of the colour's"):
        material = painted(tmp_path, "map_Kd gray.png\nmap_bump -s 2 2 1 gray.png\n")
    assert not material.bends_normals


def test_a_missing_bump_map_is_named(tmp_path):
    with pytest.warns(Notice, match="its texture 'none.png' is missing; drawn without"):
        assert not painted(tmp_path, "map_bump none.png\n").bends_normals


def test_a_bump_map_alone_gives_the_coordinates_their_transform(tmp_path):
    painted(tmp_path, "map_bump -s 2 3 1 gray.png\n")
    mesh = loaded(tmp_path / "m.obj")
    assert mesh.uv is not None
    np.testing.assert_allclose(mesh.uv.max(axis=0), (2, 3))
