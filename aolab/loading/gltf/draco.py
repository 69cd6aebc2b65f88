"""Primitives that Draco compressed (KHR_draco_mesh_compression), by the extra `draco`."""

import numpy as np

from ...errors import SceneError
from .accessors import Accessors
from .schema import Gltf, Primitive


def decoded(
    gltf: Gltf, accessors: Accessors, primitive: Primitive, name: str
) -> tuple[dict[str, np.ndarray], np.ndarray] | None:
    """The attributes by name, and the indices; None where DracoPy is missing and the file has the plain arrays too.

    Raises `SceneError` for data that cannot be decoded, and where DracoPy is missing and the file has nothing else.
    """
    draco = primitive.extensions.draco
    assert draco is not None
    try:
        import DracoPy
    except ImportError:
        position = primitive.attributes.get("POSITION")
        if position is not None and gltf.accessors[position].buffer_view is not None:
            return None
        raise SceneError(f"mesh '{name}' is compressed with Draco; pip install 'aolab[draco]' reads it") from None
    try:
        mesh = DracoPy.decode(accessors.view(draco.buffer_view))
        found = {attribute: mesh.get_attribute_by_unique_id(number) for attribute, number in draco.attributes.items()}
    except Exception as error:  # the library's own exceptions, and those of its wrapper
        raise SceneError(f"mesh '{name}': bufferViews[{draco.buffer_view}] is no readable Draco mesh") from error
    attributes = {}
    for attribute, one in found.items():
        if one is None:
            raise SceneError(f"mesh '{name}': its Draco mesh lacks {attribute}")
        values = np.asarray(one["data"])
        index = primitive.attributes.get(attribute)
        if index is not None and gltf.accessors[index].normalized and values.dtype.kind in "iu":
            values = np.maximum(values.astype(np.float32) / np.iinfo(values.dtype).max, -1)
        attributes[attribute] = values if attribute.startswith("JOINTS") else values.astype(np.float32)
    return attributes, np.asarray(mesh.faces).reshape(-1)
