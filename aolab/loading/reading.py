"""trimesh's readers, with nothing merged, nothing fetched and no warnings of their own."""

import warnings
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import trimesh


def read_trimesh(file: object, file_type: str, resolver: object) -> "trimesh.Scene":
    """What trimesh makes of an open file, unchanged: nothing merged, no network."""
    import trimesh

    with warnings.catch_warnings():
        # images are checked and decoded by `read_image`, which refuses bombs; NaN are refused by `Mesh`
        warnings.simplefilter("ignore")
        # NumPy's word for an OBJ with text where numbers belong, after which the rest would be lost
        warnings.filterwarnings("error", "string or file could not be read", DeprecationWarning)
        return trimesh.load_scene(file, file_type=file_type, resolver=resolver, process=False)  # type: ignore[arg-type]
