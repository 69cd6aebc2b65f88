"""Screen-space bent normals and cones: the mean open direction, and the width of the open cone around it."""

from typing import ClassVar, Literal

import numpy as np

from ..scene.cones import SLICES, TEXELS, Cones
from .buffers import Buffer
from .marched import Marched
from .parameters import parameter
from .passes import Pass, term
from .readable import Readable


def _is_uniform(frame: Readable) -> bool:
    return frame.info["parameters"]["weighting"] == "uniform"


def _bent_normal(frame: Readable, raw: str) -> np.ndarray:
    """The mean open direction, world space; 0 if no direction is open, and in the background."""
    name = f"blocked_direction{raw}"
    blocked = frame[name]
    open = 1 - blocked[..., 3:]
    whole = np.float32(1 / 2 if _is_uniform(frame) else 2 / 3)
    bent = whole * frame.world_normal(name) - blocked[..., :3]
    mean = bent / np.maximum(open, np.float32(1e-4))
    mean /= np.maximum(np.linalg.norm(mean, axis=-1, keepdims=True), 1)  # with few samples it may be longer than 1
    return np.where(open > 1e-4, mean, np.float32(0))


def _visibility(frame: Readable, raw: str) -> np.ndarray:
    """(1/π) ∫ V cosθ dω; for uniform directions, from the component of the mean direction along the normal."""
    name = f"blocked_direction{raw}"
    blocked = frame[name]
    if _is_uniform(frame):
        return np.clip(1 - 2 * (blocked[..., :3] * frame.world_normal(name)).sum(axis=-1), 0, 1)
    return np.clip(1 - blocked[..., 3], 0, 1)


class SSBN(Marched):
    """A cone around the mean open direction represents all open directions; its light is the environment's mean.

    The environment is averaged over cones of eight sizes in advance. The estimate does not depend on the light, but a
    new environment needs new averages. Equal bent normals give equal light: with the paper's `uniform` weighting, both
    sides of a corner have nearly the same colour.
    """

    name = "ssbn"
    claims = "ambient"
    title = "Screen-space bent normals and cones"
    paper = "Klehm, Ritschel, Eisemann and Seidel 2011, Bent Normals and Cones in Screen-space"
    shader = "ssbn.frag"
    outputs: ClassVar = {"blocked_direction": "RGBA16F"}
    derived: ClassVar = {"bent_normal": _bent_normal, "visibility": _visibility}
    buffers: ClassVar = (
        Buffer(
            "blocked_direction", 4, "RGBA16F", "", 0, "numbers",
            "The sum of the blocked directions, world space (rgb), and the blocked share (a), by their weights.",
        ),
    )  # fmt: skip

    weighting: Literal["cosine", "uniform"] = parameter(
        "cosine", "Weights of directions in the bent normal: their cosine, or uniform as in the paper."
    )

    def passes(self) -> list[Pass]:
        return [Pass("ssbn", self.shader, self.outputs, self._weights, background=self._background(SSBN, 0.0))]

    @property
    def _weights(self) -> dict[str, bool | int]:
        return {"uniform_weights": self.weighting == "uniform"}

    def tables(self) -> dict[str, Cones]:
        return {"cone_environment": Cones()}

    def openness(self) -> str:
        """As in `_visibility`."""
        share = "2.0 * dot(blocked.xyz, normal)" if self.weighting == "uniform" else "blocked.a"
        return f"""
        uniform sampler2D blocked_direction;
        uniform sampler2D viewNormal;
        uniform mat4 world_from_view;
        float opennessAt(ivec2 pixel) {{
            vec4 blocked = texelFetch(blocked_direction, pixel, 0);
            vec3 normal = mat3(world_from_view) * texelFetch(viewNormal, pixel, 0).xyz;
            return clamp(1.0 - {share}, 0.0, 1.0);
        }}
        """

    def lighting(self) -> list[Pass]:
        constants = {"cone_slices": SLICES, "cone_texels": TEXELS, **self._weights}
        return [*self.direct(), term("ambient", "ssbn.ambient.glsl", constants)]
