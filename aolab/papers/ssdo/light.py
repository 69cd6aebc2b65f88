"""SSDO's figures of light: coloured shadows (3), a bounce that fades (4), the path tracer (13), the radius (14)."""

from dataclasses import replace

import numpy as np

from ...gl.texture import Size
from ...loading import load
from ...modules import SSAO, SSDO, Module, Unoccluded
from ...pictures.sheet import contact_sheet
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.environment import Environment, averaged
from ...scene.lights import DirectionalLight, PointLight
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, chromaticity, rmse, world_positions

SIZE = (640, 360)
PALE, YELLOW = 0.8, Material((0.85, 0.62, 0.06), name="yellow")
RADIUS = 1.0  # scene units: the boxes are 1.05 wide
ACCUMULATE = 4  # frames, so that noise is no part of what is compared
OCCLUSION = SSAO(radius=RADIUS, directions=16, steps=8)
DIRECTIONAL = SSDO(radius=RADIUS, directions=16, steps=8)
BOUNCE = DIRECTIONAL.replace(bounces=1)


def stage(albedo: float = PALE) -> Scene:
    """Two pale boxes and a yellow one on a pale floor, pink light from the left and turquoise from the right.

    As the paper's Fig. 3, 13 and 14: one environment map, and one point light with a shadow map. `albedo`: of all that
    is pale; the yellow box keeps its hue.
    """
    boxes = load("boxes")
    pale = Material((albedo, albedo, albedo), name="pale")
    red, green, blue = YELLOW.base_color
    yellow = Material((red * albedo / PALE, green * albedo / PALE, blue * albedo / PALE), name="yellow")
    *others, right = boxes.instances
    painted = [replace(one, mesh=replace(one.mesh, material=pale)) for one in others]
    painted.append(replace(right, mesh=replace(right.mesh, material=yellow)))
    bulb = PointLight((2.6, 4.2, 4.6), (26.0, 24.0, 21.0))
    return boxes.replace(instances=tuple(painted), lights=(bulb,))


def _drawn(scene: Scene, module: Module, size: Size) -> Frame:
    return shared_lab().render(scene, module, size=size, accumulate=ACCUMULATE)


def fig3(size: Size = SIZE) -> Figure:
    """None, SSAO, SSDO, and one bounce. Numbers: how far a shadow's colour has gone to that of the open side's light.

    0 is the colour that the open floor has, 1 the colour of the light from the open side alone.
    """
    scene = stage()
    modules = {"none": Unoccluded(), "SSAO": OCCLUSION, "SSDO": DIRECTIONAL, "SSDO + 1 bounce": BOUNCE}
    frames = {name: _drawn(scene, module, size) for name, module in modules.items()}
    truth = reference(scene, size=size, like=DIRECTIONAL, rays=64, buffers=("visibility", "ambient", "bent_normal"))
    floor = _floor(frames["none"])
    shaded = floor & (np.abs(truth["visibility"] - 0.65) < 0.25)
    turns = {}
    for name, frame in {**frames, "rays": truth}.items():
        both = [_turn(frame, shaded & (side * truth["bent_normal"][..., 0] > 0.2), scene, side) for side in (-1, 1)]
        turns[name] = dict(zip(("open to the left", "open to the right"), both, strict=True))
    bounced = frames["SSDO + 1 bounce"]["indirect"]
    across = world_positions(frames["none"])[..., 0]
    blue = {  # share of blue light over red, of what comes off the boxes' sides onto the floor
        name: float(np.divide(*bounced[floor & (side * across > 0.5)].sum(axis=0)[[2, 0]]))
        for name, side in (("at the pale box", -1), ("at the yellow box", 1))
    }
    ssao, ssdo, rays = ([*turns[name].values()] for name in ("SSAO", "SSDO", "rays"))
    grey = max(np.abs(ssao)) < 0.05
    matches = all(0.7 < a / b < 1.4 and a > 0.1 for a, b in zip(ssdo, rays, strict=True))
    yellow = blue["at the yellow box"] < 0.5 * blue["at the pale box"]
    claim = (
        "SSDO's shadows turn to the colour of the open side's light, as rays have it, where SSAO's stay grey; "
        "the yellow box throws yellow light on the ground"
    )
    picture = contact_sheet([(name, frame.image) for name, frame in frames.items()], 2, title=f"SSDO, Fig. 3: {claim}.")
    return Figure(
        picture,
        {"turn_to_the_open_sides_colour": turns, "blue_over_red_of_the_bounce": blue},
        claim,
        bool(grey and matches and yellow),
    )


