"""S3HO's figures of light: two points under one light (3), three boxes between two lamps (5), towers in the sun (6)."""

from dataclasses import replace

import numpy as np
from PIL import Image, ImageDraw

from ...gl.texture import Size
from ...loading import load
from ...modules import S3HO
from ...notebook.reading import glyph
from ...pictures.sheet import contact_sheet
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.lights import DirectionalLight
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ...truth.picture import shown
from ..figure import LUMINANCE, Figure, closeup, pixel_at, rmse

SIZE = (640, 360)
ACCUMULATE = 32  # frames, so that noise is no part of what is compared
OPEN = 1e-6  # scene units: a radius within which nothing is, so that every direction is open
# As far as walls and boxes are high. What is accumulated needs no filter, whose even number of pixels has no middle.
LAMPS = S3HO(radius=1.0, directions=32, filter="none")


def _without_shadow_maps(scene: Scene) -> Scene:
    """As in the paper: only local occlusion shades."""
    return scene.replace(lights=tuple(replace(light, shadow=False) for light in scene.lights))


def _drawn(scene: Scene, module: S3HO, size: Size) -> Frame:
    return shared_lab().render(scene, module, size=size, accumulate=ACCUMULATE)


# --- figure 3
ORANGE, BLUE = (3.2, 1.3, 0.25), (0.25, 0.9, 3.2)  # irradiance, from the upper left and from the upper right


def fig3(size: Size = SIZE) -> Figure:
    """One point on the floor under one light, with a wall to its right (p1), and with one to its left (p2).

    Numbers: red over blue of the light that the point reflects, beside that of the same point with all open, which
    SSAO, a factor, would leave as it is.
    """
    red_over_blue, visibility, pictures = {}, {}, []
    for name, side in (("p1, occluded from the right", 1), ("p2, occluded from the left", -1)):
        scene = _wall(side)
        frame, open_ = (_drawn(scene, LAMPS.replace(radius=radius), size) for radius in (LAMPS.radius, OPEN))
        column, row = pixel_at(frame, (0, 0, 0))
        point = glyph(frame, (column, row))
        lights = {"occluded": frame["radiance"][row, column], "open": open_["radiance"][row, column]}
        ratios = {how: float(rgb[0] / rgb[2]) for how, rgb in lights.items()}
        red_over_blue[name], visibility[name] = ratios, point.visibility
        pictures += [
            (f"{name}: red / blue = {ratios['occluded']:.2g}", _marked(frame.image, {name[:2]: (column, row)})),
            ("what it lets in", point.occlusion_picture(size)),
            ("the light that comes", point.light_picture(size)),
        ]
    first, second = red_over_blue.values()
    claim = "Under the same light, the point that is occluded from the right is orange, that from the left blue"
    picture = contact_sheet(pictures, 3, title=f"S3HO, Fig. 3: {claim}. The open point: {first['open']:.2g}.")
    holds = first["occluded"] > 1.5 * first["open"] and second["occluded"] < second["open"] / 1.5
    return Figure(picture, {"red_over_blue": red_over_blue, "visibility": visibility}, claim, holds)


def _wall(side: int) -> Scene:
    """A floor, and a wall on this side of the origin."""
    paper = Material((0.75, 0.75, 0.75))
    wall = Instance(block((0.4, 1.01, 1.4), paper, "wall"), placed(side * 0.35, -0.01, 0))
    floor = Instance(block((30, 0.2, 30), paper, "floor"), placed(0, -0.2, 0))
    lights = tuple(
        DirectionalLight((-across, -1.0, -0.25), color, shadow=False) for across, color in ((-1, ORANGE), (1, BLUE))
    )
    return Scene((floor, wall), lights, camera=Camera((0, 2.6, 2.9), (0, 0.25, 0), fov=38))


def _marked(image: np.ndarray, points: dict[str, tuple[int, int]]) -> np.ndarray:
    """A circle around each named pixel (column, row)."""
    picture = Image.fromarray(image)
    draw = ImageDraw.Draw(picture)
    for name, (x, y) in points.items():
        draw.ellipse((x - 4, y - 4, x + 4, y + 4), outline=(255, 255, 255))
        draw.text((x + 6, y - 6), name, (255, 255, 255))
    return np.asarray(picture)


# --- figure 5
P1, P2 = (-1.75, 0.0, 0.65), (1.75, 0.0, 0.65)  # on the floor, 0.12 beside the outer faces of the boxes in front


