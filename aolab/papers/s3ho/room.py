"""The white room of S3HO's figures 7 and 8, its light probe, and the methods that are compared in it."""

from functools import cache

import numpy as np

from ...gl.texture import Size
from ...modules import S3HO, SSBN, SSDO, Module
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.environment import Environment, averaged
from ...scene.mesh import Material, Mesh
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, column, lathe, placed
from ...truth import reference
from ..pixels import chromaticity

RADIUS = 0.6  # scene units: twice a step's height
SHADED = 0.8  # a local shadow has a smaller visibility
COEFFICIENTS = 16  # of S3HO

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


def probe() -> Environment:
    _, directions, solid_angles = averaged(np.zeros((128, 256, 3), np.float32))
    radiance = np.tile(np.array(DIM), (*solid_angles.shape, 1))
    for towards, width, irradiance in LAMPS:
        cosine = directions @ (np.array(towards) / np.linalg.norm(towards))
        lobe = np.exp((cosine - 1) / np.radians(width / 2) ** 2)  # von Mises and Fisher's
        radiance += (lobe / (lobe * solid_angles).sum())[..., None] * np.array(irradiance)
    return Environment(radiance, "lamps")


@cache
def room() -> Scene:
    """White surfaces: three planes that meet at right angles, steps, a column, boxes, a vase."""

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
    return Scene(parts, environment=probe(), camera=Camera((1.6, 2.2, 4.6), (-0.1, 0.55, -0.3), fov=36), name="room")


def methods(directions: int) -> dict[str, Module]:
    """The methods with aolab's defaults, and as printed; with equal samples and the paper's filter.

    By default S3HO and SSDO sum the blocked directions; the papers sum the open ones. By default SSBN weights
    directions by their cosine; the paper's directions are uniform. SSDO's map is blurred to the solid angle of a
    sample, 2π/N. The paper's map was blurred too, but the paper does not state by how much.
    """
    common = {"radius": RADIUS, "directions": directions, "steps": 2, "filter": "bilateral"}
    s3ho, ssdo, ssbn = S3HO(**common), SSDO(**common), SSBN(**common)
    return {
        "S3HO": s3ho,
        "SSDO": ssdo,
        "SSBN": ssbn,
        "S3HO as printed": s3ho.replace(estimator="plain"),
        "SSDO as printed": ssdo.replace(estimator="plain"),
        "SSBN as printed": ssbn.replace(weighting="uniform"),
    }


def variants(directions: int) -> dict[str, Module]:
    """SSDO with its map blurred to 4π/16 sr, the resolution of S3HO's 16 coefficients; and with a sharp map."""
    alike = (4 * np.pi / COEFFICIENTS) / (2 * np.pi / directions)
    ssdo = {name: module for name, module in methods(directions).items() if name.startswith("SSDO")}
    return {
        **{f"{name}, blurred alike": module.replace(environment_lod=alike) for name, module in ssdo.items()},
        **{f"{name}, sharp map": module.replace(environment_lod=0) for name, module in ssdo.items()},
    }


KINDS = {"with the defaults": "", "as printed": " as printed"}  # the end of a method's name, by settings


def traced(size: Size, rays: int) -> Frame:
    return reference(room(), size=size, like=S3HO(radius=RADIUS), rays=rays, buffers=("visibility", "ambient"))


def in_shadow(truth: Frame) -> np.ndarray:
    """(H, W) bool: the pixels in local shadows."""
    with np.errstate(invalid="ignore"):
        return truth.mask & (truth["visibility"] < SHADED)


def draws(module: Module, size: Size, seeds: int) -> list[np.ndarray]:
    """The ambient light (H, W, 3) with each of `seeds` sample sets."""
    return [shared_lab().render(room(), module, size=size, seed=seed)["ambient"] for seed in range(seeds)]


def converged(module: Module, size: Size, frames: int) -> np.ndarray:
    """The ambient light (H, W, 3), a mean of many frames."""
    return shared_lab().render(room(), module, size=size, accumulate=frames)["ambient"]


def colour_error(ambient: np.ndarray, other: np.ndarray, where: np.ndarray) -> float:
    """The mean distance of the chromaticities over the pixels `where`."""
    return float(np.linalg.norm(chromaticity(ambient[where]) - chromaticity(other[where]), axis=-1).mean())
