"""SSDO, figure 6: the shadow of one light on the screen alone, with one depth layer and with peeled layers."""

import numpy as np

from ...gl.texture import Size
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.environment import Environment
from ...scene.lights import PointLight
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ...truth import reference
from ..closeups import over_background
from ..figure import Figure, Need, figure
from ..pixels import world_positions

POST, THICK = 1.2, 0.3  # height and thickness of a post in the light of one bulb; lengths in scene units
BULB = (-2.6, 2.6, 0.0)
RADII = (0.75, 1.5, 3.0)  # the last one is longer than the shadow
LIGHT_STEPS = 64
KINDS = {"one layer": "depth", "peeled layers": "layers"}


def fig6(size: Size = (480, 270)) -> Figure:
    """The shadow of a post on the screen alone, by one depth layer and by peeled ones; beside rays and a shadow map.

    Numbers: the length of the shadow, as a multiple of the length that a segment of one radius gives; the found share
    of the true shadow; and the area of false shadow, as a multiple of the true shadow's area.
    """
    scene = _post()
    lit = scene.replace(lights=(_bulb(),))
    truth = reference(lit, size=size, rays=64, radius=max(RADII), falloff=0, buffers=("direct", "ambient"))
    mapped = shared_lab().render(lit, "none", size=size)
    beside = {
        "one layer": ("rays", over_background(truth["direct"] + truth["ambient"], truth)),
        "peeled layers": ("shadow map", mapped.image),
    }
    numbers, pictures, needs = {}, [], []
    for name, occluders in KINDS.items():
        frames = {radius: _lit_on_screen(scene, size, radius, occluders) for radius in RADII}
        numbers[name] = [_shadow(frame, truth, radius) for radius, frame in frames.items()]
        for found, frame in zip(numbers[name], frames.values(), strict=True):
            radius, length = found["radius"], found["length_over_a_segments"]
            # the shadow's tip is missing: samples start a pixel's width above the ground
            needs.append(Need(f"the shadow's length over a segment's, {name}, radius {radius:g}", length, 0.85, 1.1))
            pictures.append(
                (f"{name}, radius {radius:g}: {found['found']:.0%} found, {found['false']:.0%} false", frame.image)
            )
        pictures.append(beside[name])
    growth = np.diff([found["false"] for found in numbers["one layer"]])
    right = numbers["peeled layers"][-1]
    needs += [
        Need("the least growth of one layer's false shadow from radius to radius", float(growth.min()), above=0.4),
        Need("the share of the true shadow that peeled layers find", right["found"], above=0.85),
        Need("the false shadow of peeled layers", right["false"], below=0.02),
    ]
    claim = (
        "The radius limits the length of the shadow; with one layer its false part grows with the radius, "
        "and with peeled layers it is the ray-traced shadow"
    )
    return figure("SSDO, Fig. 6", claim, needs, numbers, pictures, 4)


def _shadow(frame: Frame, truth: Frame, radius: float) -> dict[str, float]:
    positions = world_positions(truth)
    with np.errstate(invalid="ignore"):
        ground = truth.mask & (np.abs(positions[..., 1]) < 1e-3)
    dark, shadow = (ground & ~one["direct"].any(axis=-1) for one in (truth, frame))
    beyond = positions[..., 0][dark & shadow] - THICK / 2
    length = float(np.quantile(beyond, 0.99)) if len(beyond) else 0.0
    return {
        "radius": radius,
        "length": length,
        "length_over_a_segments": length / _reach(radius),
        "found": float((shadow & dark).sum() / dark.sum()),
        "false": float((shadow & ~dark).sum() / dark.sum()),
    }


def _bulb(shadow: bool = True) -> PointLight:
    return PointLight(BULB, (26.0, 23.0, 18.0), shadow=shadow)


def _post() -> Scene:
    """The bulb has no shadow map: the shadow comes from the screen alone."""
    paper = Material((0.75, 0.75, 0.75))
    post = Instance(block((THICK, POST + 0.01, THICK), Material((0.3, 0.45, 0.75)), "post"), placed(0, -0.01, 0))
    ground = Instance(block((30, 0.2, 30), paper, "ground"), placed(0, -0.2, 0))
    camera = Camera((1.2, 2.2, 4.8), (0.85, 0.3, 0), fov=38)
    return Scene((ground, post), (_bulb(shadow=False),), Environment.constant(0.06), camera)


def _lit_on_screen(scene: Scene, size: Size, radius: float, occluders: str) -> Frame:
    settings = {"occluders": occluders, "light_steps": LIGHT_STEPS, "bias": 0.002, "falloff": 0.0, "filter": "none"}
    return shared_lab().render(scene, "ssdo", size=size, radius=radius, **settings)


def _reach(radius: float) -> float:
    """The length of the shadow on the ground if segments of length `radius` are tested towards the bulb."""
    across, up = THICK / 2 - BULB[0], BULB[1]
    whole = across * POST / (up - POST)
    distance = np.linspace(0, whole, 10_000)
    slant = np.hypot(distance + across, up) / (distance + across)
    return float(distance[distance * slant <= radius].max())
