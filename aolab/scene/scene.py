"""A scene: meshes placed in the world, lights, an environment, a camera. Immutable, so that GPU copies can be kept."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..errors import SceneError, notice
from ..maths.local_maxima import AXES, mean_nearest_distance
from .camera import Camera
from .environment import Environment
from .lights import DirectionalLight, Light
from .mesh import HeightMap, Mesh
from .view import shader_origin

SAMPLED = 1000  # vertices of an instance that decide what is framed
OUTLYING = 1.0  # per cent of the vertices at either end of an axis that may be left out of the frame
GAP = 1000.0  # times farther out than all the others: beside such vertices, the others would fit into a pixel
FAR_OUT = 20.0  # times larger is a scene with them than without: a model on a wide floor is not meant
MAX_EXTENT = 1e15  # scene units; its square still fits float32, which the shaders compute with


@dataclass(frozen=True, eq=False)
class Instance:
    """A mesh placed by `world_from_local` (4, 4), an affine transform. Raises `SceneError` for a singular one."""

    mesh: Mesh
    world_from_local: np.ndarray = field(default_factory=lambda: np.eye(4))
    name: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.mesh, Mesh):
            raise SceneError(f"instance '{self.name}': mesh = {self.mesh!r:.80} is not a Mesh")
        matrix = np.array(self.world_from_local, np.float64)
        what = f"instance '{self.name or self.mesh.name}'"
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise SceneError(f"{what}: its transform is not a finite 4×4 matrix: {matrix.tolist()!s:.200}")
        if not np.allclose(matrix[3], (0, 0, 0, 1)):
            raise SceneError(f"{what}: its transform's last row is {matrix[3].tolist()}, not affine")
        singular = np.linalg.svd(matrix[:3, :3], compute_uv=False)
        if not singular[2] > 1e-9 * singular[0]:
            raise SceneError(f"{what}: its transform is singular (scales {singular.tolist()}); nothing would be left")
        matrix.flags.writeable = False
        object.__setattr__(self, "world_from_local", matrix)

    @property
    def bounds(self) -> np.ndarray:
        """(2, 3) float64: the least and greatest world coordinates."""
        axes_stay = (np.count_nonzero(self.world_from_local[:3, :3], axis=1) == 1).all()
        world = self.placed(self.mesh.bounds if axes_stay else self.mesh.vertices)
        return np.array([world.min(axis=0), world.max(axis=0)])

    def placed(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) of local space in world space, float64."""
        return points.astype(np.float64) @ self.world_from_local[:3, :3].T + self.world_from_local[:3, 3]


def sun_and_sky() -> tuple[Environment, tuple[Light, ...]]:
    """The light of a scene that brings none: a hazy blue sky, and a warm sun from the upper left.

    White in full light has radiance about 1.2: under the filmic curve it is bright and not burnt out.
    """
    sky = Environment.sky(zenith=(0.16, 0.28, 0.50), horizon=(0.46, 0.50, 0.56), ground=(0.20, 0.18, 0.15))
    return sky, (DirectionalLight(direction=(0.7, -1.0, -0.45), irradiance=(3.4, 3.1, 2.6)),)


