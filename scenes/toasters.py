"""Toasters that hop through a kitchen and throw their toast: occlusion that changes in every frame.

For HAO 2009, Fig. 8, and SSDO 2009, Fig. 4, which show animated scenes. Lesson: contact shadows appear and disappear,
and senders of bounced light leave the view. `time` is in seconds; the motion repeats after `LOOP` seconds. Only
transforms change with the time, so that meshes stay on the GPU.
"""

from functools import cache

import numpy as np

from aolab import Camera, DirectionalLight, Environment, Instance, Material, Mesh, Scene
from aolab.scene.shapes import block, circle, in_range, lathe, loft, placed, ring, rounded

LOOP, HOPS = 4.0, 8  # seconds, and hops per loop
ENAMEL = ((0.80, 0.22, 0.16), (0.16, 0.52, 0.50), (0.82, 0.58, 0.16), (0.78, 0.74, 0.66), (0.24, 0.36, 0.62))
CHROME, BAKELITE = Material((0.62, 0.63, 0.65), name="chrome"), Material((0.05, 0.05, 0.055), name="bakelite")
CRUST, CRUMB = Material((0.42, 0.20, 0.06), name="crust"), Material((0.80, 0.60, 0.32), name="crumb")
TILES = (Material((0.62, 0.59, 0.53), name="pale tile"), Material((0.20, 0.27, 0.27), name="dark tile"))
WALL = Material((0.62, 0.50, 0.36), name="wall")
DAYLIGHT = Environment.sky((0.34, 0.40, 0.50), (0.40, 0.40, 0.41), (0.20, 0.17, 0.14))


def toasters(time: float = 0.62, count: int = 5) -> Scene:
    """`count` toasters at any `time`, in seconds."""
    in_range("toasters", time=(time, -1e6, 1e6), count=(count, 1, 10))
    sun = DirectionalLight((0.55, -1.0, -0.5), (3.0, 2.5, 1.9))
    instances = [instance for number in range(count) for instance in _toaster(number, count, time)]
    camera = Camera((0.9, 4.1, 7.5), (0, 0.62, 0), fov=34, near=0.1)
    return Scene((*_kitchen(), *instances), (sun,), DAYLIGHT, camera, name="toasters")


def _toaster(number: int, count: int, time: float) -> list[Instance]:
    """A toaster that hops along a circle, with its own phase. It squashes on landing. Every fourth hop throws toast."""
    beat = HOPS * (time / LOOP + 0.37 * number) % HOPS
    share = beat % 1
    flight = np.sin(np.pi * share) ** 2
    travel = np.floor(beat) + share - np.sin(2 * np.pi * share) / (2 * np.pi)  # the speed is 0 on the ground
    angle = 2 * np.pi * (travel / HOPS - 0.37 * number + number / count)
    radius = max(2.1, 1.75 / (2 * np.pi / count - 0.25))  # toasters are 1.56 long, and up to 0.25 rad out of place
    place = placed(radius * np.sin(angle), 0.5 * flight - 0.01, radius * np.cos(angle), turn=np.degrees(angle))
    stretch = 1 - 0.14 * (1 - flight) ** 3
    body = place @ placed(
        0, 0, 0, turn=10 * np.sin(2 * np.pi * beat / HOPS), scale=(stretch**-0.5, stretch, stretch**-0.5)
    )
    jump = max(0.0, np.sin(2 * np.pi * (beat - 0.25) / 4)) ** 3
    parts = [*_body(number % len(ENAMEL)), (_lever(), placed(0.83, 0.36 + 0.32 * min(1.0, 3 * jump), 0))]
    for side in (-1, 1):
        toast = placed(0, 0.24 + 1.0 * jump, side * 0.155)
        parts += [(_slice(0.09, 0.0, CRUST), toast), (_slice(0.11, 0.05, CRUMB), toast)]
    return [Instance(mesh, body @ local) for mesh, local in parts]


@cache
def _body(color: int) -> list[tuple[Mesh, np.ndarray]]:
    """The shell with its opening, the bar that divides the opening into two slots, the skirt, the feet and the dial."""
    outside = [(1.52, 0.80, 0.14), (1.56, 0.84, 0.20), (1.56, 0.84, 0.80)]
    outside += [(1.56 - 0.2 * (1 - np.cos(a)), 0.84 - 0.2 * (1 - np.cos(a)), 0.80 + 0.15 * np.sin(a)) for a in ROUND]
    inside = [(1.16, 0.56, 0.95), (1.14, 0.54, 0.93), (1.14, 0.54, 0.2)]
    rings = [ring(rounded(x, z, 0.2, 32), y) for x, z, y in outside]
    rings += [ring(rounded(x, z, 0.05, 32), y) for x, z, y in inside]
    shell = loft(np.array(rings), Material(ENAMEL[color], name="enamel"), "shell")
    foot = lathe([(0.06, 0), (0.08, 0.02), (0.08, 0.1)], 16, BAKELITE, "foot")
    feet = [(foot, placed(x, 0, z)) for x in (-0.58, 0.58) for z in (-0.26, 0.26)]
    skirt = loft(np.array([ring(rounded(1.46, 0.74, 0.2, 32), y) for y in (0.06, 0.16)]), BAKELITE, "skirt")
    return [
        (shell, np.eye(4)),
        (_bar(), placed(0, 0.19, 0)),
        (skirt, np.eye(4)),
        *feet,
        (_dial(), placed(0.45, 0.4, 0.4)),
    ]


ROUND = np.linspace(0, np.pi / 2, 8)[1:]


@cache
def _bar() -> Mesh:
    return block((1.15, 0.75, 0.06), CHROME, "bar")


@cache
def _dial() -> Mesh:
    """The dial; its axis is z."""
    rings = [ring(circle(24) * radius, y)[:, (0, 2, 1)] for radius, y in ((0.13, 0), (0.13, 0.05), (0.11, 0.07))]
    return loft(np.array(rings), CHROME, "dial")


@cache
def _lever() -> Mesh:
    return block((0.16, 0.07, 0.22), BAKELITE, "lever")


@cache
def _slice(thickness: float, inset: float, material: Material) -> Mesh:
    """A slice of bread standing on y = 0, in the plane z = 0."""
    rings = []
    for z, inner in ((-0.5, 0.02), (-0.3, 0.0), (0.3, 0.0), (0.5, 0.02)):
        x, y = (rounded(1.0, 0.86, 0.24, 32) * (1 - 2 * inset - inner)).T
        rings.append(np.stack([x, y + 0.43, np.full_like(x, z * thickness)], axis=-1))
    return loft(np.array(rings), material, "toast")


@cache
def _kitchen(side: int = 18) -> tuple[Instance, ...]:
    """The floor, tiles with open joints, and the wall at the back."""
    tiles = [block((0.985, 0.1, 0.985), material, "tile") for material in TILES]
    middle = (side - 1) / 2
    floor = [Instance(tiles[(i + j) % 2], placed(i - middle, -0.1, j - middle)) for i, j in np.ndindex(side, side)]
    bed = Instance(block((side, 0.2, side), TILES[0], "bed"), placed(0, -0.23, 0))
    wall = Instance(block((1.5 * side, 5, 0.3), WALL, "wall"), placed(0, -0.2, -middle + 2.5))
    skirting = Instance(block((1.5 * side, 0.35, 0.1), TILES[0], "skirting"), placed(0, -0.01, -middle + 2.69))
    return (*floor, bed, wall, skirting)
