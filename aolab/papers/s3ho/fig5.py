"""S3HO, figure 5: three boxes between two lamps, before and after the lamps are swapped."""

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...notebook.glyph import Glyph
from ...notebook.reading import glyph
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ..figure import Figure, Need, figure
from ..pixels import pixel_at, rmse
from .local import LAMPS, drawn, marked, open_irradiance, traced_glyph, without_shadow_maps

# on the floor, 0.12 beside the outer faces of the boxes in front
POINTS = {"p1": (-1.75, 0.0, 0.65), "p2": (1.75, 0.0, 0.65)}


def fig5(size: Size = (480, 270), rays: int = 4096) -> Figure:
    """Three boxes between a pink and a turquoise lamp; the same estimate, relit with the lamps swapped.

    Scene and camera are mirror-symmetric, so that swapping the lamps mirrors the picture. Numbers: the root mean square
    difference from the mirrored picture, and the change by swapping; the ratio of red to green at the points p1 and p2:
    with S3HO, with the coefficients that rays find, and without occlusion.
    """
    scene, swapped = (without_shadow_maps(load("boxes", swap=swap, ambient=0.0)) for swap in (False, True))
    left = drawn(scene, LAMPS, size)
    right = shared_lab().relight(left, lights=swapped.lights)
    frames = {"pink left": left, "pink right": right}
    pixels = {name: pixel_at(left, point) for name, point in POINTS.items()}
    ours = {light: {name: glyph(frame, pixel) for name, pixel in pixels.items()} for light, frame in frames.items()}
    traced = {light: _traced(frame, pixels, rays) for light, frame in frames.items()}
    ratios = {
        light: {
            name: {
                "S3HO": _ratio(frame["radiance"][pixels[name][1], pixels[name][0]]),
                "rays": _ratio(traced[light][name].irradiance),
                "open": _ratio(open_irradiance(ours[light][name])),
            }
            for name in POINTS
        }
        for light, frame in frames.items()
    }
    mirrored = rmse(left["radiance"], right["radiance"][:, ::-1], left.mask)
    swapping = rmse(left["radiance"], right["radiance"], left.mask)
    needs = [Need("the mirrored picture's difference over that of swapping", mirrored / swapping, below=0.02)]
    for light, points in ratios.items():
        for name, ratio in points.items():
            pinker = 1 if (name == "p1") == (light == "pink left") else -1
            needs += [
                Need(f"red over green at {name}, {light}, over rays'", ratio["S3HO"] / ratio["rays"], 0.85, 1.15),
                Need(
                    f"the colour of {name}'s open side, {light}", (ratio["S3HO"] / ratio["open"]) ** pinker, above=1.4
                ),
            ]
    claim = "Swapping the lamps swaps the colours of the local shadows, pinkish and greenish: the picture is mirrored"
    numbers = {
        "red_over_green": ratios,
        "change_of_radiance": {"mirrored": mirrored, "swapping": swapping},
        "rays": rays,
    }
    middle = pixel_at(left, (0, 0, 1.2))
    pictures = []
    for light, frame in frames.items():
        pictures += [
            (light, marked(frame.image, pixels)),
            (f"the light, {light}", glyph(frame, middle).light_picture(size)),
        ]
    for name in POINTS:
        pictures.append((f"open directions at {name}, S3HO", ours["pink left"][name].occlusion_picture(size)))
        pictures.append((f"open directions at {name}, rays", traced["pink left"][name].occlusion_picture(size)))
    return figure("S3HO, Fig. 5", claim, needs, numbers, pictures, 4)


def _traced(frame: Frame, pixels: dict[str, tuple[int, int]], rays: int) -> dict[str, Glyph]:
    return {name: traced_glyph(frame, pixel, LAMPS, rays) for name, pixel in pixels.items()}


def _ratio(rgb: np.ndarray) -> float:
    return float(rgb[0] / rgb[1])
