"""SSDO's figures of what the camera does not see: shadows by peeled layers (6), and by further cameras (7)."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules import SSDO
from ...pictures.sheet import contact_sheet, gray
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.environment import Environment
from ...scene.lights import PointLight
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, world_positions

SIZE = (480, 270)

# --- figure 6: a post in the light of one bulb; lengths in scene units
POST, THICK = 1.2, 0.3  # its height and thickness
BULB = (-2.6, 2.6, 0.0)
RADII = (0.75, 1.5, 3.0)  # the last one is longer than the shadow
LIGHT_STEPS = 64


def fig6(size: Size = SIZE) -> Figure:
    """The shadow of a post, on the screen alone: with one depth layer, and with peeled ones, beside a ray-traced one.

    Numbers: how long the shadow is, and what the geometry of a segment of that length says; the share of the true
    shadow that is found; the area of false shadows, in areas of the true one.
    """
    scene = _post()
    truth = reference(scene.replace(lights=(_bulb(),)), size=size, rays=64, buffers=("direct", "radiance"))
    positions = world_positions(truth)
    with np.errstate(invalid="ignore"):
        ground = truth.mask & (np.abs(positions[..., 1]) < 1e-3)
    dark = ground & ~truth["direct"].any(axis=-1)
    numbers: dict[str, list[dict[str, float]]] = {"depth": [], "layers": []}
    pictures = []
    for occluders, found in numbers.items():
        for radius in RADII:
            frame = _lit_on_screen(scene, size, radius, occluders)
            shadow = ground & ~frame["direct"].any(axis=-1)
            beyond = positions[..., 0][dark & shadow] - THICK / 2
            one = {
                "radius": radius,
                "length": float(np.quantile(beyond, 0.99)) if len(beyond) else 0.0,
                "length_of_a_segment": _reach(radius),
                "found": float((shadow & dark).sum() / dark.sum()),
                "false": float((shadow & ~dark).sum() / dark.sum()),
            }
            found.append(one)
            name = "one layer" if occluders == "depth" else "peeled"
            pictures.append(
                (f"{name}, radius {radius:g}: {one['found']:.0%} found, {one['false']:.0%} false", frame.image)
            )
        if occluders == "depth":
            pictures.append(("rays", shown(truth["radiance"])))
    mapped = shared_lab().render(scene.replace(lights=(_bulb(),)), "none", size=size)
    pictures.append(("shadow map", mapped.image))
    claim = (
        "The length of the shadow follows the radius; with one layer its shape does too, "
        "and with peeled layers it is the ray-traced one"
    )
    picture = contact_sheet(pictures, 4, title=f"SSDO, Fig. 6: {claim}.")
    return Figure(picture, numbers, claim, _shadows_hold(numbers))


def _shadows_hold(numbers: dict[str, list[dict[str, float]]]) -> bool:
    """A tenth of the length is left to the tip: a sample is asked for a pixel's width above the ground."""
    follow = all(abs(one["length"] / one["length_of_a_segment"] - 1) < 0.1 for both in numbers.values() for one in both)
    false = [one["false"] for one in numbers["depth"]]
    right = numbers["layers"][-1]
    return follow and all(a < b for a, b in pairwise(false)) and right["found"] > 0.85 and right["false"] < 0.01


def _bulb(shadow: bool = True) -> PointLight:
    return PointLight(BULB, (26.0, 23.0, 18.0), shadow=shadow)


def _post() -> Scene:
    """Its light throws no shadow of its own: that is left to the screen."""
    paper = Material((0.75, 0.75, 0.75))
    post = Instance(block((THICK, POST + 0.01, THICK), Material((0.3, 0.45, 0.75)), "post"), placed(0, -0.01, 0))
    ground = Instance(block((30, 0.2, 30), paper, "ground"), placed(0, -0.2, 0))
    camera = Camera((1.2, 2.2, 4.8), (0.85, 0.3, 0), fov=38)
    return Scene((ground, post), (_bulb(shadow=False),), Environment.constant(0.06), camera)


def _lit_on_screen(scene: Scene, size: Size, radius: float, occluders: str) -> Frame:
    settings = {"occluders": occluders, "light_steps": LIGHT_STEPS, "bias": 0.002}
    return shared_lab().render(scene, "ssdo", size=size, radius=radius, **settings)


def _reach(radius: float) -> float:
    """How far from the post the ground is still shaded by a segment of that length, towards the bulb."""
    across, up = THICK / 2 - BULB[0], BULB[1]
    whole = across * POST / (up - POST)
    distance = np.linspace(0, whole, 10_000)
    slant = np.hypot(distance + across, up) / (distance + across)
    return float(distance[distance * slant <= radius].max())


# --- figure 7
HIDDEN_RADIUS = 2.0  # metres: the hidden column stands 1.6 m behind the nearest one
CROP = (slice(0.5, 1.0), slice(0.25, 0.75))  # rows and columns, of the picture: the feet of both columns
KINDS = {"a single view": "depth", "four more views": "views", "rays": ""}


def fig7(size: Size = SIZE, rays: int = 128) -> Figure:
    """The floor around a column that hides another: what the hidden one takes away, and what it bounces.

    Numbers, as shares of what rays say: the visibility that goes with the hidden column, and the bounce that goes when
    it is painted black.
    """
    scene = load("colonnade")
    *others, pink = scene.instances
    black = replace(pink, mesh=replace(pink.mesh, material=Material((0, 0, 0))))
    scenes = scene, scene.replace(instances=tuple(others)), scene.replace(instances=(*others, black))
    shade, bounce, pictures = {}, {}, []
    for name, occluders in KINDS.items():
        whole, without, unpainted = (_with_bounce(one, (2 * size[0], 2 * size[1]), occluders, rays) for one in scenes)
        lost = np.where(whole.mask, without["visibility"] - whole["visibility"], 0)
        gained = whole["indirect"] - unpainted["indirect"]
        shade[name], bounce[name] = float(lost.sum()), float(gained.sum())
        pictures.append((f"{name}: visibility", gray(_crop(whole["visibility"]))))
        pictures.append((f"{name}: 4 times the bounce", shown(4 * _crop(whole["indirect"]))))
        pictures.append((f"{name}: 10 times the hidden column's", shown(10 * _crop(np.maximum(gained, 0)))))
    numbers = {
        "shadow_of_the_hidden_column": {name: value / shade["rays"] for name, value in shade.items()},
        "bounce_of_the_hidden_column": {name: value / bounce["rays"] for name, value in bounce.items()},
    }
    claim = "A hidden column's shadow and its bounce are missed by a single view, and there with four more"
    holds = all(one["a single view"] == 0 and 0.5 < one["four more views"] < 1.5 for one in numbers.values())
    by_row = pictures[0::3] + pictures[1::3] + pictures[2::3]
    return Figure(contact_sheet(by_row, 3, title=f"SSDO, Fig. 7: {claim}."), numbers, claim, holds)


def _with_bounce(scene: Scene, size: Size, occluders: str, rays: int) -> Frame:
    """By `occluders`, or by rays where there are none."""
    module = SSDO(radius=HIDDEN_RADIUS, directions=16, steps=8, bounces=1, senders="rays")
    if not occluders:
        return reference(scene, size=size, like=module, rays=rays, buffers=("visibility", "indirect"))
    return shared_lab().render(scene, module, size=size, accumulate=4, occluders=occluders)


def _crop(values: np.ndarray) -> np.ndarray:
    height, width = values.shape[:2]
    rows, columns = (
        slice(int(part.start * length), int(part.start * length) + length // 2)
        for part, length in zip(CROP, (height, width), strict=True)
    )
    return values[rows, columns]
