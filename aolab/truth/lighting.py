"""Lights with ray-traced, hard shadows, and the environment: twins of glsl/lib/light.glsl and environment.glsl."""

from collections.abc import Iterable

import numpy as np

from ..scene.environment import Environment, uv_from_direction
from ..scene.lights import DirectionalLight, Light, SpotLight
from .world import World, bilinear


def irradiance(world: World, lights: Iterable[Light], positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(n, 3) float32: what arrives from the lights at lifted `positions` with unit `normals`, both (n, 3)."""
    total = np.zeros_like(positions)
    for light in lights:
        towards, distance, share = towards_light(light, positions, world.centre)
        share = share * np.maximum((normals * towards).sum(axis=1), 0)
        lit = np.flatnonzero(share > 0)
        if light.shadow and len(lit):
            lit = lit[~world.occluded(positions[lit], towards[lit], distance[lit])]
        color = light.irradiance if isinstance(light, DirectionalLight) else light.intensity
        total[lit] += share[lit, None] * np.asarray(color, np.float32)
    return total


def towards_light(light: Light, positions: np.ndarray, centre: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit directions (n, 3) to the light, distances (n,), and the share (n,) of its colour on a facing surface."""
    if isinstance(light, DirectionalLight):
        towards = -np.asarray(light.direction) / np.linalg.norm(light.direction)
        count = len(positions)
        return (
            np.broadcast_to(towards.astype(np.float32), (count, 3)),
            np.full(count, np.inf, np.float32),
            np.ones(count, np.float32),
        )
    offset = (np.asarray(light.position) - centre).astype(np.float32) - positions
    distance = np.linalg.norm(offset, axis=1)
    towards = offset / np.maximum(distance, 1e-6)[:, None]
    share = 1 / np.maximum(distance**2, 1e-12)
    if isinstance(light, SpotLight):
        inner, outer = np.cos(np.radians([light.inner, light.outer]))
        axis = np.asarray(light.direction, np.float32) / np.linalg.norm(light.direction)
        in_cone = np.clip((-(towards @ axis) - outer) / (inner - outer), 0, 1)
        share = share * in_cone**2
    return towards, distance, share.astype(np.float32)


def environment_radiance(environment: Environment, directions: np.ndarray) -> np.ndarray:
    """(n, 3) float32: the map in world-space `directions` (n, 3), bilinear, as the GPU reads it."""
    if (environment.radiance == environment.radiance[0, 0]).all():  # constant: nothing to look up
        return np.broadcast_to(environment.radiance[0, 0], directions.shape)
    u, v = uv_from_direction(directions).T
    return bilinear(environment.radiance, u, v, repeat_rows=False)
