"""A notice about meshes without an inside, where solids between depth layers are asked for."""

import weakref

from ...errors import notice
from ...scene.mesh import Mesh
from ...scene.scene import Scene

_named: "weakref.WeakSet[Mesh]" = weakref.WeakSet()


def name_open_meshes(scene: Scene) -> None:
    """Issue a `Notice` that names the scene's open meshes, once for each mesh."""
    meshes = {instance.mesh for instance in scene.instances}
    fresh = [mesh for mesh in meshes if mesh not in _named and not mesh.is_closed]
    _named.update(fresh)
    if fresh:
        names = ", ".join(sorted({mesh.name for mesh in fresh})[:5])
        notice(
            f"{len(fresh)} of {len(meshes)} meshes are not closed ({names}): between two layers need be no solid. "
            "Where the last layer has no back, `thickness` closes it"
        )
