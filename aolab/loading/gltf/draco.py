"""Primitives that Draco compressed (KHR_draco_mesh_compression), by the extra `draco`."""

import numpy as np

from ...errors import SceneError
from ...extras import EXTRAS, install_command
from ...input import TooLarge
from ..parts import Notes
from .accessors import Accessors
from .schema import Draco, Gltf, Primitive

Arrays = tuple[dict[str, np.ndarray], np.ndarray]  # the attributes by name, and the indices


def decoded(gltf: Gltf, accessors: Accessors, primitive: Primitive, name: str, notes: Notes) -> Arrays | None:
    """The arrays; None, with a note, where they cannot be decoded, and the file has the plain arrays too.

    Raises `SceneError` where they cannot be decoded, and the file has nothing else.
    """
    draco = primitive.extensions.draco
    assert draco is not None
    try:
        return _decoded(gltf, accessors, primitive, draco, name)
    except SceneError as error:
        plain = [primitive.attributes.get("POSITION"), primitive.indices]
        plain = [gltf.accessors[index].buffer_view for index in plain if index is not None]
        if not plain or None in plain:
            raise
        notes.add("drawn from its plain arrays: ", str(error), separator="; ")
        return None


def _decoded(gltf: Gltf, accessors: Accessors, primitive: Primitive, draco: Draco, name: str) -> Arrays:
    try:
        import DracoPy
    except ImportError:
        package = EXTRAS["draco"].package
        raise SceneError(
            f"mesh '{name}' is compressed with Draco, and the decoder is missing: {install_command(package)}"
        ) from None
    try:
        mesh = DracoPy.decode(accessors.view(draco.buffer_view))
        found = {attribute: mesh.get_attribute_by_unique_id(number) for attribute, number in draco.attributes.items()}
    except TooLarge:
        raise
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
