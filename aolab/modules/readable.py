"""The part of a frame that a module reads to derive further buffers."""

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from ..scene.camera import Camera


class Readable(Protocol):
    """Buffers by name; `pipeline.frame.Frame` is one."""

    info: dict[str, Any]

    @property
    def camera(self) -> Camera: ...

    def __getitem__(self, name: str) -> np.ndarray:
        """(H, W) or (H, W, channels) float32, top row first, without padding."""
        ...

    def channels(self, name: str) -> np.ndarray:
        """The same with every channel of the texture."""
        ...

    def once(self, name: str, make: Callable[[], np.ndarray]) -> np.ndarray:
        """The result of `make`, computed at the first call with this name."""
        ...

    def world_normal(self, like: str = "viewNormal") -> np.ndarray:
        """(H, W, 3): unit normals in world space at the size of the buffer `like`; 0 in the background."""
        ...
