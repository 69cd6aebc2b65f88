"""S3HO, figure 6: towers in the sun, by S3HO and by SSAO."""

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...maths.harmonics import hanning, light_lobe, zonal_lobe
from ...modules import S3HO
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.lights import DirectionalLight
from ...scene.scene import Scene
from ...truth import reference
from ...truth.picture import shown
from ..closeups import closeup, over_background, overview, zoomed
from ..figure import Figure, Need, figure
from ..pixels import LUMINANCE
from .local import HARMONICS, drawn, without_shadow_maps

CITY = Camera((1.4, 11.0, 9.0), (0.2, 0, 0.2), fov=30)  # from above, so that both sides of streets are seen
TOWERS = S3HO(radius=0.8, directions=32, steps=16)  # scene units: as wide as a street
OPEN = 1e-6  # scene units: a radius without any occluder
HALF_OPEN = (0.3, 0.8)  # the visibilities of a local shadow
CLOSEUPS = {"away from the sun": (0.73, 0.55), "towards the sun": (0.4, 0.5)}  # their middles, x, y, in pictures


def fig6(size: Size = (320, 180), rays: int = 128) -> Figure:
    """Towers under a blue sky with a yellow sun, by S3HO, by SSAO, and by S3HO with the coefficients that rays find.

    As in the paper, SSAO's factor multiplies all diffuse light, the sun's included. SSAO and S3HO use the same
    estimate, and so the same samples and filter. Numbers: luminance, and the ratio of blue to red, on horizontal
    surfaces in local shadows: on those that are open away from the sun, and on those that are open towards the sun.
    """
    scene, large = without_shadow_maps(load("skyscrapers")).replace(camera=CITY), zoomed(size)
    frame, open_ = (
        drawn(scene, TOWERS.replace(radius=radius), large, accumulate=4) for radius in (TOWERS.radius, OPEN)
    )
    truth = reference(scene, size=large, like=TOWERS, rays=rays, buffers=("visibility", *HARMONICS))
    factor = open_["radiance"] * np.where(frame.mask, frame["visibility"], 1)[..., None]
    radiance = {"S3HO": frame["radiance"], "SSAO": factor, "rays": _lit(truth)}
    numbers = {side: _light(where, radiance) for side, where in _sides(truth).items()}
    needs = []
    for side, found in numbers.items():
        for what in ("luminance", "blue_over_red"):
            over = found[what]["S3HO"] / found[what]["rays"]
            needs.append(Need(f"{what.replace('_', ' ')} {side}, S3HO's over rays'", over, 0.85, 1.15))
    away, towards = (found["luminance"]["S3HO"] / found["luminance"]["SSAO"] for found in numbers.values())
    bluer = numbers["away from the sun"]["blue_over_red"]
    needs += [
        Need("luminance away from the sun, S3HO's over SSAO's", away, below=0.75),
        Need("blue over red away from the sun, S3HO's over SSAO's", bluer["S3HO"] / bluer["SSAO"], above=1.4),
        Need("luminance towards the sun, S3HO's over SSAO's", towards, above=1.2),
    ]
    images = {
        "S3HO": frame.image,
        "SSAO": shown(factor),
        "rays' coefficients": over_background(radiance["rays"], truth),
    }
    claim = (
        "Local shadows that are open away from the sun are darker and bluer than SSAO's, those towards it are lighter"
    )
    pictures = [(name, overview(image)) for name, image in images.items()]
    for side, middle in CLOSEUPS.items():
        pictures += [(f"{name}, {side}", closeup(image, middle)) for name, image in images.items()]
    return figure("S3HO, Fig. 6", claim, needs, {**numbers, "rays": rays}, pictures, 3)


def _lit(truth: Frame) -> np.ndarray:
    """(H, W, 3): S3HO's radiance from the truth's coefficients; the twin of s3ho.ambient.glsl and s3ho.direct.glsl."""
    assert truth.scene is not None  # the reference has one
    assert truth.scene.environment is not None  # Scene fills it in
    transfer = np.concatenate([truth[name] for name in HARMONICS], axis=-1)
    sun = _sun(truth.scene)
    towards = -np.array(sun.direction) / np.linalg.norm(sun.direction)
    lobe = zonal_lobe(light_lobe(hanning(TOWERS.light_window)), towards)
    irradiance = np.maximum(transfer @ truth.scene.environment.radiance_sh, 0)
    irradiance += np.maximum(transfer @ lobe, 0)[..., None] * np.array(sun.irradiance)
    return (truth["albedo"][..., :3] / np.pi * irradiance).astype(np.float32)


def _light(where: np.ndarray, radiance: dict[str, np.ndarray]) -> dict[str, dict[str, float]]:
    """Luminance and colour of the mean radiance `where`, by method."""
    light = {name: value[where].mean(axis=0) for name, value in radiance.items()}
    return {
        "luminance": {name: float(rgb @ LUMINANCE) for name, rgb in light.items()},
        "blue_over_red": {name: float(rgb[2] / rgb[0]) for name, rgb in light.items()},
    }


def _sides(truth: Frame) -> dict[str, np.ndarray]:
    """(H, W) bool: horizontal surfaces in local shadows whose mean open direction leans from the sun, or towards it."""
    assert truth.scene is not None  # the reference has one
    x, _, z = _sun(truth.scene).direction
    first = truth["sh0"]  # band 1 is the mean direction: see `aolab.maths.harmonics` for its order and signs
    across, up, along = -first[..., 3], -first[..., 1], first[..., 2]
    leaning = -(across * x + along * z) / np.hypot(x, z) / np.maximum(np.hypot(up, np.hypot(across, along)), 1e-6)
    with np.errstate(invalid="ignore"):
        shaded = (truth["visibility"] > HALF_OPEN[0]) & (truth["visibility"] < HALF_OPEN[1])
    flat = truth.mask & (truth.world_normal()[..., 1] > 0.99) & shaded
    return {"away from the sun": flat & (leaning < -0.2), "towards the sun": flat & (leaning > 0.2)}


def _sun(scene: Scene) -> DirectionalLight:
    (sun,) = scene.lights
    assert isinstance(sun, DirectionalLight)
    return sun
