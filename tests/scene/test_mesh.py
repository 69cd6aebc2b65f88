"""Meshes: the errors, the repairs, and the generated normals."""

import numpy as np
import pytest
import small_scenes

from aolab.errors import Notice, SceneError
from aolab.scene.mesh import Material, Mesh, Texture

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
TWO = np.array([[0, 1, 2], [0, 2, 3]])


def test_arrays_are_float32_uint32_and_cannot_be_written():
    mesh = Mesh(SQUARE.tolist(), TWO.tolist(), uv=SQUARE[:, :2], colors=np.ones((4, 4)))
    for array, kind in [(mesh.vertices, np.float32), (mesh.normals, np.float32), (mesh.faces, np.uint32)]:
        assert array.dtype == kind
        assert array.flags.c_contiguous
    for array in (mesh.vertices, mesh.normals, mesh.faces, mesh.uv, mesh.colors):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_the_callers_arrays_stay_writeable():
    vertices, normals = SQUARE.copy(), np.tile(np.float32([0, 0, 1]), (4, 1))
    Mesh(vertices, TWO, normals=normals)
    vertices[0] = normals[0] = 5


def test_normals_are_generated_and_attributes_follow_the_split():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    mesh = Mesh(vertices, faces, uv=vertices[:, :2], colors=np.c_[vertices, np.ones(4)])
    assert len(mesh.vertices) == 12
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], vertices[faces])
    np.testing.assert_array_equal(mesh.uv, mesh.vertices[:, :2])
    np.testing.assert_array_equal(mesh.colors[:, :3], mesh.vertices)
    np.testing.assert_allclose(mesh.normals[mesh.faces[0]], [[0, 0, -1]] * 3)


def test_given_normals_are_kept_and_nothing_is_split():
    normals = np.tile([0.6, 0, 0.8], (4, 1))
    mesh = Mesh(SQUARE, TWO, normals=normals)
    np.testing.assert_allclose(mesh.normals, normals, atol=1e-7)
    assert len(mesh.vertices) == 4


def test_a_normal_of_no_length_is_made_from_its_faces():
    normals = np.array([[0, 0.6, 0.8], [0, 0.6, 0.8], [0, 0.6, 0.8], [0, 0, 0]], float)
    with pytest.warns(Notice, match="mesh 'mesh': 1 of 4 normals have no length; made from the faces"):
        mesh = Mesh(SQUARE, TWO, normals=normals)
    np.testing.assert_allclose(mesh.normals, [*normals[:3], (0, 0, 1)], atol=1e-7)


def test_normals_without_length_are_all_made():
    with pytest.warns(Notice, match="its 4 normals have no length"):
        mesh = Mesh(SQUARE, TWO, normals=np.zeros((4, 3)))
    np.testing.assert_allclose(mesh.normals, [[0, 0, 1]] * 4)


@pytest.mark.parametrize("length", [1e-25, 1e-20, 1e-3, 1e20])
def test_normals_get_unit_length(length):
    """The square of the shortest of these is 0 in float32, that of the longest is infinite."""
    mesh = Mesh(SQUARE, TWO, normals=np.tile([0.6 * length, 0, 0.8 * length], (4, 1)))
    np.testing.assert_allclose(mesh.normals, [[0.6, 0, 0.8]] * 4, rtol=1e-6)


def test_normals_in_the_plane_of_their_triangle_are_replaced_and_the_rest_kept():
    """The second triangle's normals are fine; the vertices that both share are split, with their uv."""
    normals = np.array([[1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0.6, 0.8]])
    bent = SQUARE + np.float32([(0, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0.5)])
    with pytest.warns(Notice, match="the normals of 1 of 2 triangles lie in the triangle's plane"):
        mesh = Mesh(bent, TWO, normals=normals, uv=SQUARE[:, :2])
    np.testing.assert_allclose(mesh.normals[mesh.faces[0]], [[0, 0, 1]] * 3)
    np.testing.assert_allclose(mesh.normals[mesh.faces[1]], normals[TWO[1]], atol=1e-7)
    np.testing.assert_array_equal(mesh.uv, mesh.vertices[:, :2])
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], bent[TWO])


def test_vertices_that_float32_cannot_hold_are_told():
    far = SQUARE.astype(np.float64) + np.array((500_000, 0, 4_000_000))
    with pytest.warns(Notice, match=r"mesh 'house': float32 moves its vertices by up to .* subtract their centre"):
        Mesh(far + 0.1, TWO, name="house")
    Mesh(far.astype(np.float32), TWO)  # given as such: nothing is moved here


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [(np.zeros((0, 3)), np.zeros((0, 3), int)), (SQUARE, np.zeros((0, 3), int)), (np.zeros((0, 3)), TWO)],
)
def test_empty(vertices, faces):
    with pytest.raises(SceneError, match="mesh 'thing' is empty"):
        Mesh(vertices, faces, name="thing")


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("key", ["vertices", "normals", "uv", "colors"])
def test_numbers_that_are_not_finite_are_named(key, value):
    given = {"vertices": SQUARE, "normals": np.ones((4, 3)), "uv": np.zeros((4, 2)), "colors": np.ones((4, 4))}
    given[key] = given[key].copy()
    given[key][2, 1] = value
    what = "vertex" if key == "vertices" else f"{key} of vertex"
    with pytest.raises(SceneError, match=f"mesh 'thing': {what} 2 is .*{abs(value)}.*1 of 4 are not finite"):
        Mesh(faces=TWO, name="thing", **given)


