"""S3HO's figures of a white room in a strong light probe: beside rays, SSDO and SSBN (7), and close-ups (8)."""

from functools import cache

import numpy as np

from ...gl.texture import Size
from ...modules import S3HO, SSAO, SSBN, SSDO, Module
from ...pictures.sheet import contact_sheet
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.environment import Environment, averaged
from ...scene.mesh import Material, Mesh
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, column, lathe, placed
from ...truth import reference
from ...truth.picture import shown
from ..figure import Figure, chromaticity, closeup, noise, world_positions

SIZE = (480, 270)
RADIUS = 0.6  # scene units: twice a step's height
SHADED = 0.8  # a visibility below which a pixel counts as in a local shadow

# lamps around the room, as in the nave that the paper's probe shows: towards them, degrees across, irradiance
LAMPS = (
    ((-0.8, 0.45, 0.4), 16, (1.5, 0.55, 0.12)),
    ((0.85, 0.35, 0.35), 20, (0.15, 0.45, 1.5)),
    ((0.1, 0.9, 0.4), 16, (0.9, 0.75, 0.5)),
    ((-0.3, 0.3, 0.9), 14, (0.9, 0.12, 0.3)),
    ((0.5, 0.6, 0.7), 14, (0.2, 0.8, 0.3)),
)
DIM = (0.05, 0.045, 0.04)  # radiance between them

WHITE = Material((0.8, 0.8, 0.8), name="white")
BACK, SIDE = -1.2, -1.85  # z and x of the walls; the floor is y = 0
VASE = ((0.2, 0), (0.24, 0.05), (0.2, 0.1), (0.36, 0.35), (0.4, 0.55), (0.3, 0.75), (0.16, 0.88), (0.14, 0.98),
        (0.22, 1.06), (0.24, 1.08), (0.2, 1.06), (0.1, 0.95))  # fmt: skip


def _probe() -> Environment:
    _, directions, solid_angles = averaged(np.zeros((128, 256, 3), np.float32))
    radiance = np.tile(np.array(DIM), (*solid_angles.shape, 1))
    for towards, width, irradiance in LAMPS:
        cosine = directions @ (np.array(towards) / np.linalg.norm(towards))
        lobe = np.exp((cosine - 1) / np.radians(width / 2) ** 2)  # von Mises and Fisher's
        radiance += (lobe / (lobe * solid_angles).sum())[..., None] * np.array(irradiance)
    return Environment(radiance, "lamps")


@cache
def _room() -> Scene:
    """All white: three planes that meet at right angles, steps, a column, boxes, a vase."""

    def put(mesh: Mesh, x: float, y: float, z: float, turn: float = 0.0) -> Instance:
        return Instance(mesh, placed(x, y, z, turn=turn))

    steps = [put(block((1.4, 0.3 * (k + 1), 0.5), WHITE, "step"), -1.2, -0.01, -0.25 - 0.4 * k) for k in range(3)]
    parts = (
        put(block((9, 0.2, 6), WHITE, "floor"), 0, -0.2, 1),
        put(block((9, 4, 0.3), WHITE, "wall"), 0, -0.1, BACK - 0.15),
        put(block((0.3, 4, 6), WHITE, "wall"), SIDE - 0.15, -0.1, 1),
        *steps,
        put(column(1.9, 0.22, WHITE), 0.1, -0.01, -0.5),
        put(block((0.8, 0.8, 0.8), WHITE, "box"), 1.3, -0.01, -0.5, 25),
        put(block((0.45, 0.45, 0.45), WHITE, "box"), 1.25, 0.78, -0.45, -10),
        put(lathe(VASE, 48, WHITE, "vase"), 0.75, -0.01, 0.55),
    )
    return Scene(parts, environment=_probe(), camera=Camera((1.6, 2.2, 4.6), (-0.1, 0.55, -0.3), fov=36), name="room")


def _modules(directions: int) -> dict[str, Module]:
    """At equal samples and with the paper's filter.

    SSDO's map is blurred to a sample's solid angle, as is its default, or sharp; the paper's was blurred too. SSBN
    counts directions by their cosine, as is its default, or uniformly, as it is in print.
    """
    common = {"radius": RADIUS, "directions": directions, "steps": 2, "filter": "bilateral"}
    ssdo, ssbn = SSDO(**common), SSBN(**common)
    return {
        "S3HO": S3HO(**common),
        "SSDO": ssdo,
        "SSDO, sharp map": ssdo.replace(environment_lod=0),
        "SSBN": ssbn,
        "SSBN, uniform": ssbn.replace(weighting="uniform"),
    }


def _truth(size: Size, rays: int) -> Frame:
    return reference(
        _room(), size=size, like=S3HO(radius=RADIUS), rays=rays, buffers=("visibility", "ambient", "radiance")
    )


def _draws(module: Module, size: Size, seeds: int) -> list[np.ndarray]:
    scene = _room()
    return [shared_lab().render(scene, module, size=size, seed=seed)["ambient"] for seed in range(seeds)]


def _colour_error(ambient: np.ndarray, other: np.ndarray, where: np.ndarray) -> float:
    """The mean distance of chromaticities."""
    return float(np.linalg.norm(chromaticity(ambient[where]) - chromaticity(other[where]), axis=-1).mean())


def _images(size: Size, directions: int) -> dict[str, np.ndarray]:
    return {
        name: shared_lab().render(_room(), module, size=size).image for name, module in _modules(directions).items()
    }


# --- figure 7


