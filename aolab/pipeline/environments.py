"""Environments, and the tables that modules make of them, as textures."""

import weakref
from collections.abc import Mapping

import moderngl
import numpy as np

from ..gl import context
from ..gl.texture import make, refuse_exhaustion
from ..scene.environment import HALF_MAX, Environment
from ..scene.prefiltered import Table
from .pass_runner import Buffers


class EnvironmentMaps:
    """Textures of environments, kept for as long as the environment lives."""

    def __init__(self) -> None:
        self._textures: weakref.WeakKeyDictionary[Environment, moderngl.Texture] = weakref.WeakKeyDictionary()
        self._tables: weakref.WeakKeyDictionary[Environment, dict[str, tuple[Table, moderngl.Texture]]] = (
            weakref.WeakKeyDictionary()
        )

    def of(self, environment: Environment) -> moderngl.Texture:
        """RGB, half float, first row up (+y): as glsl/lib/environment.glsl reads it."""
        if environment not in self._textures:
            height, width = environment.radiance.shape[:2]
            data = np.ascontiguousarray(np.minimum(environment.radiance, HALF_MAX), np.float16).tobytes()
            texture = context.get().texture((width, height), 3, data, dtype="f2", alignment=2)
            refuse_exhaustion(f"environment '{environment.name}' of {width}x{height}")
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x, texture.repeat_y = True, False
            self._textures[environment] = texture
        return self._textures[environment]

    def tables(self, environment: Environment, wanted: Mapping[str, Table]) -> Buffers:
        """The tables that a module makes of the environment, RGBA float; the last of each name is kept."""
        known = self._tables.setdefault(environment, {})
        for name, table in wanted.items():
            if name not in known or known[name][0] != table:
                pixels = table(environment)
                padded = np.concatenate([pixels, np.ones_like(pixels[..., :1])], axis=-1)
                texture = make(pixels.shape[1::-1], "RGBA32F", padded.tobytes())
                if table.smooth:
                    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
                known[name] = table, texture
        return {name: known[name][1] for name in wanted}
