"""S3HO's figures of a large scene: SSAO on it (1), and one bounce of S3HO and of SSDO with their noise (9)."""

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules import S3HO, SSAO, SSDO, Module, Unoccluded
from ...pictures.sheet import contact_sheet, gray
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.environment import Environment
from ...scene.lights import DirectionalLight
from ...scene.scene import Scene
from ...truth.picture import shown
from ..figure import Figure, closeup, noise

SIZE = (640, 360)
RADIUS = 0.6  # metres: reaches across the mouldings and the folds of the curtains
SUN = 6.0  # degrees across, as by default in a sky of aolab's own


def _atrium() -> Scene:
    """Lit by its environment alone, into which the sun has moved: the light that the methods are about."""
    scene = load("atrium")
    (sun,) = scene.lights
    assert isinstance(sun, DirectionalLight)
    assert scene.environment is not None
    sharp = np.array(sun.irradiance) / (2 * np.pi * (1 - np.cos(np.radians(SUN / 2))))
    black = (0.0, 0.0, 0.0)
    disc = Environment.sky(
        black, black, black, sun_direction=tuple(-np.array(sun.direction)), sun_radiance=tuple(sharp), sun_angle=SUN
    )
    return scene.replace(lights=(), environment=Environment(scene.environment.radiance + disc.radiance, "sun and sky"))


# --- figure 1


def fig1(size: Size = SIZE) -> Figure:
    """Diffuse lighting alone, SSAO's occlusion factor, and both: what S3HO sets out to mend.

    Numbers: the share of pixels that occlusion darkens, and of those with nothing near; among the darkened, the largest
    difference of the three colours' factors; and how much the factor changes when the sky is turned by half.
    """
    scene = _atrium()
    assert scene.environment is not None
    lab, module = shared_lab(), SSAO(radius=RADIUS, directions=32)
    diffuse, both = (lab.render(scene, one, size=size) for one in (Unoccluded(), module))
    turned = scene.environment.rotated(180)
    factor, other = (
        _factor(*pair) for pair in ((diffuse, both), (lab.relight(f, environment=turned) for f in (diffuse, both)))
    )
    visibility = both["visibility"][both.mask]
    darker = factor.mean(axis=-1) < 0.995
    numbers = {
        "darkened": float(darker.mean()),
        "darkened_with_nothing_near": float(darker[visibility > 0.999].mean()),
        "brightest_factor": float(factor.max()),
        "difference_between_colours": float(np.ptp(factor, axis=-1).max()),
        "change_under_a_turned_sky": float(np.abs(other - factor).max()),
    }
    claim = "Occlusion as a factor only darkens, all colours alike, whatever the light: its shadows are grey and static"
    pictures = [("diffuse", diffuse.image), ("occlusion factor", gray(both["visibility"])), ("both", both.image)]
    grey = max(numbers["difference_between_colours"], numbers["change_under_a_turned_sky"]) < 0.01
    holds = grey and numbers["darkened_with_nothing_near"] == 0 and numbers["brightest_factor"] < 1.001
    return Figure(contact_sheet(pictures, 3, title=f"S3HO, Fig. 1: {claim}."), numbers, claim, holds)


def _factor(diffuse: Frame, both: Frame) -> np.ndarray:
    """(n, 3): by what occlusion multiplies the light of each surface pixel."""
    return both["radiance"][both.mask] / np.maximum(diffuse["radiance"][both.mask], 1e-6)


# --- figure 9
S3HOGI = S3HO(radius=RADIUS, directions=32, steps=2, indirect=True)
BOUNCE = SSDO(radius=RADIUS, directions=32, steps=2, bounces=1)
METHODS: dict[str, Module] = {"S3HO": S3HOGI, "SSDO": BOUNCE, "SSDO, sharp map": BOUNCE.replace(environment_lod=0)}
GREY = 0.5  # the albedo that untextured pictures show
FOUNTAIN = (0.52, 0.62)  # x, y in the picture


def fig9(size: Size = SIZE, seeds: int = 8) -> Figure:
    """The atrium with one bounce, by S3HO and by SSDO, and the diffuse light without textures, before the filter.

    Numbers: the noise, relative, of the environment's light with its bounce, and of the bounce alone; with the sun in
    the environment and with the sky alone. The claim is of the former: SSDO, says the paper, looks the environment up
    in too few directions. In a sky without a sun there is nothing to miss. Most noise is then the bounce's, and S3HO's
    bounce is no smoother than SSDO's.
    """
    scene, lab = _atrium(), shared_lab()
    lights = {"sun and sky": scene, "sky": scene.replace(environment=load("atrium").environment)}
    noises: dict[str, dict[str, dict[str, float]]] = {}
    untextured: dict[str, np.ndarray] = {}
    for light, lit in lights.items():
        noises[light] = {}
        for name, module in METHODS.items():
            draws = [lab.render(lit, module, size=size, seed=seed, filter="none") for seed in range(seeds)]
            bounces = [_untextured(draw, "indirect") for draw in draws]
            both = [_untextured(draw, "ambient") + bounce for draw, bounce in zip(draws, bounces, strict=True)]
            where = draws[0].mask
            noises[light][name] = {"ambient_and_bounce": noise(both, where), "bounce": noise(bounces, where)}
            untextured.setdefault(name, both[0])
    pictures = [(f"{name}, one bounce", lab.render(scene, METHODS[name], size=size).image) for name in ("S3HO", "SSDO")]
    raw = {name: shown(GREY * untextured[name]) for name in ("S3HO", "SSDO")}
    pictures += [
        (f"{name}, unfiltered: noise {noises['sun and sky'][name]['ambient_and_bounce']:.1%}", picture)
        for name, picture in raw.items()
    ]
    pictures += [(f"{name}, unfiltered", closeup(picture, FOUNTAIN, 4)) for name, picture in raw.items()]
    claim = "Lit by an environment with a sun in it, S3HO's light with one bounce has less noise than SSDO's"
    s3ho, ssdo, _ = (one["ambient_and_bounce"] for one in noises["sun and sky"].values())
    picture = contact_sheet(pictures, 2, title=f"S3HO, Fig. 9: {claim}.")
    return Figure(picture, {"noise": noises}, claim, s3ho < 0.5 * ssdo)


def _untextured(frame: Frame, buffer: str) -> np.ndarray:
    """The light of a buffer as surfaces of albedo 1 would reflect it."""
    return frame[buffer] / np.maximum(frame["albedo"][..., :3], 1e-3)
