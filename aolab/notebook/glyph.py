"""The transfer function and the incoming light of one pixel, as functions of direction.

Herholz et al. 2012, "Screen Space Spherical Harmonic Occlusion", sections 2.2 and 2.3, Fig. 2 to 5.
"""

from dataclasses import dataclass
from functools import cached_property
from io import BytesIO

import numpy as np
from PIL import Image

from ..gl.texture import Size
from ..pictures.sheet import contact_sheet
from ..scene.camera import Camera
from . import lobes as pictures
from .lobes import Lobe

SIZE = (240, 240)


@dataclass(frozen=True, eq=False)
class Glyph:
    """Occlusion and light at one pixel. Coefficients use the basis of `aolab.maths.harmonics`, in world space.

    `pixel`: (column, row), counted from the top left.
    `position` (3,), scene units, and `normal` (3,), a unit vector: the surface at the pixel.
    `coefficients` (16,): c_i = ∫ V cosθ y_i dω, visibility times cosine (Eq. 2).
    `light` (16, 3): c_Lin, RGB: the environment's radiance plus the windowed lobe of each light (Eq. 4). Shadow maps
    are left out, so that the glyph shows the effect of the pixel's own coefficients on the light.
    `bounce` (16, 3): c_SSGI, RGB: the light that nearby occluders reflect (Eq. 5); None if the frame has no bounce.
    `bounce_light` (16, 3): the incoming light at the mean position of these occluders, RGB; None without a bounce.
    `camera`: the camera of the frame; pictures show the glyph from its direction. A notebook shows `picture()`.
    """

    pixel: tuple[int, int]
    position: np.ndarray
    normal: np.ndarray
    coefficients: np.ndarray
    light: np.ndarray
    bounce: np.ndarray | None
    bounce_light: np.ndarray | None
    camera: Camera

    @property
    def visibility(self) -> float:
        """The visibility (1/π) ∫ V cosθ dω, computed from the first coefficient; y_0 = 1/√4π."""
        return float(2 / np.sqrt(np.pi) * self.coefficients[0])

    @property
    def transfer(self) -> np.ndarray:
        """(16, 3): c_S3HOGI = c_S3HO + c_SSGI, the factors from distant light to irradiance, RGB."""
        direct = np.repeat(self.coefficients[:, None], 3, axis=1)
        return direct if self.bounce is None else direct + self.bounce

    @property
    def irradiance(self) -> np.ndarray:
        """(3,): E = c_Lin · c (Eq. 3), RGB, and `bounced`. Not clamped: four bands can ring below 0."""
        direct = (self.light * self.coefficients[:, None]).sum(axis=0)
        return direct if self.bounced is None else direct + self.bounced

    @property
    def bounced(self) -> np.ndarray | None:
        """(3,): the irradiance that nearby occluders reflect, RGB: c_SSGI under the light at the occluders."""
        if self.bounce is None or self.bounce_light is None:
            return None
        return (self.bounce_light * self.bounce).sum(axis=0)

    @cached_property
    def lobe(self) -> Lobe:
        """The transfer function sampled over all directions, and the mesh that `occlusion_picture` draws."""
        return pictures.lobe(self.coefficients if self.bounce is None else self.transfer)

    def occlusion_picture(self, size: Size = SIZE) -> np.ndarray:
        """The transfer function, seen from the frame's camera (Fig. 2, 4): (height, width, 3) uint8.

        The distance from the centre is the absolute value in that direction: red if the value is positive, blue if it
        is negative (four bands ring). With a bounce, the lobe has the RGB colour of the values. The pin is the normal;
        the ring lies in the tangent plane and has radius 1. All glyphs have the same scale; it is reduced only if a
        strong bounce would leave the picture.
        """
        return pictures.draw_lobe(self.lobe, self.normal, self.camera, size)

    def light_picture(self, size: Size = SIZE) -> np.ndarray:
        """The incoming light on a sphere (Fig. 3, 5): (height, width, 3) uint8.

        Each point of the sphere has the colour of the light from its direction. The camera sees half of the sphere.
        Colours are divided by the largest radiance of the whole sphere, `brightest`.
        """
        return pictures.draw_light(self.light, self.camera, size)

    @property
    def brightest(self) -> float:
        """The largest incoming radiance over all directions and over red, green and blue."""
        return pictures.brightest(self.light)

    def picture(self, size: Size = SIZE) -> Image.Image:
        """Both pictures, each of `size` (width, height) pixels, with captions."""
        red, green, blue = self.irradiance
        pictures = [
            ("visibility times cosine" + ("" if self.bounce is None else ", and bounce"), self.occlusion_picture(size)),
            (f"incoming light, up to {self.brightest:.2g}", self.light_picture(size)),
        ]
        return contact_sheet(pictures, title=f"pixel {self.pixel}: irradiance {red:.2f}, {green:.2f}, {blue:.2f}")

    def _repr_png_(self) -> bytes:
        data = BytesIO()
        self.picture().save(data, "PNG")
        return data.getvalue()
