"""The lights of a glTF file (KHR_lights_punctual), in units that suit the sky of a scene."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...errors import SceneError
from ...scene.lights import DirectionalLight, Light
from ..parts import Notes, Placed
from ..placing import light_at
from .nodes import Poses
from .schema import Gltf

WIDEST_SPOT = 89.9  # degrees; glTF allows 90, where a shadow map has no projection
# Irradiance that exporters reach only in lux: full sun is 1e5, an office 500, and the unitless lights of games about 3.
# A white surface under it has ten times the radiance of white in the picture.
PHOTOMETRIC = 30.0
SUITED = 3.4  # irradiance of the sun in `scene.sun_and_sky`
SAMPLED = 1000  # points of the scene at which the irradiance is estimated


def lights_of(gltf: Gltf, nodes: Sequence[int], poses: Poses, notes: Notes) -> list[Light]:
    """The lights of `nodes`, in their order; a light's range is a hint for culling and not used."""
    lights = []
    for node in nodes:
        reference = gltf.nodes[node].extensions.light
        if reference is None:
            continue
        light, cone = gltf.extensions.lights.lights[reference.light], None
        if light.type == "spot":
            cone = np.degrees([light.spot.inner_cone_angle, light.spot.outer_cone_angle]).tolist()
            if cone[1] > WIDEST_SPOT:
                text = f" is {cone[1]:g} degrees wide at the half; narrowed to {WIDEST_SPOT}"
                notes.add("the spot of node ", f"'{gltf.node_name(node)}'", text)
                cone = [min(cone[0], WIDEST_SPOT - 0.1), WIDEST_SPOT]
        try:
            color = np.multiply(light.color, light.intensity)
            lights.append(light_at(poses.world[node], color, light.type != "directional", cone))
        except SceneError as error:
            notes.add("light ", f"'{light.name or gltf.node_name(node)}'", f" was left out: {error}")
    return lights


def suited(lights: list[Light], placed: Sequence[Placed], notes: Notes) -> list[Light]:
    """The lights, scaled together where they are photometric.

    glTF's units are lux and candela: daylight is 1e5 times as bright as the skies and skins of pictures, which have
    radiances about 1. Where the lights' irradiance at the scene's points, facing each light, is over `PHOTOMETRIC` (its
    median), all are scaled so that it is `SUITED`; a note states the factor.
    """
    points = _sample(placed)
    total = np.zeros(len(points))
    for light in lights:
        if isinstance(light, DirectionalLight):
            total += max(light.irradiance)
            continue
        distance = np.linalg.norm(points - light.position, axis=1)
        total += max(light.intensity) / np.maximum(distance, 1e-6 * (1 + distance.max(initial=0))) ** 2
    median = float(np.median(total)) if len(total) else 0.0
    if not PHOTOMETRIC < median < np.inf:
        return lights
    factor = SUITED / median
    notes.add(f"its lights are photometric, about {median:.2g} lux at the surfaces: multiplied by {factor:.3g}")
    return [
        replace(light, irradiance=_scaled(light.irradiance, factor))
        if isinstance(light, DirectionalLight)
        else replace(light, intensity=_scaled(light.intensity, factor))
        for light in lights
    ]


def _scaled(color: tuple[float, float, float], factor: float) -> tuple[float, float, float]:
    red, green, blue = color
    return red * factor, green * factor, blue * factor


def _sample(placed: Sequence[Placed]) -> np.ndarray:
    """(n, 3): finite points of the placed parts, in world space."""
    each = max(1, SAMPLED // max(len(placed), 1))
    found = []
    for one in placed[:: 1 + len(placed) // SAMPLED]:
        vertices = np.asarray(one.part.vertices, np.float64)[:: 1 + len(one.part.vertices) // each]
        found.append(vertices @ one.world_from_local[:3, :3].T + one.world_from_local[:3, 3])
    points = np.concatenate(found) if found else np.zeros((0, 3))
    return points[np.isfinite(points).all(axis=1)]