def fig7(size: Size = SIZE, rays: int = 1024, seeds: int = 8) -> Figure:
    """The room by rays of the same radius (RTDO), S3HO, SSDO and SSBN, with 32 directions of two points each.

    Numbers: the error of colour in local shadows, of the mean over seeds; and the noise, raw and filtered. SSAO, whose
    shadows have the colours of the open surface, is what the errors compare with. Part of S3HO's calm is aolab's doing:
    it sums what is blocked, without noise where all is open. So noise is also told in the shadows alone.
    """
    truth = _truth(size, rays)
    shaded = truth.mask & (truth["visibility"] < SHADED)
    colours, noises = {}, {}
    for name, module in {"SSAO": SSAO(radius=RADIUS, directions=32, steps=2), **_modules(32)}.items():
        raw = _draws(module.replace(filter="none"), size, seeds)
        colours[name] = _colour_error(np.mean(raw, axis=0), truth["ambient"], shaded)
        noises[name] = {
            "raw": noise(raw, truth.mask),
            "raw_in_shadows": noise(raw, shaded),
            "filtered": noise(_draws(module, size, seeds), truth.mask),
        }
    images = _images(size, 32)
    captions = {
        name: f"{name}: colours off by {colours[name]:.3f}, raw noise {noises[name]['raw']:.1%}" for name in images
    }
    pictures = [("rays", shown(truth["radiance"])), *((captions[name], image) for name, image in images.items())]
    claim = "S3HO's and SSDO's shadows have the colours that rays find; S3HO's have less noise at equal samples"
    right = max(colours["S3HO"], colours["SSDO"]) < 0.7 * colours["SSAO"]
    calm = all(noises["S3HO"][kind] < 0.5 * noises["SSDO"][kind] for kind in noises["S3HO"])
    numbers = {"colour_error_in_shadows": colours, "noise": noises, "rays": rays}
    return Figure(contact_sheet(pictures, 3, title=f"S3HO, Fig. 7: {claim}."), numbers, claim, bool(right and calm))


# --- figure 8
CLOSEUPS = ((0.2, 0.65), (0.3, 0.25), (0.57, 0.6))  # x, y in the picture: two right angles, and the vase
NEAR = 0.1 * RADIUS  # of a crease


def fig8(size: Size = SIZE, rays: int = 1024, seeds: int = 8) -> Figure:
    """Close-ups of figure 7, and a row with 8 directions.

    Numbers: next to the room's creases, the error of colour, and how far apart the colours of the two sides are: at a
    right angle bent normals and cones are the same on both, and SSBN gives both the light from half-way. With 8
    directions: the noise after the filter, and how much colours in shadows change from 32 directions to 8.
    """
    truth = _truth(size, rays)
    shaded = truth.mask & (truth["visibility"] < SHADED)
    creases = _creases(truth)
    right = _colours(truth["ambient"], creases)
    errors, apart, few = {}, {"rays": _apart(right)}, {}
    for name, module in _modules(32).items():
        many = np.mean(_draws(module, size, seeds), axis=0)
        eight = _draws(module.replace(directions=8), size, seeds)
        colours = _colours(many, creases)
        errors[name], apart[name] = float(np.linalg.norm(colours - right, axis=-1).mean()), _apart(colours)
        few[name] = {
            "filtered_noise": noise(eight, truth.mask),
            "change_of_colour": _colour_error(np.mean(eight, axis=0), many, shaded),
        }
    pictures = []
    for middle, directions in ((CLOSEUPS[0], 32), (CLOSEUPS[1], 32), (CLOSEUPS[2], 32), (CLOSEUPS[2], 8)):
        for name, image in {"rays": shown(truth["radiance"]), **_images(size, directions)}.items():
            caption = name if name == "rays" else f"{name}, N = {directions}"
            pictures.append((caption, closeup(image, middle, 3)))
    claim = (
        "In right-angled corners SSBN's colours are farther off than S3HO's, and too much alike on both sides; "
        "with 8 directions S3HO is still smooth and keeps its colours, and SSDO is not"
    )
    alike = all(
        errors[name] > 1.2 * errors["S3HO"] and apart[name] < 0.9 * min(apart["rays"], apart["S3HO"])
        for name in ("SSBN", "SSBN, uniform")
    )
    smooth = few["S3HO"]["filtered_noise"] < 0.5 * few["SSDO"]["filtered_noise"]
    keeps = few["S3HO"]["change_of_colour"] < 0.5 * few["SSDO"]["change_of_colour"]
    numbers = {
        "colour_error_in_corners": errors,
        "colour_between_the_sides": apart,
        "with_8_directions": few,
        "rays": rays,
    }
    picture = contact_sheet(pictures, 6, title=f"S3HO, Fig. 8: {claim}.")
    return Figure(picture, numbers, claim, bool(alike and smooth and keeps))


def _creases(truth: Frame) -> list[tuple[np.ndarray, np.ndarray]]:
    """Where two of floor, back and side meet: the pixels of the one, and of the other, that are near, (H, W) bool."""
    x, y, z = np.moveaxis(world_positions(truth), -1, 0)
    planes = [(up, np.abs(distance)) for up, distance in zip((1, 2, 0), (y, z - BACK, x - SIDE), strict=True)]
    normal = truth.world_normal()
    on = [truth.mask & (normal[..., axis] > 0.99) & (distance < 0.01) for axis, distance in planes]
    pairs = ((0, 1), (0, 2), (1, 2))
    return [(on[a] & (planes[b][1] < NEAR), on[b] & (planes[a][1] < NEAR)) for a, b in pairs]


def _colours(ambient: np.ndarray, creases: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """(creases, 2, 3): the chromaticity of the mean light on both sides of each."""
    return chromaticity(np.array([[ambient[side].mean(axis=0) for side in crease] for crease in creases]))


def _apart(colours: np.ndarray) -> float:
    """The mean distance of the colours on the two sides of a crease."""
    return float(np.linalg.norm(colours[:, 0] - colours[:, 1], axis=-1).mean())
