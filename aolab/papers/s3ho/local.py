"""Parts of S3HO's figures 3, 5 and 6: lights without shadow maps, and the truth at single points."""

from dataclasses import replace

import numpy as np
from PIL import Image, ImageDraw

from ...gl.texture import Size
from ...maths.harmonics import clamped_cosine
from ...modules import S3HO
from ...notebook.glyph import Glyph
from ...notebook.reading import glyph
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.scene import Scene
from ...truth import reference
from ..pixels import world_positions

HARMONICS = ("sh0", "sh1", "sh2", "sh3")
# The radius is the height of walls and boxes. A mean of frames needs no filter, whose even width has no middle pixel.
LAMPS = S3HO(radius=1.0, directions=32, steps=16, filter="none")


def without_shadow_maps(scene: Scene) -> Scene:
    return scene.replace(lights=tuple(replace(light, shadow=False) for light in scene.lights))


def drawn(scene: Scene, module: S3HO, size: Size, accumulate: int = 32) -> Frame:
    """The mean of so many frames that noise does not matter."""
    return shared_lab().render(scene, module, size=size, accumulate=accumulate)


def traced_glyph(frame: Frame, pixel: tuple[int, int], like: S3HO, rays: int) -> Glyph:
    """The glyph at a pixel (column, row) of `frame`, with the coefficients that rays find at its point."""
    point = world_positions(frame)[pixel[1], pixel[0]]
    camera = replace(frame.camera, target=tuple(point), fov=0.2)  # a narrow view, whose middle is the point
    truth = reference(frame.scene, size=(5, 5), camera=camera, like=like, rays=rays, buffers=HARMONICS)
    return replace(glyph(truth, (2, 2)), camera=frame.camera)


def open_irradiance(point: Glyph) -> np.ndarray:
    """(3,): the irradiance at a glyph's point without any occlusion."""
    return point.light.T @ clamped_cosine(point.normal)


def marked(image: np.ndarray, points: dict[str, tuple[int, int]]) -> np.ndarray:
    """The image with a circle around each named pixel (column, row)."""
    picture = Image.fromarray(image)
    draw = ImageDraw.Draw(picture)
    for name, (x, y) in points.items():
        draw.ellipse((x - 4, y - 4, x + 4, y + 4), outline=(255, 255, 255))
        draw.text((x + 6, y - 6), name, (255, 255, 255))
    return np.asarray(picture)
