"""S3HO, figure 3: two points under the same light, occluded from opposite sides."""

from ...gl.texture import Size
from ...notebook.reading import glyph
from ...scene.camera import Camera
from ...scene.lights import DirectionalLight
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ..figure import Figure, Need, figure
from ..pixels import pixel_at
from .local import LAMPS, drawn, marked, open_irradiance, traced_glyph

ORANGE, BLUE = (3.2, 1.3, 0.25), (0.25, 0.9, 3.2)  # irradiance, from the upper left and from the upper right
POINTS = {"p1": ("occluded from the right", 1), "p2": ("occluded from the left", -1)}  # and the side of x


def fig3(size: Size = (400, 225), rays: int = 4096) -> Figure:
    """A point on the floor with a wall to its right (p1), and with a wall to its left (p2), under the same light.

    Numbers: the visibility, and the ratio of red to blue in the reflected light: with S3HO, with the coefficients that
    rays find, and without occlusion. SSAO, a factor, does not change the last ratio.
    """
    numbers, pictures, needs = {}, [], []
    for name, (where, side) in POINTS.items():
        frame = drawn(_wall(side), LAMPS, size)
        pixel = pixel_at(frame, (0, 0, 0))
        ours, right = glyph(frame, pixel), traced_glyph(frame, pixel, LAMPS, rays)
        light = {"S3HO": frame["radiance"][pixel[1], pixel[0]], "rays": right.irradiance, "open": open_irradiance(ours)}
        ratios = {how: float(rgb[0] / rgb[2]) for how, rgb in light.items()}
        visibility = {"S3HO": ours.visibility, "rays": right.visibility}
        numbers[name] = {"red_over_blue": ratios, "visibility": visibility}
        needs += [
            Need(f"red over blue at {name}, over rays'", ratios["S3HO"] / ratios["rays"], 0.9, 1.1),
            Need(f"visibility at {name}, over rays'", ours.visibility / right.visibility, 0.9, 1.1),
            Need(
                f"open side's colour over the other's at {name}", (ratios["S3HO"] / ratios["open"]) ** side, above=1.5
            ),
        ]
        pictures += [
            (
                f"{name}, {where}: red / blue = {ratios['S3HO']:.2g}, rays' {ratios['rays']:.2g}",
                marked(frame.image, {name: pixel}),
            ),
            ("the light", ours.light_picture(size)),
            ("open directions, S3HO", ours.occlusion_picture(size)),
            ("open directions, rays", right.occlusion_picture(size)),
        ]
    claim = "Under the same light, the point that is occluded from the right is orange, that from the left blue"
    return figure("S3HO, Fig. 3", claim, needs, {**numbers, "rays": rays}, pictures, 4)


def _wall(side: int) -> Scene:
    """A floor, and a wall on the `side` (of x) of the origin."""
    paper = Material((0.75, 0.75, 0.75))
    wall = Instance(block((0.4, 1.01, 1.4), paper, "wall"), placed(side * 0.35, -0.01, 0))
    floor = Instance(block((30, 0.2, 30), paper, "floor"), placed(0, -0.2, 0))
    lights = tuple(
        DirectionalLight((-across, -1.0, -0.25), color, shadow=False) for across, color in ((-1, ORANGE), (1, BLUE))
    )
    return Scene((floor, wall), lights, camera=Camera((0, 2.6, 2.9), (0, 0.25, 0), fov=38))