def test_numbers_beyond_float32_are_not_finite():
    with pytest.raises(SceneError, match="vertex 1 is"):
        Mesh(SQUARE.astype(float) * 1e39, TWO)


@pytest.mark.parametrize("index", [4, -1])
def test_index_out_of_range(index):
    with pytest.raises(SceneError, match=rf"triangle 1 has indices \[0, 2, {index}\], but there are 4 vertices"):
        Mesh(SQUARE, [[0, 1, 2], [0, 2, index]])


@pytest.mark.parametrize(
    ("more", "match"),
    [
        ({"vertices": SQUARE[:, :2]}, r"vertices have shape \(4, 2\), not \(n, 3\)"),
        ({"faces": np.array([[0, 1, 2, 3]])}, r"faces have shape \(1, 4\)"),
        ({"uv": np.zeros((3, 2))}, "3 uv for 4 vertices"),
        ({"colors": np.zeros((4, 3))}, r"colors have shape \(4, 3\), not \(n, 4\)"),
        ({"normals": np.ones((5, 3))}, "5 normals for 4 vertices"),
    ],
)
def test_shapes(more, match):
    with pytest.raises(SceneError, match=match):
        Mesh(**{"vertices": SQUARE, "faces": TWO, **more})


def test_degenerate_triangles_are_dropped_and_counted():
    faces = [[0, 1, 1], *TWO.tolist(), [3, 3, 3]]
    with pytest.warns(Notice, match="mesh 'thing': dropped 2 of 4 triangles, degenerate"):
        mesh = Mesh(SQUARE, faces, name="thing")
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], SQUARE[TWO])


def test_a_mesh_of_degenerate_triangles_alone_is_empty():
    with pytest.raises(SceneError, match="all of its 1 triangles are degenerate"):
        Mesh(np.array([[0, 0, 0], [1, 1, 1], [2, 2, 2]]), [[0, 1, 2]])


@pytest.mark.parametrize("scale", [1e-15, 1e15])
def test_a_small_or_large_triangle_is_not_degenerate(scale):
    assert len(Mesh(SQUARE * np.float32(scale), TWO).faces) == 2


@pytest.mark.parametrize("color", [(1, 1), (1, 1, 1.01), (-0.1, 0, 0), (np.nan, 0, 0)])
def test_material_colours(color):
    with pytest.raises(SceneError, match="material 'paint': base_color"):
        Material(base_color=color, name="paint")


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"emission": (1, -1, 0)}, r"emission = \(1, -1, 0\) is not three finite numbers from 0"),
        ({"emission": (1, np.inf, 0)}, "emission = .* is not"),
        ({"alpha": 1.5}, r"alpha = 1\.5 is outside \[0, 1\]"),
    ],
)
def test_material_values(values, message):
    with pytest.raises(SceneError, match=f"material 'lamp': {message}"):
        Material(name="lamp", **values)


def test_texture_wrap():
    with pytest.raises(SceneError, match=r"texture 'bark': wrap = .* is not two of repeat, mirror, clamp"):
        Texture(np.zeros((2, 2, 4), np.uint8), "bark", wrap=("repeat", "border"))


@pytest.mark.parametrize("pixels", [np.zeros((2, 2, 3), np.uint8), np.zeros((2, 2, 4)), np.zeros((0, 2, 4), np.uint8)])
def test_texture_pixels(pixels):
    with pytest.raises(SceneError, match="texture 'bark': pixels are"):
        Texture(pixels, "bark")


def test_a_texture_without_uv_is_left_out_with_a_notice():
    texture = Texture(np.full((2, 2, 4), 255, np.uint8), "checks")
    with pytest.warns(Notice, match="a texture but no uv"):
        mesh = Mesh(np.eye(3), [[0, 1, 2]], material=Material((0.2, 0.4, 0.6), texture))
    assert mesh.material.texture is None
    assert mesh.material.base_color == (0.2, 0.4, 0.6)


BOX = small_scenes.box((0, 0, 0), (1, 1, 1))


def _joined(*meshes: Mesh) -> Mesh:
    """One mesh of the triangles of several."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces.astype(int) + start for mesh, start in zip(meshes, starts[:-1], strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def _flipped(mesh: Mesh) -> Mesh:
    return Mesh(mesh.vertices, mesh.faces[:, ::-1])


APART = small_scenes.box((3, 0, 0), (4, 1, 1))


@pytest.mark.parametrize(
    ("mesh", "solid"),
    [
        (BOX, True),
        (small_scenes.sphere(1.0, (9, 9, 9), subdivisions=1), True),
        (_joined(BOX, APART), True),
        (_flipped(BOX), False),
        (_joined(BOX, _flipped(small_scenes.box((3, 0, 0), (3.5, 0.5, 0.5)))), False),  # the smaller part inside out
        (Mesh(BOX.vertices, BOX.faces[1:]), False),
        (
            Mesh(BOX.vertices, np.concatenate([BOX.faces[:1, ::-1], BOX.faces[1:]])),
            False,
        ),  # closed, one triangle turned
        (Mesh(SQUARE, TWO), False),
    ],
)
def test_a_solid_is_closed_and_has_its_fronts_outside(mesh, solid):
    assert mesh.is_solid is solid


def test_a_turned_triangle_leaves_a_mesh_closed():
    assert Mesh(BOX.vertices, np.concatenate([BOX.faces[:1, ::-1], BOX.faces[1:]])).is_closed
    assert not Mesh(BOX.vertices, BOX.faces[1:]).is_closed
