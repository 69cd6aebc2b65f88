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
from ..closeups import closeup, overview, zoomed
from ..figure import Figure, Need, figure
from ..pixels import noise
from .atrium import RADIUS, atrium

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
    """The atrium with one bounce, and its diffuse light without textures and before the filter.

    Numbers: the means of the light and of its bounce, in those of rays; the relative noise of both together, and of
    the bounce alone, with the sun and under the sky alone. Rays meet the small sun too seldom for a picture.
    """
    large, scene = zoomed(size), atrium()
    truth = reference(scene, size=large, like=BOUNCE, rays=rays, buffers=("ambient", "indirect"))
    draws = {name: _draws(scene, module, large, seeds) for name, module in METHODS.items()}
    even = scene.replace(environment=load("atrium").environment)
    noises = {
        "sun and sky": {name: _noise(some) for name, some in draws.items()},
        "sky": {name: _noise(_draws(even, module, large, seeds)) for name, module in METHODS.items()},
    }
    means = {name: _over(some, truth) for name, some in draws.items()}
    numbers = {"mean_over_rays": means, "noise": noises, "rays": rays}
    needs = []
    for kind, name in {"with the defaults": "", "as printed": " as printed"}.items():
        s3ho, ssdo = "S3HO" + name, "SSDO" + name
        for what, least, most in (("light", 0.9, 1.15), ("bounce", 0.7, 1.4)):
            ratio = means[s3ho][what] / means[ssdo][what]
            needs.append(Need(f"the mean of S3HO's {what} over SSDO's, {kind}", ratio, least, most))
        ratio = noises["sun and sky"][s3ho]["light"] / noises["sun and sky"][ssdo]["light"]
        needs.append(Need(f"S3HO's noise over SSDO's, {kind}", ratio, below=0.5))
    for method in ("S3HO", "SSDO"):
        for what, least, most in (("light", 0.9, 1.15), ("bounce", 0.6, 1.5)):
            needs.append(Need(f"the mean of {method}'s {what} over rays'", means[method][what], least, most))
    bounces = [noises["sun and sky"][name]["bounce"] for name in ("S3HO", "SSDO", "S3HO as printed", "SSDO as printed")]
    finding = (
        f"The bounce alone is as noisy in both: {bounces[0]:.0%} and {bounces[1]:.0%} with the defaults, "
        f"{bounces[2]:.0%} and {bounces[3]:.0%} as printed"
    )
    claim = (
        "Lit by an environment with a sun in it, S3HO's light with one bounce is similar to SSDO's, and has less noise"
    )
    pictures = _pictures(draws, means)
    return figure("S3HO, Fig. 9", claim, needs, numbers, pictures, len(METHODS), finding)


def _pictures(draws: dict[str, list[Frame]], means: dict[str, dict[str, float]]) -> list[tuple[str, np.ndarray]]:
    """In rows: the filtered picture; the light without textures, unfiltered; a part of that."""
    rows: list[list[tuple[str, np.ndarray]]] = [[], [], []]
    for name, some in draws.items():
        raw = shown(GREY * _light(some[0]))
        filtered = shared_lab().render(some[0].scene, METHODS[name], size=some[0].size).image
        rows[0].append((f"{name}: {means[name]['light']:.2f} of rays' light", overview(filtered)))
        rows[1].append((f"{name}, unfiltered: noise {_noise(some)['light']:.1%}", overview(raw)))
        rows[2].append((f"{name}, unfiltered", closeup(raw, FOUNTAIN)))
    return [picture for row in rows for picture in row]


def _noise(draws: list[Frame]) -> dict[str, float]:
    where = draws[0].mask
    bounces = [_untextured(draw, "indirect") for draw in draws]
    return {"light": noise([_light(draw) for draw in draws], where), "bounce": noise(bounces, where)}


def _over(draws: list[Frame], truth: Frame) -> dict[str, float]:
    """The means of the light and of its bounce over the surfaces, over those of rays."""
    light = np.mean([_light(draw)[truth.mask].mean() for draw in draws]) / _light(truth)[truth.mask].mean()
    bounces = [_untextured(frame, "indirect")[truth.mask].mean() for frame in (*draws, truth)]
    return {"light": float(light), "bounce": float(np.mean(bounces[:-1]) / bounces[-1])}


def _draws(scene: Scene, module: Module, size: Size, seeds: int) -> list[Frame]:
    return [shared_lab().render(scene, module, size=size, seed=seed, filter="none") for seed in range(seeds)]


def _untextured(frame: Frame, buffer: str) -> np.ndarray:
    """(H, W, 3): the light of a buffer as surfaces of albedo 1 would reflect it."""
    return frame[buffer] / np.maximum(frame["albedo"][..., :3], 1e-3)


def _light(frame: Frame) -> np.ndarray:
    return _untextured(frame, "ambient") + _untextured(frame, "indirect")
