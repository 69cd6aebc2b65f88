"""Obscurance, ambient transfer and its paths against an integrator that shares no line with the reference.

Own intersection, own directions (uniform over the hemisphere, weighted by 2 cosθ), own paths, all in float64.
"""

import numpy as np
import pytest

import aolab
from aolab.truth import reference

from .rooms import quad, scene, world_positions

RADIUS, BOUNCES = 1.2, 3
SAMPLES = 3000
LIFT = 1e-5  # scene units: the G-buffer's depth may lie below its surface
OPENNESS = {
    "linear": lambda d: np.minimum(d / RADIUS, 1),
    "sqrt": lambda d: np.sqrt(np.minimum(d / RADIUS, 1)),
    "exponential": lambda d: 1 - np.exp(-2.0 * d / RADIUS),
}
COLORS = [(0.8, 0.7, 0.6), (0.9, 0.2, 0.1), (0.1, 0.3, 0.9), (0.5, 0.9, 0.4)]


def corner():
    """A floor, two coloured walls at its back, and a shelf over it."""
    surfaces = [
        quad((0, 0, 0), (0, 0, 1.5), (1.5, 0, 0), material=aolab.Material(COLORS[0])),
        quad((-0.75, 0.6, 0), (0, 0.6, 0), (0, 0, 1.5), material=aolab.Material(COLORS[1])),
        quad((0, 0.6, -0.75), (1.5, 0, 0), (0, 0.6, 0), material=aolab.Material(COLORS[2])),
        quad((0.3, 0.5, -0.3), (0.4, 0.1, 0), (0, 0.05, 0.35), material=aolab.Material(COLORS[3])),
    ]
    camera = aolab.Camera(eye=(0.5, 2.2, 1.6), target=(0, 0.2, -0.2), fov=30)
    return scene(*surfaces, camera=camera)


def cast(triangles, origins, directions):
    """Distance (n,) and triangle (n,) of the nearest hit; infinite and -1 for none."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = ((a * normal).sum(-1) - origins @ normal.T) / (directions @ normal.T)
        at = origins[:, None] + t[..., None] * directions[:, None]
        inside = np.ones(t.shape, bool)
        for start, end in ((a, b), (b, c), (c, a)):
            inside &= (np.cross(end - start, at - start) * normal).sum(-1) >= 0
    t = np.where(inside & (t > 1e-7), t, np.inf)
    nearest = t.argmin(axis=1)
    distance = t[np.arange(len(t)), nearest]
    return distance, np.where(np.isfinite(distance), nearest, -1)


def onto_triangle(position, normal, triangles):
    """`position` (3,), moved to the plane of the nearest parallel triangle: GPUs draw vertices on a grid."""
    a, b, c = triangles.swapaxes(0, 1)
    theirs = np.cross(b - a, c - a)
    theirs /= np.linalg.norm(theirs, axis=1, keepdims=True)
    heights = ((a - position) * theirs).sum(axis=1)
    nearest = np.where(np.abs(theirs @ normal) > 0.99, np.abs(heights), np.inf).argmin()
    return position + heights[nearest] * theirs[nearest]


def hemisphere(normals, random):
    """Uniform directions (n, 3) around `normals` (n, 3): a Gaussian vector, mirrored to the right side."""
    directions = random.normal(size=normals.shape)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return directions * np.sign((directions * normals).sum(axis=1, keepdims=True))


def integrals(position, normal, triangles, albedo, openness, random):
    """O, ∫ (1 - μ) a, and the radiance of paths, at one point; each mean with its standard error."""
    normals, position = np.broadcast_to(normal, (SAMPLES, 3)), position + LIFT * normal
    directions = hemisphere(normals, random)
    weight = 2 * (directions @ normal)
    distance, hit = cast(triangles, np.broadcast_to(position, (SAMPLES, 3)), directions)
    mu = np.where(hit >= 0, openness(distance), 1.0)
    closed = np.where((hit >= 0)[:, None], (1 - mu)[:, None] * albedo[hit], 0.0)
    return (
        weight * mu,
        weight[:, None] * closed,
        weight[:, None]
        * paths(position + distance[:, None] * directions, directions, distance, hit, triangles, albedo, random),
    )


def paths(at, directions, distance, hit, triangles, albedo, random):
    """(n, 3): 1 at the first segment longer than the radius, times the albedos passed; 0 after the last bounce."""
    light = np.ones_like(directions)
    throughput = np.ones_like(directions)
    alive = np.flatnonzero((hit >= 0) & (distance < RADIUS))
    light[alive] = 0
    for _ in range(BOUNCES):
        throughput[alive] *= albedo[hit[alive]]
        a, b, c = np.moveaxis(triangles[hit[alive]], 1, 0)
        normals = np.cross(b - a, c - a)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        normals *= -np.sign((normals * directions[alive]).sum(axis=1, keepdims=True))
        out = hemisphere(normals, random)
        throughput[alive] *= 2 * (out * normals).sum(axis=1, keepdims=True)
        far, what = cast(triangles, at[alive] + LIFT * normals, out)
        open = (what < 0) | (far >= RADIUS)
        light[alive[open]] = throughput[alive[open]]
        kept = ~open
        at[alive[kept]] += far[kept, None] * out[kept]
        directions[alive[kept]], hit[alive[kept]] = out[kept], what[kept]
        alive = alive[kept]
    return light


@pytest.mark.parametrize("measure", OPENNESS)
def test_obscurance_and_transfer(measure):
    room = corner()
    names = ("obscurance", "transfer", "transfer_multibounce")
    frame = reference(
        room, size=(5, 4), rays=512, buffers=names, radius=RADIUS, measure=measure, sigma=2.0, bounces=BOUNCES
    )
    triangles = room.world_triangles().astype(np.float64)
    albedo = np.repeat(COLORS, 2, axis=0)
    random = np.random.default_rng(5)
    normals = (frame["viewNormal"] @ room.camera.view_from_world[:3, :3])[frame.mask].astype(np.float64)
    scores = {name: [] for name in names}
    for number, (position, normal) in enumerate(zip(world_positions(frame), normals, strict=True)):
        position = onto_triangle(position, normal, triangles)
        fuzzy, closed, path = integrals(position, normal, triangles, albedo, OPENNESS[measure], random)
        ratio = fuzzy.mean() / (1 - closed.mean(axis=0))
        # of the ratio to first order: that of O + W C, over 1 - C
        spread = (fuzzy[:, None] + ratio * closed).std(axis=0) / (1 - closed.mean(axis=0))
        expected = {
            "obscurance": (fuzzy.mean(), fuzzy.std()),
            "transfer": (ratio, spread),
            "transfer_multibounce": (path.mean(axis=0), path.std(axis=0)),
        }
        for name, (value, deviation) in expected.items():
            stated = frame[f"{name}_standard_error"][frame.mask][number]
            difference = frame[name][frame.mask][number] - value
            scores[name].append(difference / np.hypot(stated, deviation / np.sqrt(SAMPLES)))
    for name in names:
        assert frame[name][frame.mask].std() > 0.05
        found = np.ravel(scores[name])
        assert np.abs(found).max() < 5, name
        assert np.sqrt((found**2).mean()) < 1.4, name
        assert abs(np.mean(scores[name])) < 4 / np.sqrt(len(scores[name])), name
