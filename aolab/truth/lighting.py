"""Lights with ray-traced, hard shadows: the twin of glsl/lib/light.glsl."""

from collections.abc import Iterable

import numpy as np

from ..scene.lights import DirectionalLight, Light, SpotLight
from .world import World


def irradiance(world: World, lights: Iterable[Light], positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(n, 3) float32: the lights' irradiance at lifted `positions` with unit `normals`, both (n, 3)."""
    total = np.zeros_like(positions)
    for light in lights:
        total += received(world, light, positions, normals)[:, None] * color(light)
    return total


def received(world: World, light: Light, positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(n,) float32: the irradiance from `light` as a share of its `color`, 0 in its shadow."""
    towards, distance, share = towards_light(light, positions, world.centre)
    share *= np.maximum((normals * towards).sum(axis=1), 0)
    lit = np.flatnonzero(share > 0)
    if light.shadow and len(lit):
        share[lit[world.occluded(positions[lit], towards[lit], distance[lit])]] = 0
    return share


def color(light: Light) -> np.ndarray:
    """(3,) float32: irradiance of a directional light, else intensity."""
    return np.asarray(light.irradiance if isinstance(light, DirectionalLight) else light.intensity, np.float32)


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
