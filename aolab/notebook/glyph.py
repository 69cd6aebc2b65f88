"""What one pixel knows of light: how it lets light in, and what light comes, as functions of direction.

Herholz et al. 2012, Screen Space Spherical Harmonic Occlusion, sections 2.2 and 2.3, Fig. 2 to 5.
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
    """Occlusion and light at one pixel. Coefficients are those of `aolab.maths.harmonics`, in world space.

    `pixel`: (column, row), from the top left. `position` (3,), scene units, and `normal` (3,), unit: the surface there.
    `coefficients` (16,): c_i = ∫ V cosθ y_i dω, visibility times cosine (Eq. 2).
    `light` (16, 3): c_Lin, the environment's radiance and each light's windowed lobe (Eq. 4), RGB. Shadow maps are left
    out: they know what is far away, and a glyph shows what the pixel's own coefficients do with the light.
    `bounce` (16, 3): c_SSGI, what the occluders around reflect (Eq. 5), RGB; None where the frame has no such bounce.
    `camera`: from where it is seen. A notebook shows `picture()`.
    """

    pixel: tuple[int, int]
    position: np.ndarray
    normal: np.ndarray
    coefficients: np.ndarray
    light: np.ndarray
    bounce: np.ndarray | None
    camera: Camera

    @property
    def visibility(self) -> float:
        """The share of light that an even sky leaves: (1/π) ∫ V cosθ dω, by the first coefficient, y_0 = 1/√4π."""
        return float(2 / np.sqrt(np.pi) * self.coefficients[0])

    @property
    def transfer(self) -> np.ndarray:
        """(16, 3): c_S3HOGI = c_S3HO + c_SSGI, from distant light to irradiance, red, green and blue."""
        direct = np.repeat(self.coefficients[:, None], 3, axis=1)
        return direct if self.bounce is None else direct + self.bounce

    @property
    def irradiance(self) -> np.ndarray:
        """(3,): E = c_Lin · c (Eq. 3), RGB, the bounce included. Not clamped: four bands can ring below 0."""
        return (self.light * self.transfer).sum(axis=0)

    @cached_property
    def lobe(self) -> Lobe:
        """The transfer function in directions all around, and the mesh that `occlusion_picture` draws of it."""
        return pictures.lobe(self.coefficients if self.bounce is None else self.transfer)

    def occlusion_picture(self, size: Size = SIZE) -> np.ndarray:
        """(height, width, 3) uint8: the transfer function, turned as the image shows the surface (Fig. 2, 4).

        The distance from the centre is the value in that direction, red where positive, blue where four bands ring
        below 0; with a bounce, the colour is that of the value. The pin is the normal, the ring lies in the tangent
        plane and is 1 in radius: all glyphs have one scale, unless a strong bounce asks for a smaller one.
        """
        return pictures.draw_lobe(self.lobe, self.normal, self.camera, size)

    def light_picture(self, size: Size = SIZE) -> np.ndarray:
        """(height, width, 3) uint8: a sphere that has in each direction the colour of the light from there (Fig. 3, 5).

        It shows the half that the camera looks at. The brightest colour of the whole sphere is full: `brightest`.
        """
        return pictures.draw_light(self.light, self.camera, size)

    @property
    def brightest(self) -> float:
        """The largest radiance that comes from any direction, in any of red, green and blue."""
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
