"""Toasters that hop across the kitchen, and throw their toast: occlusion that changes every frame.

The animated scene of HAO 2009, Fig. 8 and SSDO 2009, Fig. 4: contact shadows come and go, senders leave the view. `time`
is in seconds and the loop closes after `LOOP`; only the transforms change, so that meshes stay on the GPU.
"""

from functools import cache

import numpy as np

from aolab import Camera, DirectionalLight, Environment, Instance, Material, Mesh, Scene
from aolab.shapes import block, circle, in_range, lathe, loft, placed, ring, rounded

LOOP, HOPS = 4.0, 8  # seconds, and hops in them
ENAMEL = ((0.80, 0.22, 0.16), (0.16, 0.52, 0.50), (0.82, 0.58, 0.16), (0.78, 0.74, 0.66), (0.24, 0.36, 0.62))
CHROME, BAKELITE = Material((0.62, 0.63, 0.65), name="chrome"), Material((0.05, 0.05, 0.055), name="bakelite")
CRUST, CRUMB = Material((0.42, 0.20, 0.06), name="crust"), Material((0.80, 0.60, 0.32), name="crumb")
FLOOR = Material((0.66, 0.62, 0.56), name="floor")


def toasters(time: float = 0.62, count: int = 5) -> Scene:
    """`time` in seconds, any; `count` toasters."""
    in_range("toasters", time=(time, -1e6, 1e6), count=(count, 1, 12))
    sun = DirectionalLight((0.55, -1.0, -0.5), (3.6, 3.2, 2.6))
    kitchen = Environment.sky((0.42, 0.50, 0.62), (0.62, 0.62, 0.62), (0.30, 0.26, 0.22))
    instances = [Instance(_floor())]
    for number in range(count):
        instances += _toaster(number, count, time)
    return Scene(tuple(instances), (sun,), kitchen, Camera((1.2, 3.6, 7.2), (0, 0.55, 0), fov=36), name="toasters")


def _toaster(number: int, count: int, time: float) -> list[Instance]:
    """Hops around a ring, in its own rhythm; flat on landing, long in flight. The toast jumps in every fourth hop."""
    beat = HOPS * (time / LOOP + number * 0.37) % HOPS
    flight = np.sin(np.pi * (beat % 1)) ** 2
    # it moves while it is up: a smooth step along its hop, still on the ground
    travel = np.floor(beat) + (beat % 1) - np.sin(2 * np.pi * (beat % 1)) / (2 * np.pi)
    angle = 2 * np.pi * ((travel - HOPS * number * 0.37) / HOPS + number / count)
    stretch = 1 + 0.12 * (2 * flight - 1) * (1 - flight)
    body = placed(2.1 * np.sin(angle), 0.55 * flight, 2.1 * np.cos(angle), turn=np.degrees(angle) + 8 * np.sin(2 * np.pi * beat / HOPS))
    body = body @ placed(0, 0, 0, scale=(1 / np.sqrt(stretch), stretch, 1 / np.sqrt(stretch)))
    jump = max(0.0, np.sin(2 * np.pi * (beat - 0.25) / 4)) ** 3
    parts = [(mesh, place) for mesh, place in _body(ENAMEL[number % len(ENAMEL)])]
    parts += [(_lever(), placed(0.82, 0.38 + 0.30 * min(1, 3 * jump), 0))]
    for side in (-1, 1):
        toast = placed(0, 0.34 + 0.95 * jump, side * 0.17)
        parts += [(_slice(0.085, 1.0, CRUST), toast), (_slice(0.105, 0.9, CRUMB), toast)]
    return [Instance(mesh, body @ place) for mesh, place in parts]
