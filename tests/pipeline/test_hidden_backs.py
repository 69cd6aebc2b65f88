"""Backs of solids are not drawn where nobody sees them; the surfaces are the same."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, Instance, Material, Mesh, Notice, Scene
from aolab.pipeline import geometry
from aolab.scene.clipping import unclipped, with_hidden_backs
from aolab.scene.view import View

SIZE = (48, 36)
OUTSIDE = Camera(eye=(1.5, 2, 4), target=(0, 0.5, 0), fov=50)
BOX = small_scenes.box((-1, 0, -1), (1, 1, 1), Material((0.8, 0.2, 0.2)))


def mirrored() -> np.ndarray:
    """A mirror at x = 0, and a step aside."""
    matrix = np.diag([-1.0, 1.0, 1.0, 1.0])
    matrix[:3, 3] = 1.7, 0.4, -0.9
    return matrix


def hidden(scene: Scene, camera: Camera) -> list[str]:
    view = View(unclipped(camera, scene, SIZE), SIZE, scene.bounds)
    return [mesh.name for mesh in with_hidden_backs(scene, view)]


def surfaces(lab, scene: Scene, camera: Camera = OUTSIDE) -> aolab.Frame:
    return lab.render(scene, "none", camera=camera, size=SIZE)


@pytest.fixture
def all_backs(monkeypatch):
    """Draws all backs, as if no mesh were a solid."""
    return lambda: monkeypatch.setattr(geometry, "with_hidden_backs", lambda scene, view: [])


@pytest.mark.parametrize(
    "camera",
    [
        OUTSIDE,
        Camera(eye=(0, 0.5, 0), target=(1, 0.4, 0.3), fov=80),  # inside the box
        Camera(eye=(0, 1.001, 0), target=(0.6, 0.6, 0), fov=80),  # just above it
        Camera(eye=(1.5, 2, 4), target=(0, 0.5, 0), near=3.8),  # its near plane cuts the box
        Camera(eye=(1.5, 2, 4), target=(0, 0.5, 0), ortho=4),
        Camera(eye=(0, 0.5, 0.5), target=(0, 0.5, 0), ortho=1.5),  # an eye within: all before it is cut away
    ],
)
@pytest.mark.parametrize("transform", [np.eye(4), mirrored()])
@pytest.mark.filterwarnings("ignore:the camera's near plane")
def test_the_surfaces_are_the_same_without_backs(lab, camera, transform, all_backs):
    ball = small_scenes.sphere(0.6, (0.3, 1.4, 0.4), subdivisions=2)
    scene = Scene((Instance(BOX), Instance(BOX, transform), Instance(ball), Instance(small_scenes.floor(4))))
    fronts = surfaces(lab, scene, camera)
    all_backs()
    both = surfaces(aolab.Lab(SIZE), scene, camera)
    for name in ("viewZ", "viewNormal", "albedo"):
        np.testing.assert_array_equal(fronts[name], both[name])
    assert both.mask.any()


@pytest.mark.parametrize("transform", [np.eye(4), np.diag([-1.0, 1.0, 1.0, 1.0])])
def test_of_a_mesh_that_is_taken_for_a_solid_only_fronts_are_drawn(lab, monkeypatch, transform):
    """So the surfaces above are not equal because nothing is left out. A mirrored instance keeps its fronts."""
    square = Mesh(*_square())
    monkeypatch.setattr(geometry, "with_hidden_backs", lambda scene, view: [square])
    scene = Scene((Instance(square, transform),))
    assert surfaces(lab, scene, Camera(eye=(0, 0, 4), target=(0, 0, 0))).mask.any()
    with pytest.warns(Notice, match="nothing is drawn"):
        assert not surfaces(lab, scene, Camera(eye=(0, 0, -4), target=(0, 0, 0))).mask.any()


def _square() -> tuple[np.ndarray, np.ndarray]:
    """Faces +z."""
    return np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float), np.array([(0, 1, 2), (0, 2, 3)])


def test_backs_of_solids_are_hidden_from_outside():
    scene = Scene((Instance(BOX), Instance(BOX, mirrored()), Instance(small_scenes.floor(4))))
    assert hidden(scene, OUTSIDE) == ["box"]  # the floor is open


@pytest.mark.parametrize(
    "camera",
    [
        Camera(eye=(0, 0.5, 0), target=(1, 0.4, 0.3)),
        Camera(eye=(1.5, 2, 4), target=(0, 0.5, 0), near=3.8),
        Camera(eye=(0, 0.5, 0.5), target=(0, 0.5, 0), ortho=1.5),
    ],
)
def test_backs_are_seen_from_inside_and_through_a_near_plane(camera):
    assert hidden(Scene((Instance(BOX),)), camera) == []


@pytest.mark.parametrize("holes", [{"blend": True, "alpha": 0.5}, {"alpha_cutoff": 0.5}])
def test_backs_are_seen_through_holes(holes):
    glass = small_scenes.box((-1, 0, -1), (1, 1, 1), Material(**holes))
    assert hidden(Scene((Instance(glass),)), OUTSIDE) == []
