"""Screen-space spherical harmonic occlusion: visibility and cosine as 16 coefficients, apart from any light."""

from collections.abc import Callable
from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np

from ..maths.harmonics import clamped_cosine, rotation
from ..scene.scene import Scene
from .base import Bleeding, DistanceClamp, Estimate, Senders, with_distance_clamp
from .buffers import LIT, Buffer
from .marched import Marched
from .parameters import parameter
from .passes import Pass, term
from .readable import Readable
from .reflected import note_emission

OCCLUSION = {f"occlusion{i}": "RGBA16F" for i in range(4)}
BOUNCE = {f"bounce{i}": "RGBA16F" for i in range(7)}
SENDERS = {**BOUNCE, "sender_offset": "RGBA16F"}


def _coefficients(frame: Readable, raw: str) -> np.ndarray:
    """(H, W, 16): c = c_cos(n) - o, world space; 0 in the background. The shader's twin is glsl/s3ho.transfer.glsl."""
    occlusion = np.concatenate([frame[f"occlusion{i}{raw}"] for i in range(4)], axis=-1)
    normal = frame.world_normal(f"occlusion0{raw}")
    to_world = rotation(frame.camera.view_from_world[:3, :3].T).astype(np.float32)
    transfer = _within_bounds(clamped_cosine(normal).astype(np.float32) - occlusion @ to_world.T)
    return np.where(normal.any(axis=-1, keepdims=True), transfer, np.float32(0))


def _within_bounds(transfer: np.ndarray) -> np.ndarray:
    """(..., 16): every band at most as long as in a function that is nowhere negative, √(2l + 1) times band 0."""
    whole = np.maximum(transfer[..., :1], 0)
    bands = [whole]
    for band in range(1, 4):
        part = transfer[..., band**2 : (band + 1) ** 2]
        length = np.maximum(np.linalg.norm(part, axis=-1, keepdims=True), np.float32(1e-10))
        bands.append(part * np.minimum(whole * np.float32(np.sqrt(2 * band + 1)) / length, 1))
    return np.concatenate(bands, axis=-1)


def unpacked(texels: np.ndarray) -> np.ndarray:
    """(..., 9, 3): coefficients of the bounce by colour, of its texels (..., 7, 4); twin of glsl/s3ho.packing.glsl."""
    last = np.stack([texels[..., 0:3, 3], texels[..., 3:6, 3]], axis=-2)
    return np.concatenate([texels[..., :3], last], axis=-2)


def _column(i: int) -> Callable[[Readable, str], np.ndarray]:
    """Coefficients 4 i to 4 i + 3, as the reference's buffers have them."""
    return lambda frame, raw: frame.once(f"sh{raw}", lambda: _coefficients(frame, raw))[..., 4 * i : 4 * i + 4]


def _visibility(frame: Readable, raw: str) -> np.ndarray:
    """(1/π) ∫ V cosθ dω, by the first coefficient: ∫ f y_0 dω, where y_0 = 1/√4π is constant."""
    return np.clip(1 - np.float32(2 / np.sqrt(np.pi)) * frame[f"occlusion0{raw}"][..., 0], 0, 1)


class S3HO(Marched):
    """Visibility times cosine in spherical harmonics (`sh0` to `sh3`); light comes afterwards, by a dot product.

    The estimate does not depend on the light: after lights or environment changed, `Lab.relight` computes the lighting
    only. With `indirect`, occluders reflect the light, as nine coefficients a colour (`bounce0` to `bounce6`).
    """

    name = "s3ho"
    claims = "ambient"
    title = "Screen-space spherical harmonic occlusion"
    paper = "Herholz, Schairer, Schilling and Straßer 2012, Screen Space Spherical Harmonic Occlusion"
    shader = "s3ho.moments.frag"
    outputs: ClassVar = OCCLUSION
    derived: ClassVar = {
        **{f"sh{i}": _column(i) for i in range(4)},
        "visibility": _visibility,
    }

    buffers: ClassVar = (
        *(
            Buffer(name, 4, "RGBA16F", "", 0, "numbers", "Coefficients that occlusion takes away.")
            for name in OCCLUSION
        ),
        *(Buffer(name, 4, "RGBA16F", "", 0, "numbers", "Coefficients of the bounce, packed.") for name in BOUNCE),
        Buffer("sender_offset", 4, "RGBA16F", "radii", 0, "numbers", "Sums of the senders' offsets and weights."),
    )

    estimator: Literal["blocked", "plain"] = parameter(
        "blocked", "The clamped cosine less the blocked directions, or the `plain` sum over open ones."
    )
    strength: float = parameter(
        0.0, "λ: an occluder at distance d lets 1 - 1/(1 + λ d) through; 0 blocks wholly, as for rays.", ge=0, le=100,
        unit="1 / radii",
    )  # fmt: skip
    lights: Literal["lobes", "sharp"] = parameter(
        "lobes", "Lights after their shadow maps: as windowed lobes, which occlusion shades, or as they are (`sharp`)."
    )
    light_window: float = parameter(
        4.0,
        "Width of the Hann window of a light's lobe; a smaller one makes a broader lobe.",
        gt=1,
        le=64,
        unit="bands",
    )
    indirect: bool = parameter(False, "One bounce from the occluders on the screen, as coefficients (S3HOGI).")
    bleeding: Bleeding = 1.0
    distance_clamp: DistanceClamp = "auto"
    senders: Senders = "rays"

    def estimate(self) -> Estimate:
        passes, outputs = self.passes(), dict(OCCLUSION)
        if self.indirect:
            constants = {"patches": self.senders == "patches", "fading": self.strength > 0}
            # no light is known yet: a sender is given by its albedo, as hidden ones are from the beginning
            nothing, albedo = dict.fromkeys(SENDERS, 0.0), {"sender": "albedo"}
            passes.append(Pass("s3ho senders", "s3ho.senders.frag", SENDERS, constants, albedo, background=nothing))
            outputs |= SENDERS
        # a blocked direction has a part in the first coefficient, and only such directions have senders
        return Estimate(passes, outputs, decides="occlusion0" if self.estimator == "blocked" else "")

    def passes(self) -> list[Pass]:
        constants = {"fading": self.strength > 0, "plain": self.estimator == "plain"}
        return [Pass("s3ho", self.shader, OCCLUSION, constants, background=self._background(S3HO, 0.0))]

    def sends(self) -> bool:
        return self.indirect

    def openness(self) -> str:
        """As in `_visibility`."""
        return """
        uniform sampler2D occlusion0;
        float opennessAt(ivec2 pixel) { return clamp(1.0 - 1.128379 * texelFetch(occlusion0, pixel, 0).x, 0.0, 1.0); }
        """

    def lighting(self) -> list[Pass]:
        *fills, direct = self.direct()
        if self.lights == "lobes":
            direct = replace(direct, includes={"direct.glsl": "s3ho.direct.glsl"})
        passes = [*fills, direct]
        passes.append(term("ambient", "s3ho.ambient.glsl"))
        if self.indirect:  # with this, a single pass for the picture would read more than 16 textures
            passes.append(Pass("indirect", "s3ho.indirect.frag", {"indirect": LIT["indirect"].format}))
        return passes

    def resolved(self, scene: Scene) -> "S3HO":
        if self.indirect:
            note_emission("s3ho", "lights and environment", scene)
        return with_distance_clamp(super().resolved(scene))