@dataclass(frozen=True, eq=False)
class Scene:
    """Placed meshes, lights, an environment and a camera.

    A missing camera frames the scene; without lights and environment there is a default sky and sun. `source` is the
    name or file that `aolab.load` was given, if it was one: it makes an image reproducible. Raises `SceneError` for a
    scene that is empty, or too large or too small for its coordinates.
    """

    instances: tuple[Instance, ...]
    lights: tuple[Light, ...] = ()
    environment: Environment | None = None
    camera: Camera | None = None
    name: str = "scene"
    source: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "instances", self._checked_instances())
        object.__setattr__(self, "lights", self._checked_lights())
        if self.environment is not None and not isinstance(self.environment, Environment):
            raise SceneError(
                f"scene '{self.name}': environment = {self.environment!r:.80} is not an Environment; "
                "make one with Environment.constant, .sky, .load or .light_probe"
            )
        if self.camera is not None and not isinstance(self.camera, Camera):
            raise SceneError(f"scene '{self.name}': camera = {self.camera!r:.80} is not a Camera")
        if not self.instances:
            raise SceneError(f"scene '{self.name}' is empty: it holds no mesh")
        if self.environment is None and not self.lights:
            environment, lights = sun_and_sky()
            object.__setattr__(self, "environment", environment)
            object.__setattr__(self, "lights", lights)
        elif self.environment is None:
            object.__setattr__(self, "environment", Environment.constant((0.0, 0.0, 0.0)))
        extent = float(np.abs(self.bounds).max())
        if not extent < MAX_EXTENT:
            raise SceneError(
                f"scene '{self.name}' reaches {extent:.3g} units from the origin; the limit is {MAX_EXTENT:g}"
            )
        if not self.radius > 1e-12 or not self.radius > 1e-9 * extent:
            raise SceneError(
                f"scene '{self.name}' has radius {self.radius:.3g} at {extent:.3g} from the origin: too small for "
                "its coordinates; scale it or move it to the origin"
            )
        if self.camera is None:
            object.__setattr__(self, "camera", Camera.framing(self._framed()))

    def _checked_instances(self) -> tuple[Instance, ...]:
        instances = tuple(self.instances) if isinstance(self.instances, Iterable) else (self.instances,)
        for one in instances:
            if not isinstance(one, Instance):
                raise SceneError(
                    f"scene '{self.name}': {one!r:.80} is not an Instance; write Scene([Instance(mesh, matrix)])"
                )
        return instances

    def _checked_lights(self) -> tuple[Light, ...]:
        lights = tuple(self.lights) if isinstance(self.lights, Iterable) else None
        if lights is None or not all(isinstance(light, Light) for light in lights):
            raise SceneError(
                f"scene '{self.name}': lights = {self.lights!r:.80} is not a sequence of lights: "
                "DirectionalLight, PointLight, SpotLight"
            )
        return lights

    @cached_property
    def bounds(self) -> np.ndarray:
        """(2, 3) float64: the least and greatest world coordinates."""
        bounds = self.instance_bounds
        return np.array([bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)])

    @cached_property
    def meshes(self) -> tuple[Mesh, ...]:
        """The meshes of all instances, each once; a mesh's place is its number in shaders."""
        return tuple(dict.fromkeys(instance.mesh for instance in self.instances))

    @cached_property
    def patterned(self) -> frozenset[Mesh]:
        """The meshes over which the albedo may vary."""
        return frozenset(mesh for mesh in self.meshes if mesh.is_patterned)

    @cached_property
    def plain(self) -> frozenset[Mesh]:
        """The meshes with one albedo."""
        return frozenset(self.meshes) - self.patterned

    @cached_property
    def instance_bounds(self) -> np.ndarray:
        """(instances, 2, 3) float64: the bounds of each."""
        return np.array([instance.bounds for instance in self.instances])

    @cached_property
    def instance_boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """The centres and the halves of the sides of the instances' bounds, (instances, 3) float64 each."""
        low, high = self.instance_bounds.transpose(1, 0, 2)
        return (low + high) / 2, (high - low) / 2

    @cached_property
    def opaque_solids(self) -> dict[Mesh, np.ndarray]:
        """{mesh: its instances' numbers} of solids without holes: from outside, nobody sees their backs."""
        numbers: dict[Mesh, list[int]] = {}
        for number, instance in enumerate(self.instances):
            numbers.setdefault(instance.mesh, []).append(number)
        solids = [mesh for mesh in numbers if not mesh.material.has_holes and mesh.is_solid]
        return {mesh: np.array(numbers[mesh]) for mesh in solids}

    @cached_property
    def main_bounds(self) -> np.ndarray:
        """(2, 3) float64: `bounds`, unless a few vertices lie far outside of all the others: then those of the others.

        Few are `OUTLYING` per cent, or any minority that begins behind a wide `GAP`, as one vertex of a box may.
        """
        sample = np.concatenate([
            instance.placed(instance.mesh.vertices[:: 1 + len(instance.mesh.vertices) // SAMPLED])
            for instance in self.instances
        ])  # fmt: skip
        # not np.median, whose first call imports numpy.ma
        away = np.linalg.norm(sample - np.quantile(sample, 0.5, axis=0), axis=1)
        rising = np.sort(away)
        nearer, next_ones = rising[len(rising) // 2 : -1], rising[len(rising) // 2 + 1 :]
        gaps = np.flatnonzero((nearer > 0) & (next_ones > GAP * nearer))
        if len(gaps):
            inside = sample[away <= nearer[gaps[0]]]
            inner = np.array([inside.min(axis=0), inside.max(axis=0)])
        else:
            inner = np.percentile(sample, (OUTLYING, 100 - OUTLYING), axis=0)
        if not np.linalg.norm(np.ptp(self.bounds, axis=0)) > FAR_OUT * np.linalg.norm(np.ptp(inner, axis=0)):
            return self.bounds
        margin = 0.1 * np.ptp(inner, axis=0)  # of the extent: the outermost vertices are within
        inner = np.clip(inner + np.outer((-1, 1), margin), *self.bounds)
        return inner if np.linalg.norm(np.ptp(inner, axis=0)) > 0 else self.bounds

    def _framed(self) -> np.ndarray:
        """`main_bounds`, with a notice where they are not all."""
        inner = self.main_bounds
        if inner is not self.bounds:
            size = "{:.3g} × {:.3g} × {:.3g}"
            notice(
                f"scene '{self.name}': most of its vertices lie within {size.format(*np.ptp(inner, axis=0))} of its "
                f"{size.format(*np.ptp(self.bounds, axis=0))} units; the camera frames those"
            )
        return inner

    @property
    def centre(self) -> np.ndarray:
        """(3,) float64: the middle of the bounds, world space."""
        return self.bounds.mean(axis=0)

    @cached_property
    def shader_origin(self) -> np.ndarray:
        """(3,) float64: the point of world space that is the origin of the shaders' world; see `view.shader_origin`."""
        return shader_origin(self.bounds)

    @property
    def radius(self) -> float:
        """Half the diagonal of the bounds, in scene units."""
        return float(np.linalg.norm(self.bounds[1] - self.bounds[0])) / 2

    @cached_property
    def sphere_radius(self) -> float:
        """The radius of the bounding sphere around the centre of the bounds, in scene units; at most `radius`."""
        vertices = (instance.placed(instance.mesh.vertices) for instance in self.instances)
        return max(float(np.linalg.norm(world - self.centre, axis=1).max()) for world in vertices)

    @property
    def triangles(self) -> int:
        """How many triangles are drawn, instances counted."""
        return sum(len(instance.mesh.faces) for instance in self.instances)

    @cached_property
    def emits(self) -> bool:
        """Whether a surface sends light by itself."""
        return any(any(instance.mesh.material.emission) for instance in self.instances)

    @cached_property
    def height_maps(self) -> tuple[HeightMap, ...]:
        """The height maps of all materials, each once."""
        maps = (instance.mesh.material.height for instance in self.instances)
        return tuple(dict.fromkeys(one for one in maps if one is not None))

    @cached_property
    def bends_normals(self) -> bool:
        """Whether a normal map or a height map changes the normals of some mesh."""
        return any(instance.mesh.material.bends_normals for instance in self.instances)

    @cached_property
    def is_smooth(self) -> bool:
        """Whether the shading normals of some surface are not those of its triangles."""
        return self.bends_normals or any(mesh.is_smooth for mesh in self.meshes)

    @cached_property
    def feature_distance(self) -> float | None:
        """The mean distance between neighbouring local maxima (`maths.local_maxima`); None if there is only one."""
        points, axes = [], []
        for instance in self.instances:
            local, axis = instance.mesh.local_maxima
            points.append(instance.placed(local))
            axes.append(axis)
        world, along = np.concatenate(points), np.concatenate(axes)
        distances = [mean_nearest_distance(world[along == axis]) for axis in range(len(AXES))]
        known = [distance for distance in distances if distance is not None]
        return float(np.mean(known)) if known else None

    def world_triangles(self) -> np.ndarray:
        """(triangles, 3, 3) float64: every triangle's corners in world space, in the order of the instances."""
        parts = []
        for instance in self.instances:
            parts.append(instance.placed(instance.mesh.vertices)[instance.mesh.faces])
        return np.concatenate(parts)

    def __repr__(self) -> str:
        lights = ", ".join(type(light).__name__ for light in self.lights) or "no lights"
        meshes = len({id(instance.mesh) for instance in self.instances})
        return f"<Scene '{self.name}': {self.triangles} triangles, {meshes} meshes, {lights}, {self.environment!r}>"

    def _repr_html_(self) -> str:
        """A small render, and a table of the meshes."""
        from .. import render  # a render needs the folders above this one; the package's face provides it
        from ..pictures import display

        return display.scene_html(self, render(self, "ssao", size=display.PREVIEW).image)

    def replace(self, **changes: object) -> "Scene":
        """The same scene with other lights, environment, camera, ...; meshes stay where they are on the GPU.

        With other content it is not what `source` names any more, and has none, unless a new one is given.
        """
        if {"instances", "lights", "environment"} & set(changes):
            changes = {"source": None, **changes}
        return replace(self, **changes)  # type: ignore[arg-type]
