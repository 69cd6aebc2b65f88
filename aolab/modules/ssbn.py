"""Screen-space bent normals and cones: the mean open direction, and how widely it is open."""

from typing import ClassVar

import numpy as np

from ..cones import SLICES, TEXELS, Cones
from ..frame import Frame
from ..kernels import cosine_hemisphere
from ..passes import AMBIENT, DIRECT, Pass
from .base import Bias, Directions, Falloff, Module, Radius, Steps, Thickness


def _bent_normal(frame: Frame, raw: str) -> np.ndarray:
    """Σ V s / Σ V, world space; 0 where nothing is open, and in the background."""
    name = f"blocked_direction{raw}"
    blocked = frame[name]
    visibility = 1 - blocked[..., 3:]
    bent = np.float32(2 / 3) * frame.world_normal(name) - blocked[..., :3]
    return np.where(visibility > 1e-4, bent / np.maximum(visibility, np.float32(1e-4)), np.float32(0))


class SSBN(Module):
    """A cone around the mean open direction stands for all that is open; the environment is looked up in it.

    Its map is averaged over cones beforehand, in eight sizes. The estimate knows no light, but a new environment needs
    new averages, and the same bent normal means the same light: in corners both sides get one colour.
    """

    name = "ssbn"
    title = "Screen-space bent normals and cones"
    paper = "Klehm, Ritschel, Eisemann and Seidel 2011, Bent Normals and Cones in Screen-space"
    shader = "ssbn.frag"
    outputs: ClassVar = {"blocked_direction": "RGBA16F"}
    derived: ClassVar = {
        "bent_normal": _bent_normal,
        "visibility": lambda frame, raw: np.clip(1 - frame[f"blocked_direction{raw}"][..., 3], 0, 1),
    }

    radius: Radius = "auto"
    directions: Directions = 8
    steps: Steps = 4
    bias: Bias = 0.01
    falloff: Falloff = 0.3
    thickness: Thickness = 0.9

    def samples(self, seed: int) -> dict[str, bytes]:
        return {"kernel": cosine_hemisphere(self.directions, seed, self.falloff).tobytes()}

    def tables(self) -> dict[str, Cones]:
        return {"cone_environment": Cones()}

    def lighting(self) -> list[Pass]:
        size = {"cone_slices": SLICES, "cone_texels": TEXELS}
        return [DIRECT, Pass("ambient", "ssbn.ambient.frag", AMBIENT.outputs, size)]
