"""Scenes: bounds, defaults for missing parts, and errors."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import DirectionalLight, Environment, Instance, Mesh, Notice, Scene, SceneError, Texture
from aolab.modules.base import auto_radius

BOX = small_scenes.box((0, 0, 0), (1, 2, 3))


def moved(x: float = 0, y: float = 0, z: float = 0, scale: float = 1) -> np.ndarray:
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = x, y, z
    return matrix


def test_bounds_and_triangles_cover_all_instances():
    scene = Scene((Instance(BOX), Instance(BOX, moved(x=10, scale=2))))
    np.testing.assert_allclose(scene.bounds, [[0, 0, 0], [12, 4, 6]])
    assert scene.triangles == 24
    assert scene.radius == pytest.approx(np.sqrt(12**2 + 4**2 + 6**2) / 2)
    triangles = scene.world_triangles()
    assert triangles.shape == (24, 3, 3)
    np.testing.assert_allclose(triangles[12:].reshape(-1, 3), triangles[:12].reshape(-1, 3) * 2 + (10, 0, 0), atol=1e-5)


def test_missing_camera_lights_and_environment_get_defaults():
    bare = Scene((Instance(BOX),))
    assert bare.camera is not None
    assert bare.environment is not None
    assert len(bare.lights) == 1
    lamp = Scene((Instance(BOX),), (DirectionalLight((0, -1, 0)),))
    assert lamp.lights == (DirectionalLight((0, -1, 0)),)
    assert lamp.environment is not None
    assert not lamp.environment.radiance.any()
    assert Scene((Instance(BOX),), environment=Environment.constant(1)).lights == ()


def test_replace_keeps_the_meshes():
    scene = small_scenes.boxes()
    other = scene.replace(lights=(DirectionalLight((0, -1, 0)),))
    assert other.instances is scene.instances
    assert scene.lights == ()


@pytest.mark.parametrize(
    ("matrix", "message"),
    [
        (np.diag([1.0, 0, 1, 1]), r"instance 'box': its transform is singular \(scales .*0\.0"),
        (np.zeros((4, 4)), r"instance 'box': its transform"),
        (np.full((4, 4), np.nan), r"instance 'box': its transform is not a finite 4×4 matrix"),
        (np.eye(3), r"instance 'box': its transform is not a finite 4×4 matrix"),
        (np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]), r"last row is .*, not affine"),
        (np.diag([1e200, 1e200, 1e200, 1.0]), r"reaches .*; the limit is"),
        (moved(x=1e16), r"reaches 1e\+16 units from the origin; the limit is 1e\+15"),
        (moved(scale=1e-14), r"scene 'scene' has radius .*: too small for its coordinates"),
        (moved(x=1e10), r"too small for its coordinates; scale it or move it to the origin"),
    ],
)
def test_placements_that_cannot_be_drawn_are_refused(matrix, message):
    with pytest.raises(SceneError, match=message):
        Scene((Instance(BOX, matrix),))


@pytest.mark.parametrize("instances", [5, [5], (Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),)])
def test_other_things_than_instances_are_refused(instances):
    with pytest.raises(SceneError, match="is not an Instance"):
        Scene(instances)


def test_other_things_than_meshes_and_arrays_are_refused():
    with pytest.raises(SceneError, match="mesh = 5 is not a Mesh"):
        Instance(5)  # type: ignore[arg-type]
    with pytest.raises(SceneError, match="5 is no array"):
        Texture(5)  # type: ignore[arg-type]


def test_an_empty_scene_is_refused_by_name():
    with pytest.raises(SceneError, match="scene 'nothing' is empty: it holds no mesh"):
        Scene((), name="nothing")


def test_a_few_vertices_far_out_do_not_decide_what_is_framed():
    dense = small_scenes.sphere(1.0, (0, 0, 0), subdivisions=3)
    sliver = Mesh(np.array([[0, 1, 0], [1e5, 2, 0], [0, 1.1, 0]]), [[0, 1, 2]])
    with pytest.warns(Notice, match=r"most of its vertices lie within .*× .* of its 1e\+05 × "):
        scene = Scene((Instance(dense), Instance(sliver)))
    assert np.linalg.norm(scene.camera.eye) < 10
    assert scene.bounds[1, 0] == 1e5  # they are still there


@pytest.mark.parametrize("away", [1e4, 1e6])
def test_one_vertex_of_a_box_far_out_does_not_decide_what_is_framed(away):
    """It is one of nine; and the radius of occlusion is that of the box."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)] + [(away, 0.5, 0.2)])
    faces = [(0, 1, 2), (1, 3, 2), (4, 6, 5), (5, 6, 7), (0, 4, 1), (1, 4, 5), (2, 3, 8)]
    with pytest.warns(Notice, match=r"most of its vertices lie within"):
        scene = Scene((Instance(Mesh(corners, faces)),))
    assert np.linalg.norm(scene.camera.eye) < 10
    assert auto_radius(scene) < 1


def test_a_model_on_a_wide_floor_is_framed_with_its_floor():
    scene = Scene((Instance(small_scenes.sphere(1.0, (0, 1, 0))), Instance(small_scenes.floor(15.0))))
    assert np.linalg.norm(scene.camera.eye) > 30


TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: aolab.PointLight(5), "PointLight: position = 5 is not three finite numbers"),
        (lambda: aolab.PointLight((0, 1)), r"position = \(0, 1\) is not three"),
        (lambda: aolab.PointLight((0, 1, 0), "red"), "intensity = 'red' is not three"),
        (lambda: aolab.PointLight((0, 1, float("nan"))), "position = .* is not three finite"),
        (lambda: aolab.DirectionalLight("x"), "direction = 'x' is not three"),
        (lambda: aolab.SpotLight((0, 1, 0), 5), "direction = 5 is not three"),
        (lambda: aolab.SpotLight((0, 1, 0), (0, -1, 0), inner="x"), "inner = x, outer = 30.0 are not"),
        (lambda: aolab.Material("red"), "base_color = red is not three numbers"),
        (lambda: aolab.Material(alpha="x"), "alpha = 'x' is not a number"),
        (lambda: aolab.Mesh("a", "b"), "vertices = 'a' are not numbers"),
        (lambda: aolab.Mesh(*TRIANGLE, material=5), "material = 5 is not a Material"),
        (lambda: aolab.Camera((0, 0, 1), "x"), "target = x is not three"),
        (lambda: aolab.Camera((0, 0, 1), (0, 0, 0), fov="x"), "fov = 'x' is not a number"),
        (lambda: aolab.Camera((0, 0, 1), (0, 0, 0), ortho=(1, 2)), r"ortho = \(1, 2\) is not a number"),
        (lambda: aolab.load("boxes").replace(camera=5), "camera = 5 is not a Camera"),
    ],
)
def test_wrong_types_are_named(make, words):
    with pytest.raises(SceneError, match=words):
        make()