def _floor(frame: Frame) -> np.ndarray:
    """(H, W) bool: the horizontal part of the backdrop of `stage`, pale and facing up, below the boxes' tops."""
    up = frame.world_normal()[..., 1]
    with np.errstate(invalid="ignore"):
        return frame.mask & (up > 0.999) & (np.abs(world_positions(frame)[..., 1]) < 0.02)


def _turn(frame: Frame, where: np.ndarray, scene: Scene, side: int) -> float:
    """The ambient light's colour `where`: 0 is the whole environment's on a floor, 1 its half's on this `side`."""
    assert scene.environment is not None
    radiance, directions, solid_angles = averaged(scene.environment.radiance)
    arriving = radiance * (np.maximum(directions[..., 1], 0) * solid_angles)[..., None]
    whole = chromaticity(arriving.sum(axis=(0, 1)))
    half = chromaticity(arriving[side * directions[..., 0] > 0].sum(axis=0))
    away = chromaticity(frame["ambient"][where].sum(axis=0)) - whole
    return float(away @ (half - whole) / ((half - whole) @ (half - whole)))


# --- figure 4: degrees that the camera has gone around, from before the yellow side to behind it
TOTAL, FRAMES = 105.0, 22


def fig4(size: Size = SIZE, frames: int = FRAMES) -> Figure:
    """Four frames of a camera path around a box: its yellow side, which lights the floor, turns out of the view.

    Numbers: the bounce on one patch of the floor, frame by frame. The path is taken in two step sizes: a jump would
    stay as large when the steps are halved, what is continuous halves with them.
    """
    fine = [_orbit(size, angle) for angle in np.linspace(0, TOTAL, 2 * frames - 1)]
    values = np.array([bounce for _, bounce in fine]) / fine[0][1]
    coarse_step, fine_step = (float(np.abs(np.diff(v)).max()) for v in (values[::2], values))
    chosen = np.linspace(0, 2 * frames - 2, 4).round().astype(int)
    captions = [
        f"{index * TOTAL / (2 * frames - 2):.0f}° around: the bounce is {values[index]:.2f}" for index in chosen
    ]
    pictures = [(caption, fine[index][0].image) for caption, index in zip(captions, chosen, strict=True)]
    pictures += [("4 times the bounce", shown(4 * fine[index][0]["indirect"])) for index in chosen]
    claim = "As its sender turns out of the view, the bounce fades to nothing without a jump"
    numbers = {
        "degrees": np.linspace(0, TOTAL, 2 * frames - 1).tolist(),
        "bounce_of_the_first_frames": values.tolist(),
        "largest_change": coarse_step,
        "largest_change_at_half_the_step": fine_step,
    }
    holds = values[-1] < 0.05 and coarse_step < 0.25 and fine_step < 0.75 * coarse_step
    return Figure(contact_sheet(pictures, 4, title=f"SSDO, Fig. 4: {claim}."), numbers, claim, bool(holds))


def _orbit(size: Size, degrees: float) -> tuple[Frame, float]:
    """The frame from there, and the mean radiance that the patch of floor before the yellow side reflects of it."""
    angle = np.radians(degrees)
    eye = 5.2 * np.sin(angle), 4.4, 0.5 + 5.2 * np.cos(angle)
    camera = Camera(eye, (0, 0.25, 0.3), fov=22)
    yellow = Instance(block((1.6, 0.8, 1.0), YELLOW, "box"), placed(0, -0.01, 0))
    ground = Instance(block((40, 0.2, 40), Material((0.75, 0.75, 0.75)), "ground"), placed(0, -0.2, 0))
    sun = DirectionalLight((-0.35, -0.6, -1.0), (3.0, 2.8, 2.5))
    scene = Scene((ground, yellow), (sun,), Environment.constant((0.12, 0.14, 0.17)), camera)
    frame = shared_lab().render(scene, BOUNCE.replace(radius=0.8, steps=1), size=size)
    x, y, z = np.moveaxis(world_positions(frame), -1, 0)
    patch = frame.mask & (np.abs(x) < 0.5) & (np.abs(y) < 0.02) & (np.abs(z - 0.75) < 0.15)
    return frame, float(frame["indirect"][patch].mean())


