"""From the parts that a reader found to a scene: a part that cannot be drawn is left out, and told."""

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import Notice, SceneError, notice, shorten
from ..scene.camera import Camera
from ..scene.environment import Environment
from ..scene.lights import MAX_SHADOW_TILES, Light, shadow_tiles
from ..scene.mesh import Material, Mesh
from ..scene.scene import MAX_EXTENT, Instance, Scene

TOLD = 3  # names of a note; the rest is counted
# A mesh whose centre is farther from its origin than this many half diagonals is moved there. Below, the 24 bits of
# float32 move its vertices by less than 1e-5 of the half diagonal.
FAR = 100.0


class Notes:
    """The repairs, the parts left out and the properties not used by a reader, collected into few notices."""

    def __init__(self) -> None:
        self._kinds: dict[tuple[str, str, str], list[str]] = {}

    def add(self, before: str, item: str = "", after: str = "", separator: str = ", ") -> None:
        """A note, `before` + `item` + `after`. Notes that differ in their items become one, which lists the first."""
        self._kinds.setdefault((before, after, separator), []).append(item)

    @contextmanager
    def collecting(self) -> Iterator[None]:
        """The notices that are raised within become notes."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            yield
        for one in caught:
            if issubclass(one.category, Notice):
                self.add("", str(one.message), separator="; ")
            else:
                warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)

    def texts(self) -> list[str]:
        """One text a kind."""
        texts = []
        for (before, after, separator), items in self._kinds.items():
            items = list(dict.fromkeys(items))
            more = f"{separator}and {len(items) - TOLD} more" if len(items) > TOLD else ""
            texts.append(f"{before}{separator.join(items[:TOLD])}{more}{after}")
        return texts

    def emit(self, source: str | None) -> None:
        """A `Notice` for each kind, with the `source` before it, if there is one."""
        for text in self.texts():
            notice(f"{source}: {text}" if source else text)
        self._kinds.clear()


@dataclass(eq=False)
class Part:
    """Triangles as a source gives them, unchecked: the arguments of `Mesh`."""

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray | None = None
    uv: np.ndarray | None = None
    colors: np.ndarray | None = None
    material: Material = field(default_factory=Material)
    name: str = "mesh"
    tangents: np.ndarray | None = None
    visibility: np.ndarray | None = None


@dataclass(frozen=True)
class Placed:
    """A part where it stands: `world_from_local` (4, 4). A part that is placed twice becomes one mesh."""

    part: Part
    world_from_local: np.ndarray
    name: str


@dataclass
class Content:
    """All that a reader found in a source."""

    placed: list[Placed] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    camera: Camera | None = None
    environment: Environment | None = None
    left_out: list[str] = field(default_factory=list)  # parts that the reader could not make, each a sentence
    notes: Notes = field(default_factory=Notes)


def scene_of(content: Content, name: str = "scene", source: str | None = None, shadows: int | None = None) -> Scene:
    """The scene of the parts that can be drawn. `shadows`: how many lights cast shadows at most.

    Notices are raised, each with the `source` before it. Raises `SceneError` where nothing is left. A source with
    lights and no environment gets a sky, so that ambient light has a source too.
    """
    notes, instances, left_out = content.notes, [], list(content.left_out)
    meshes: dict[Part, tuple[Mesh, np.ndarray] | None] = {}
    for placed in content.placed:
        try:
            if placed.part not in meshes:
                meshes[placed.part] = None
                with notes.collecting():
                    meshes[placed.part] = _mesh(placed.part, notes)
            made = meshes[placed.part]
            if made is not None:
                instances.append(_instance(*made, placed))
        except SceneError as error:
            left_out.append(str(error))
    if not instances:
        raise SceneError(_nothing(left_out, notes))
    for reason in left_out:
        notes.add("left out: ", reason, separator="; ")
    lights = _with_shadows(content.lights, shadows, notes)
    environment = content.environment or (Environment.sky() if lights else None)
    with notes.collecting():
        scene = Scene(tuple(instances), tuple(lights), environment, content.camera, name, source)
    notes.emit(source)
    return scene


def _nothing(reasons: Sequence[str], notes: Notes) -> str:
    if not reasons:
        return "; ".join(["no triangles: it holds no geometry", *notes.texts()])
    more = f"; and {len(reasons) - TOLD} more" if len(reasons) > TOLD else ""
    return f"nothing can be drawn: {'; '.join(reasons[:TOLD])}{more}"


def _mesh(part: Part, notes: Notes) -> tuple[Mesh, np.ndarray]:
    """The part's mesh, of the vertices that triangles use, and where its origin is in the part's own coordinates."""
    name = shorten(part.name)
    vertices, faces = np.asarray(part.vertices), np.asarray(part.faces, np.int64)
    if vertices.ndim != 2 or vertices.shape[1:] != (3,) or not faces.size:
        raise SceneError(f"mesh '{name}' is empty: {len(vertices)} vertices, {len(faces)} triangles")
    if faces.min() < 0 or faces.max() >= len(vertices):
        wrong = np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))[0]
        raise SceneError(
            f"mesh '{name}': triangle {wrong} has indices {faces[wrong].tolist()}, "
            f"but there are {len(vertices)} vertices"
        )
    faces = _finite(vertices, faces, name, notes)
    arrays = {
        "normals": part.normals,
        "uv": part.uv,
        "colors": part.colors,
        "tangents": part.tangents,
        "visibility": part.visibility,
    }
    arrays = {key: _usable(key, array, len(vertices), name, notes) for key, array in arrays.items()}
    used = np.zeros(len(vertices), bool)
    used[faces] = True
    if not used.all():
        number = np.cumsum(used) - 1
        faces, vertices = number[faces], vertices[used]
        arrays = {key: None if array is None else array[used] for key, array in arrays.items()}
    offset = np.zeros(3)
    with np.errstate(invalid="ignore", over="ignore"):  # not finite: `Mesh` refuses it
        low, high = vertices.min(axis=0).astype(np.float64), vertices.max(axis=0).astype(np.float64)
        centre = (low + high) / 2
        if np.linalg.norm(centre) > FAR * np.linalg.norm(high - low) / 2 and np.isfinite(centre).all():
            offset, vertices = centre, (vertices - centre).astype(np.float32)
    normals, uv, colors, tangents, visibility = arrays.values()
    mesh = Mesh(vertices, faces, normals, uv, colors, part.material, name, tangents=tangents, visibility=visibility)
    return mesh, offset


def _finite(vertices: np.ndarray, faces: np.ndarray, mesh: str, notes: Notes) -> np.ndarray:
    """The triangles whose vertices are finite; all of them if there are none, which `Mesh` refuses."""
    finite = np.asarray(np.isfinite(vertices).all(axis=1))
    if finite.all():
        return faces
    kept = np.asarray(finite[faces].all(axis=1))
    if not kept.any():
        return faces
    lost = f"{len(kept) - kept.sum()} of {len(kept)} triangles of mesh '{mesh}', whose vertices are not finite"
    notes.add("left out: ", lost, separator="; ")
    return faces[kept]


def _usable(key: str, array: np.ndarray | None, count: int, mesh: str, notes: Notes) -> np.ndarray | None:
    """An attribute of the vertices; None, with a note, for one that cannot be used.

    Normals that are not finite become 0, of which `Mesh` makes new ones; colours are clipped to [0, 1].
    """
    if array is None:
        return None
    array = np.asarray(array)
    if len(array) != count:
        notes.add("left out: ", f"{len(array)} {key} for the {count} vertices of mesh '{mesh}'", separator="; ")
        return None
    finite = np.asarray(np.isfinite(array).reshape(count, -1).all(axis=1))
    if not finite.all() and key == "normals":
        array = np.where(finite[:, None], array, 0)
    elif not finite.all():
        notes.add(
            "left out: ", f"{key} of mesh '{mesh}', of which {count - finite.sum()} are not finite", separator="; "
        )
        return None
    if key == "colors" and array.ndim == 2 and not 0 <= array.min() <= array.max() <= 1:
        notes.add("the colours of mesh ", f"'{mesh}'", " are outside [0, 1], and were clipped")
        return array.clip(0, 1)
    return array


def _instance(mesh: Mesh, offset: np.ndarray, placed: Placed) -> Instance:
    matrix = np.array(placed.world_from_local, np.float64)
    matrix[:3, 3] += matrix[:3, :3] @ offset
    instance = Instance(mesh, matrix, shorten(placed.name))
    extent = float(np.abs(instance.placed(mesh.bounds)).max())
    if not extent < MAX_EXTENT:
        raise SceneError(
            f"instance '{instance.name}' reaches {extent:.3g} units from the origin; the limit is {MAX_EXTENT:g}"
        )
    return instance


def _with_shadows(lights: list[Light], most: int | None, notes: Notes) -> list[Light]:
    """The lights, of which only the first `most` cast shadows, and as many as shadow maps can hold."""
    kept, tiles, without = [], 0, 0
    for number, light in enumerate(lights):
        needed = shadow_tiles(light)
        shadow = light.shadow and tiles + needed <= MAX_SHADOW_TILES and (most is None or number < most)
        tiles += needed if shadow else 0
        if light.shadow and not shadow and (most is None or number < most):
            without += 1
        kept.append(replace(light, shadow=shadow))
    if without:
        notes.add(
            f"{without} of its {len(lights)} lights cast no shadow: shadow maps hold {MAX_SHADOW_TILES} tiles, and a "
            "point light takes six"
        )
    return kept