def fig5(size: Size = SIZE) -> Figure:
    """Three boxes between a pink lamp and a turquoise one; the same estimate, lit again with the two swapped.

    Scene and camera are their own mirror images, so the swapped picture is the mirrored one. Numbers: how far it is not
    (root mean square), beside what swapping changes and what occlusion does; red over green at the points p1 and p2,
    and what it would be there if all were open.
    """
    scene, swapped = (_without_shadow_maps(load("boxes", swap=swap, ambient=0.0)) for swap in (False, True))
    left, open_ = (_drawn(scene, LAMPS.replace(radius=radius), size) for radius in (LAMPS.radius, OPEN))
    right = shared_lab().relight(left, lights=swapped.lights)
    radiance = {"pink left": left["radiance"], "pink right": right["radiance"], "pink left, open": open_["radiance"]}
    before = radiance["pink left"]
    changes = {
        "mirrored": rmse(before, radiance["pink right"][:, ::-1], left.mask),
        "swapping": rmse(before, radiance["pink right"], left.mask),
        "occlusion": rmse(before, radiance["pink left, open"], left.mask),
    }
    pixels = {"p1": pixel_at(left, P1), "p2": pixel_at(left, P2)}
    ratios = {
        name: {point: float(rgb[row, column, 0] / rgb[row, column, 1]) for point, (column, row) in pixels.items()}
        for name, rgb in radiance.items()
    }
    middle = pixel_at(left, (0, 0, 1.2))
    pictures = [
        ("pink left", _marked(left.image, pixels)),
        ("pink right", _marked(right.image, pixels)),
        *((f"what {point} lets in", glyph(left, pixel).occlusion_picture(size)) for point, pixel in pixels.items()),
        ("light, pink left", glyph(left, middle).light_picture(size)),
        ("light, pink right", glyph(right, middle).light_picture(size)),
    ]
    claim = "Swapping the lamps swaps the colours of the local shadows, pinkish and greenish: the picture is mirrored"
    holds = (
        ratios["pink left"]["p1"] > 1.5 * ratios["pink left, open"]["p1"]
        and ratios["pink left"]["p2"] < ratios["pink left, open"]["p2"] / 1.5
        and ratios["pink right"]["p1"] < 1 < ratios["pink right"]["p2"]
        and changes["mirrored"] < 0.05 * min(changes["swapping"], changes["occlusion"])
    )
    numbers = {"red_over_green": ratios, "change_of_radiance": changes}
    return Figure(contact_sheet(pictures, 2, title=f"S3HO, Fig. 5: {claim}."), numbers, claim, holds)


# --- figure 6
TOWERS = S3HO(radius=0.8, directions=32)  # scene units: as wide as a street
HALF_OPEN = (0.3, 0.8)  # visibilities between which a surface counts as being in a local shadow
CLOSEUPS = {"away from the sun": (0.73, 0.55), "towards the sun": (0.4, 0.5)}  # their middles, x, y, in pictures


def fig6(size: Size = (800, 450)) -> Figure:
    """Towers under a blue sky with a yellow sun, the light of both with S3HO, and times SSAO's visibility.

    As the paper has it, SSAO's occlusion factor multiplies all of the diffuse light, that of the sun included: the open
    surface's, of the same lobe and sky. Both have one estimate, and so the same samples, filter and mean.
    Numbers: over flat surfaces in half shadow whose open side is turned away from the sun, or towards it, the luminance
    of S3HO in that of SSAO, and blue over red of both.
    """
    scene = _without_shadow_maps(load("skyscrapers")).replace(camera=CITY)
    frame, open_ = (_drawn(scene, TOWERS.replace(radius=radius), size) for radius in (TOWERS.radius, OPEN))
    visibility = np.where(frame.mask, frame["visibility"], 1)
    radiance = {"S3HO": frame["radiance"], "SSAO": open_["radiance"] * visibility[..., None]}
    numbers = {}
    for name, where in _sides(frame, visibility).items():
        light = {method: value[where].mean(axis=0) for method, value in radiance.items()}
        numbers[name] = {
            "luminance": float(light["S3HO"] @ LUMINANCE / (light["SSAO"] @ LUMINANCE)),
            "blue_over_red": {method: float(rgb[2] / rgb[0]) for method, rgb in light.items()},
            "pixels": int(where.sum()),
        }
    away, towards = numbers.values()
    images = {method: shown(value) for method, value in radiance.items()}
    pictures = [*images.items()]
    for name, middle in CLOSEUPS.items():
        pictures += [(f"{method}, {name}", closeup(image, middle, 3)) for method, image in images.items()]
    claim = (
        "Local shadows that are open away from the sun are darker and bluer than SSAO's, those towards it are lighter"
    )
    blue = away["blue_over_red"]
    holds = away["luminance"] < 0.9 and blue["S3HO"] > 1.2 * blue["SSAO"] and towards["luminance"] > 1.1
    return Figure(contact_sheet(pictures, 2, title=f"S3HO, Fig. 6: {claim}."), numbers, claim, holds)


CITY = Camera((1.4, 11.0, 9.0), (0.2, 0, 0.2), fov=30)  # from above, so that both sides of streets are seen


def _sides(frame: Frame, visibility: np.ndarray) -> dict[str, np.ndarray]:
    """(H, W) bool: flat surfaces in half shadow whose mean open direction leans away from the sun, and towards it."""
    assert frame.scene is not None  # it was rendered
    (sun,) = frame.scene.lights
    assert isinstance(sun, DirectionalLight)
    first = frame["sh0"]  # band 1 is the mean direction: see `aolab.maths.harmonics` for its order and signs
    across, up, along = -first[..., 3], -first[..., 1], first[..., 2]
    towards = -(across * sun.direction[0] + along * sun.direction[2]) / np.hypot(sun.direction[0], sun.direction[2])
    leaning = towards / np.maximum(np.hypot(up, np.hypot(across, along)), 1e-6)
    shaded = (visibility > HALF_OPEN[0]) & (visibility < HALF_OPEN[1])
    flat = frame.mask & (frame.world_normal()[..., 1] > 0.99) & shaded
    return {"away from the sun": flat & (leaning < -0.2), "towards the sun": flat & (leaning > 0.2)}
