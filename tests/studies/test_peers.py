"""The race against other renderers: processes of their own, the same truth, and refusals."""

import os

import numpy as np
import pytest

import aolab
from aolab.errors import Notice, ParameterError
from aolab.studies import peers
from aolab.studies.peers.peer import geometry
from aolab.studies.peers.process import PeerProcess

SIZE = (48, 32)


class Open:
    """A renderer to which everything is open."""

    def __init__(self, scene, camera, size, radius):
        self.name, self.settings = f"open {radius:g}", {}
        self._size = size

    def draw(self, occlusion):
        print("a line of a library")

    def visibility(self):
        return np.ones(self._size[::-1])


class Refusing(Open):
    def visibility(self):
        raise OSError("no display of mine")


class Dying(Open):
    def visibility(self):
        os._exit(7)


def test_the_mesh_is_the_scene():
    scene = aolab.load("boxes")
    vertices, faces = geometry(scene)
    np.testing.assert_array_equal(vertices[faces], scene.world_triangles())


@pytest.mark.slow
def test_a_peer_that_cannot_draw_is_refused_with_its_reason(boxes):
    for kind, reason in ((Refusing, "no display of mine"), (Dying, "exit code 7")):
        with pytest.raises(ParameterError, match=reason):
            PeerProcess(kind, boxes, boxes.camera, SIZE, 0.5)


@pytest.mark.slow
def test_a_race_has_errors_against_the_same_truth(gl, boxes, monkeypatch):
    monkeypatch.setattr(peers, "PEERS", {"open": Open, "refusing": Refusing})
    with pytest.warns(Notice, match="refusing is left out: OSError: no display of mine"):
        found = peers.race(boxes, radius=0.5, size=SIZE, rays=64, frames=3)
    first, *ours = found.curve.points
    assert first.label == "open 0.5"
    truth = aolab.reference(boxes, size=SIZE, rays=64, like=aolab.SSAO(radius=0.5, falloff=0.0))
    occluded = 1 - truth["visibility"][truth.mask]
    assert first.bias == pytest.approx(occluded.mean())
    assert first.rmse == pytest.approx(np.sqrt((occluded**2).mean()))
    assert [point.module for point in ours] == ["ssao", "ssao", "ssao", "s3ho"]
    assert all(point.rmse < first.rmse for point in ours)
    assert set(found.frames) == {point.label for point in found.curve.points}
    assert first.label in found.table()
    assert found.to_dict()["frames"][first.label]["median"] >= 0


def test_without_another_renderer_the_race_is_refused(gl, boxes, monkeypatch):
    monkeypatch.setattr(peers, "PEERS", {})
    with pytest.raises(ParameterError, match="no other renderer to race"):
        peers.race(boxes, size=SIZE)


@pytest.mark.slow
def test_vtk_draws_the_occlusion_of_the_scene(boxes):
    """Where PyVista is installed: VTK sees the same surfaces, darkest at the boxes' feet as in the truth."""
    pytest.importorskip("pyvista")
    peer = PeerProcess(peers.PEERS["pyvista"], boxes, boxes.camera, (192, 128), 0.5)
    truth = aolab.reference(boxes, size=(192, 128), rays=64, like=aolab.SSAO(radius=0.5, falloff=0.0))
    assert np.corrcoef(peer.visibility[truth.mask], truth["visibility"][truth.mask])[0, 1] > 0.5
    assert peer.milliseconds(True) > 0
    peer.close()
