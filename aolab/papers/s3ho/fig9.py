"""S3HO, figure 9: a large scene with one bounce, by S3HO and by SSDO, and their noise."""

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules import S3HO, SSDO, Module
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.scene import Scene
from ...truth import reference
from ...truth.picture import shown
from ..closeups import closeup, over_background, overview, zoomed
from ..figure import Figure, Need, figure
from ..pixels import noise, rmse
from .atrium import RADIUS, atrium
from .room import KINDS

S3HOGI = S3HO(radius=RADIUS, directions=32, steps=2, indirect=True)
BOUNCE = SSDO(radius=RADIUS, directions=32, steps=2, bounces=1)
PRINTED = {"estimator": "plain", "senders": "patches"}
METHODS: dict[str, Module] = {
    "S3HO": S3HOGI,
    "SSDO": BOUNCE,
    "S3HO as printed": S3HOGI.replace(**PRINTED),
    "SSDO as printed": BOUNCE.replace(**PRINTED),
}
GREY = 0.5  # the albedo that untextured pictures show
FOUNTAIN = (0.52, 0.62)  # x, y in the picture


def fig9(size: Size = (320, 180), rays: int = 64, seeds: int = 4) -> Figure:
    """The atrium with one bounce, and its diffuse light without textures and before the filter, beside rays.

    Numbers: the root mean square difference of the light from the rays', as a share of the rays' root mean square; the
    mean bounce, as a multiple of the rays'; the relative noise of the light with its bounce, and of the bounce alone;
    with the sun, and under the sky alone. Two points per direction miss many near occluders: the bounce is too dark.
    """
    large, scene = zoomed(size), atrium()
    truth = reference(scene, size=large, like=BOUNCE, rays=rays, buffers=("ambient", "indirect"))
    draws = {name: _draws(scene, module, large, seeds) for name, module in METHODS.items()}
    even = scene.replace(environment=load("atrium").environment)
    noises = {
        "sun and sky": {name: _noise(some) for name, some in draws.items()},
        "sky": {name: _noise(_draws(even, module, large, seeds)) for name, module in METHODS.items()},
    }
    beside = {name: _beside(some, truth) for name, some in draws.items()}
    needs = []
    for kind, name in KINDS.items():
        s3ho, ssdo = "S3HO" + name, "SSDO" + name
        ratio = beside[s3ho]["bounce_over_rays"] / beside[ssdo]["bounce_over_rays"]
        needs.append(Need(f"S3HO's mean bounce over SSDO's, {kind}", ratio, 0.7, 1.4))
        for method in ("S3HO", "SSDO"):
            difference = beside[method + name]["difference_of_the_light"]
            most = 0.35 if method + name == "SSDO as printed" else 0.28  # its mean still has noise
            needs.append(Need(f"{method}'s light, its difference from rays', {kind}", difference, below=most))
        ratio = noises["sun and sky"][s3ho]["light"] / noises["sun and sky"][ssdo]["light"]
        needs.append(Need(f"S3HO's noise over SSDO's, {kind}", ratio, below=0.5))
    bounces = [f"{name} {noises['sun and sky'][name]['bounce']:.0%}" for name in METHODS]
    claim = (
        "Lit by an environment with a sun in it, S3HO's light with one bounce is similar to SSDO's, and has less noise"
    )
    return figure(
        "S3HO, Fig. 9",
        claim,
        needs,
        {"beside_rays": beside, "noise": noises, "rays": rays},
        _pictures(draws, noises["sun and sky"], truth),
        len(METHODS) + 1,
        f"The noise of the bounce alone: {', '.join(bounces)}",
    )


def _pictures(
    draws: dict[str, list[Frame]], noises: dict[str, dict[str, float]], truth: Frame
) -> list[tuple[str, np.ndarray]]:
    """In rows: the filtered picture; the light without textures, unfiltered; a close-up of that light."""
    right = shown(GREY * _light(truth))
    rows = [
        [("rays", overview(over_background(truth["ambient"] + truth["indirect"], truth)))],
        [("rays", overview(right))],
        [("rays", closeup(right, FOUNTAIN))],
    ]
    for name, some in draws.items():
        raw = shown(GREY * _light(some[0]))
        filtered = shared_lab().render(some[0].scene, METHODS[name], size=some[0].size).image
        rows[0].append((name, overview(filtered)))
        rows[1].append((f"{name}, unfiltered: noise {noises[name]['light']:.1%}", overview(raw)))
        rows[2].append((f"{name}, unfiltered", closeup(raw, FOUNTAIN)))
    return [picture for row in rows for picture in row]


def _noise(draws: list[Frame]) -> dict[str, float]:
    where = draws[0].mask
    bounces = [_untextured(draw, "indirect") for draw in draws]
    return {"light": noise([_light(draw) for draw in draws], where), "bounce": noise(bounces, where)}


def _beside(draws: list[Frame], truth: Frame) -> dict[str, float]:
    where = truth.mask
    light = np.mean([_light(draw) for draw in draws], axis=0)
    bounce = np.mean([_untextured(draw, "indirect")[where].mean() for draw in draws])
    return {
        "difference_of_the_light": rmse(light, _light(truth), where) / rmse(_light(truth), np.zeros_like(light), where),
        "bounce_over_rays": float(bounce / _untextured(truth, "indirect")[where].mean()),
    }


def _draws(scene: Scene, module: Module, size: Size, seeds: int) -> list[Frame]:
    return [shared_lab().render(scene, module, size=size, seed=seed, filter="none") for seed in range(seeds)]


def _untextured(frame: Frame, buffer: str) -> np.ndarray:
    """(H, W, 3): a buffer's light as a surface of albedo 1 reflects it."""
    return frame[buffer] / np.maximum(frame["albedo"][..., :3], 1e-3)


def _light(frame: Frame) -> np.ndarray:
    return _untextured(frame, "ambient") + _untextured(frame, "indirect")
