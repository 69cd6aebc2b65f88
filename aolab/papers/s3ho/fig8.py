"""S3HO, figure 8: close-ups of figure 7, and a row with 8 directions."""

import numpy as np

from ...gl.texture import Size
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ..closeups import closeup, over_background, zoomed
from ..figure import Figure, Need, figure
from ..pixels import chromaticity, noise, world_positions
from .room import BACK, KINDS, RADIUS, SIDE, colour_error, converged, draws, in_shadow, methods, room, traced

# x, y in the picture, and directions: two right angles, and twice the vase
CLOSEUPS = (((0.2, 0.65), 32), ((0.3, 0.25), 32), ((0.57, 0.6), 32), ((0.57, 0.6), 8))
NEAR = 0.1 * RADIUS  # of a crease


def fig8(size: Size = (240, 135), rays: int = 128, seeds: int = 4, frames: int = 8) -> Figure:
    """Close-ups of the room with 32 and with 8 directions.

    Numbers, next to the room's right-angled creases: the colour error, and the distance between the colours of the two
    sides. Bent normals and cones are equal on both sides, so that SSBN gives both sides the light from half-way. With 8
    directions: the noise after the filter, and the change of the colours in shadows from 32 to 8 directions.
    """
    large = zoomed(size)
    truth = traced(large, rays)
    creases, shaded = _creases(truth), in_shadow(truth)
    right = _colours(truth["ambient"], creases)
    errors, apart, few = {}, {"rays": _apart(right)}, {}
    for name, module in methods(32).items():
        many, eight = (converged(module.replace(directions=n), large, frames) for n in (32, 8))
        colours = _colours(many, creases)
        errors[name], apart[name] = float(np.linalg.norm(colours - right, axis=-1).mean()), _apart(colours)
        filtered = noise(draws(module.replace(directions=8), large, seeds), truth.mask)
        few[name] = {"filtered_noise": filtered, "change_of_colour": colour_error(eight, many, shaded)}
    claim = (
        "In right-angled corners SSBN's colours are farther off than S3HO's, and too much alike on both sides; "
        "with 8 directions S3HO is still smooth and keeps its colours, and SSDO is not"
    )
    off = ", ".join(f"{name} {errors[name]:.3f}" for name in sorted(errors, key=lambda name: errors[name]))
    finding = f"In corners, colours are off by: {off}"
    numbers = {
        "colour_error_in_corners": errors,
        "colour_between_the_sides": apart,
        "with_8_directions": few,
        "rays": rays,
    }
    return figure(
        "S3HO, Fig. 8", claim, _needs(errors, apart, few), numbers, _pictures(truth, large), len(errors) + 1, finding
    )


def _needs(errors: dict[str, float], apart: dict[str, float], few: dict[str, dict[str, float]]) -> list[Need]:
    needs = []
    for kind, name in KINDS.items():
        s3ho, ssdo, ssbn = (method + name for method in ("S3HO", "SSDO", "SSBN"))
        needs += [
            Need(f"SSBN's colour error in corners over S3HO's, {kind}", errors[ssbn] / errors[s3ho], above=1.15),
            Need(
                f"S3HO's difference between a corner's sides over rays', {kind}",
                apart[s3ho] / apart["rays"],
                0.85,
                1.15,
            ),
            Need(
                f"SSBN's difference between a corner's sides over rays', {kind}", apart[ssbn] / apart["rays"], below=0.9
            ),
        ]
        for what in ("filtered_noise", "change_of_colour"):
            ratio = few[s3ho][what] / few[ssdo][what]
            needs.append(Need(f"S3HO's {what.replace('_', ' ')} over SSDO's, N = 8, {kind}", ratio, below=0.5))
    return needs


def _pictures(truth: Frame, large: Size) -> list[tuple[str, np.ndarray]]:
    images = {
        n: {name: shared_lab().render(room(), module, size=large).image for name, module in methods(n).items()}
        for n in (32, 8)
    }
    traced_image = over_background(truth["ambient"], truth)
    pictures = []
    for middle, directions in CLOSEUPS:
        pictures.append(("rays", closeup(traced_image, middle)))
        for name, image in images[directions].items():
            pictures.append((f"{name}, N = {directions}", closeup(image, middle)))
    return pictures


def _creases(truth: Frame) -> list[tuple[np.ndarray, np.ndarray]]:
    """The pixels near each crease of floor, back and side: on its one side and on its other, (H, W) bool."""
    x, y, z = np.moveaxis(world_positions(truth), -1, 0)
    planes = [(up, np.abs(distance)) for up, distance in zip((1, 2, 0), (y, z - BACK, x - SIDE), strict=True)]
    normal = truth.world_normal()
    on = [truth.mask & (normal[..., axis] > 0.99) & (distance < 0.01) for axis, distance in planes]
    pairs = ((0, 1), (0, 2), (1, 2))
    return [(on[a] & (planes[b][1] < NEAR), on[b] & (planes[a][1] < NEAR)) for a, b in pairs]


def _colours(ambient: np.ndarray, creases: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """(creases, 2, 3): the chromaticity of the mean light on both sides of each crease."""
    return chromaticity(np.array([[ambient[side].mean(axis=0) for side in crease] for crease in creases]))


def _apart(colours: np.ndarray) -> float:
    """The mean distance of the colours on the two sides of a crease."""
    return float(np.linalg.norm(colours[:, 0] - colours[:, 1], axis=-1).mean())
