"""The renderer of another project, as the race of `aolab.studies.peers` uses it."""

from typing import Protocol

import numpy as np

from ...gl.texture import Size
from ...scene.camera import Camera
from ...scene.scene import Scene


class Peer(Protocol):
    """A renderer with ambient occlusion on the screen. Everything it draws is white and lit evenly.

    `name` has its version; `settings`: its parameters that trade time for error, by name.
    """

    name: str
    settings: dict[str, object]

    def draw(self, occlusion: bool) -> object:
        """Draw a frame, with or without ambient occlusion, and wait for its end."""

    def visibility(self) -> np.ndarray:
        """(H, W) float: 1 is open."""
        ...


class PeerClass(Protocol):
    """Makes a `Peer` for a scene, at a size in pixels; `radius` in scene units."""

    def __call__(self, scene: Scene, camera: Camera, size: Size, radius: float) -> Peer: ...


def geometry(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """The whole scene as one mesh: world-space vertices (n, 3) float64 and triangles (m, 3) int64."""
    vertices, faces, first = [], [], 0
    for instance in scene.instances:
        vertices.append(instance.placed(instance.mesh.vertices))
        faces.append(instance.mesh.faces.astype(np.int64) + first)
        first += len(vertices[-1])
    return np.concatenate(vertices), np.concatenate(faces)