# --- figure 13


def fig13(size: Size = SIZE, rays: int = 256) -> Figure:
    """The stage beside its truth: direct and ambient light and one bounce of both, all within the radius.

    Each step takes an error away: RMSE of the radiance, over pixels with a surface. The materials are of a middle grey.
    Among white ones SSAO is *worse* than nothing: what it takes away, the bounce would bring back.
    """
    frames, errors, truth_image = _beside_truth(stage(albedo=0.4), size, rays)
    _, white, _ = _beside_truth(stage(), size, rays)
    claim = "The error against one-bounce rays falls from none to SSAO to SSDO to SSDO with a bounce"
    falls = {
        senders: bool(errors["none"] > errors["SSAO"] > errors["SSDO"] > errors[f"SSDO + 1 bounce of {senders}"])
        for senders in ("patches", "rays")
    }
    pictures = [(f"{name}: RMSE {errors[name]:.4f}", frame.image) for name, frame in frames.items()]
    pictures.append(("rays, one bounce", truth_image))
    holding = " and ".join(name for name, holds in falls.items() if holds) or "neither"
    picture = contact_sheet(pictures, 3, title=f"SSDO, Fig. 13: {claim}. It does with senders as: {holding}.")
    numbers = {"rmse": errors, "falls_with_senders": falls, "rmse_among_white": white, "rays": rays}
    return Figure(picture, numbers, claim, any(falls.values()))


def _beside_truth(scene: Scene, size: Size, rays: int) -> tuple[dict[str, Frame], dict[str, float], np.ndarray]:
    modules = {"none": Unoccluded(), "SSAO": OCCLUSION, "SSDO": DIRECTIONAL}
    modules |= {f"SSDO + 1 bounce of {kind}": BOUNCE.replace(senders=kind) for kind in ("patches", "rays")}
    frames = {name: _drawn(scene, module, size) for name, module in modules.items()}
    radiance = reference(scene, size=size, like=DIRECTIONAL, rays=rays, buffers=("radiance",))["radiance"]
    mask = frames["none"].mask
    return frames, {name: rmse(frame["radiance"], radiance, mask) for name, frame in frames.items()}, shown(radiance)


# --- figure 14
RADII = (0.25, 0.5, 1.0, 2.0)  # scene units


def fig14(size: Size = SIZE) -> Figure:
    """SSDO with one bounce for growing radii. Numbers: the share of the picture that shadows and bounces reach."""
    scene = stage()
    frames = {radius: _drawn(scene, BOUNCE.replace(radius=radius), size) for radius in RADII}
    mask = frames[RADII[0]].mask
    level = 0.02 * float(frames[RADII[0]]["radiance"][mask].mean())  # a fiftieth of the picture's own light
    shadows = [float((frame["visibility"][mask] < 0.95).mean()) for frame in frames.values()]
    bounces = [float((frame["indirect"].mean(axis=-1)[mask] > level).mean()) for frame in frames.values()]
    pictures = [
        (f"radius {radius:g}: shadows on {shadow:.0%}, bounces on {bounce:.0%}", frame.image)
        for (radius, frame), shadow, bounce in zip(frames.items(), shadows, bounces, strict=True)
    ]
    claim = "A smaller radius shrinks the shadows and the reach of the bounce"
    numbers = {"radius": list(RADII), "share_in_shadow": shadows, "share_with_bounce": bounces}
    holds = bool((np.diff(shadows) > 0).all() and (np.diff(bounces) > 0).all())
    return Figure(contact_sheet(pictures, 2, title=f"SSDO, Fig. 14: {claim}."), numbers, claim, holds)
