"""`aolab.bake`: the visibility of every vertex, and of every texel of meshes with UV, by the reference's rays."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from ..errors import ParameterError, notice
from ..loading import load
from ..maths.fading import Fading
from ..modules.base import auto_radius
from ..modules.question import Question
from ..scene.mesh import Material, Mesh, Texture
from ..scene.scene import Instance, Scene
from ..truth.hemisphere import strata
from ..truth.points import Points, Surface
from ..truth.sample import Setting
from ..truth.sky import Sky
from ..truth.tracing import trace
from ..truth.world import World
from .texels import Texels, filled, texels_of

INSET = 0.05  # of a triangle: its corners are looked at from so far inside, where no other surface touches
AROUND = 4  # a vertex has about so many corners of triangles, which share its rays
LEAST_RAYS = 16  # of a corner
NAMES = ("position", "normal", "facet")


class Spots(Surface):
    """Points on triangles with normals of the world, in place of a camera's pixels."""

    def __init__(self, position: np.ndarray, normal: np.ndarray, facet: np.ndarray) -> None:
        self.position, self.normal, self.facet = (one.astype(np.float32) for one in (position, normal, facet))

    def __len__(self) -> int:
        return len(self.position)

    @property
    def albedo(self) -> np.ndarray:
        return np.ones_like(self.position)

    def points(self, where: np.ndarray) -> Points:
        return Points(self.position[where], self.normal[where], self.facet[where])


def bake(
    scene: Any,
    *,
    rays: int = 256,
    radius: float | Literal["auto"] | None = "auto",
    falloff: Fading = 0.3,
    texels: int = 512,
    seed: int = 0,
    progress: bool | None = None,
) -> Scene:
    """The scene with ambient occlusion in its meshes, from the reference's rays.

    `scene` is anything that `aolab.load` takes. Each instance gets a mesh of its own, with `visibility` (V, 1): for
    each vertex, the mean over the corners of its triangles. A mesh with UV that neither leave [0, 1] nor overlap gets
    besides the material's `occlusion_texture` of `texels`² pixels, with the values continued beyond the UV's seams; a
    `Notice` names the meshes whose UV cannot serve.

    `rays`, even, is the number of rays of a vertex or texel. `radius` (scene units) and `falloff` mean the same as in
    `aolab.Question`; auto is the modules' radius for this scene, and None is unlimited.
    Raises `ParameterError`, and what `aolab.load` raises.
    """
    if not isinstance(texels, int) or not 1 <= texels <= 16384:
        raise ParameterError(f"texels = {texels!r} is not a whole number from 1 to 16384")
    next(strata(rays))  # refuses an odd number
    scene = load(scene)
    question = Question(auto_radius(scene) if radius == "auto" else radius, falloff)
    maps = [_map_of(instance.mesh, texels) for instance in scene.instances]
    _name_unusable([instance for instance, one in zip(scene.instances, maps, strict=True) if one is None])
    world = World(scene)
    assert scene.environment is not None  # Scene fills it in

    def visibility(spots: Sequence[Spots], count: int) -> list[np.ndarray]:
        """(n,) for each of `spots`."""
        every = Spots(*(np.concatenate([getattr(one, name) for one in spots]) for name in NAMES))
        setting = Setting(world, Sky(scene.environment), (), question, count)
        found = trace(setting, every, ["visibility"], seed, None, progress)["visibility"][:, 0].clip(0, 1)
        return np.split(found, np.cumsum([len(one) for one in spots])[:-1])

    corner_rays = max(LEAST_RAYS, rays // AROUND // 2 * 2)
    at_corners = visibility([_corners(instance, world) for instance in scene.instances], corner_rays)
    baked = [
        replace(one.mesh, visibility=_by_vertex(one.mesh, found))
        for one, found in zip(scene.instances, at_corners, strict=True)
    ]
    mapped = [(number, one) for number, one in enumerate(maps) if one]
    if mapped:
        in_texels = visibility([_spots(scene.instances[number], world, one) for number, one in mapped], rays)
        for (number, one), found in zip(mapped, in_texels, strict=True):
            material = _with_map(baked[number].material, filled(one, found, texels))
            baked[number] = replace(baked[number], material=material)
    pairs = zip(scene.instances, baked, strict=True)
    return scene.replace(instances=tuple(Instance(mesh, one.world_from_local, one.name) for one, mesh in pairs))


def _corners(instance: Instance, world: World) -> Spots:
    """The corners of all triangles, three each, a little inside of their triangle."""
    count = len(instance.mesh.faces)
    weights = np.full((3, 3), INSET / 2) + np.eye(3) * (1 - 1.5 * INSET)
    corners = Texels(np.zeros(0), np.repeat(np.arange(count), 3), np.tile(weights, (count, 1)))
    return _spots(instance, world, corners)


def _spots(instance: Instance, world: World, at: Texels) -> Spots:
    """Points of triangles in world space, lifted off them on the side of the mesh's normals."""
    mesh = instance.mesh
    faces = mesh.faces[at.triangle]
    corner = instance.placed(mesh.vertices)[faces] - world.centre
    linear = instance.world_from_local[:3, :3]
    assert mesh.normals is not None  # Mesh makes them
    shading = _unit((mesh.normals[faces] * at.weights[..., None]).sum(axis=1) @ np.linalg.inv(linear))
    flat = _unit(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]))
    flat *= np.where((flat * shading).sum(axis=1) < 0, -1, 1)[:, None]
    position = (corner * at.weights[..., None]).sum(axis=1) + flat * world.lift
    return Spots(position, shading, flat)


def _by_vertex(mesh: Mesh, corners: np.ndarray) -> np.ndarray:
    """(V, 1): the mean of each vertex's corners; 1 for a vertex without triangles."""
    vertex = mesh.faces.reshape(-1)
    count = np.bincount(vertex, minlength=len(mesh.vertices))
    total = np.bincount(vertex, weights=corners, minlength=len(mesh.vertices))
    return np.where(count > 0, total / np.maximum(count, 1), 1.0)[:, None].astype(np.float32)


def _map_of(mesh: Mesh, texels: int) -> Texels | None:
    """The texels of a mesh; empty without UV, and None if its UV leave [0, 1] or overlap."""
    if mesh.uv is None:
        return Texels(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros((0, 3)))
    return texels_of(mesh.uv[mesh.faces], texels)


def _name_unusable(instances: Sequence[Instance]) -> None:
    names = sorted({instance.mesh.name for instance in instances})
    if names:
        notice(
            f"{len(names)} meshes have UV that leave [0, 1] or overlap ({', '.join(names[:5])}): "
            "occlusion is baked for their vertices alone"
        )


def _with_map(material: Material, values: np.ndarray) -> Material:
    grey = np.rint(values * 255).astype(np.uint8)
    pixels = np.dstack([grey, grey, grey, np.full_like(grey, 255)])
    return replace(material, occlusion_texture=Texture(pixels, f"{material.name} occlusion", wrap=("clamp", "clamp")))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)
