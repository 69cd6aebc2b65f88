"""Where the nodes of a glTF file stand, at rest or at a time of an animation."""

import numpy as np
from numpy.typing import ArrayLike

from ...errors import FileError, ParameterError, suggestion
from .accessors import Accessors
from .schema import ANIMATED, Animation, AnimationSampler, Gltf

Pose = np.ndarray  # (4, 4) float64
KEYS = {"translation": 3, "rotation": 4, "scale": 3}


def nodes_in_scene(gltf: Gltf) -> list[int]:
    """The nodes of the default scene, parents first, in the file's order; without scenes, of the whole file.

    A node that is not visible, and all below it, is left out (KHR_node_visibility).
    Raises `FileError` unless the file's nodes form trees, as glTF demands.
    """
    parents = np.full(len(gltf.nodes), -1)
    for index, node in enumerate(gltf.nodes):
        for child in node.children:
            if parents[child] >= 0:
                raise FileError(f"its node '{gltf.node_name(child)}' is reached twice: nodes must form a tree")
            parents[child] = index
    roots = gltf.scenes[gltf.scene or 0].nodes if gltf.scenes else np.flatnonzero(parents < 0).tolist()
    found = _walk(gltf, roots, hidden=False)
    if len(_walk(gltf, np.flatnonzero(parents < 0).tolist())) < len(gltf.nodes):
        raise FileError("some of its nodes are their own ancestors: nodes must form a tree")
    return found


def _walk(gltf: Gltf, roots: list[int], hidden: bool = True) -> list[int]:
    """The nodes below the roots, with those that are not visible if they are wanted."""
    found: dict[int, None] = {}
    waiting = list(reversed(roots))
    while waiting:
        index = waiting.pop()
        if index not in found and (hidden or gltf.nodes[index].extensions.visibility.visible):
            found[index] = None
            waiting.extend(reversed(gltf.nodes[index].children))
    return list(found)


class Poses:
    """The pose of every node, and the weights of its morph targets.

    `world` (4, 4) by node: world_from_node, float64, under `root`. `weights` by node, where an animation gives some.
    """

    def __init__(self, gltf: Gltf, root: Pose, moved: dict[int, dict[str, np.ndarray]]) -> None:
        self.weights = {node: keys["weights"] for node, keys in moved.items() if "weights" in keys}
        self.world: dict[int, Pose] = {}
        children = {child for node in gltf.nodes for child in node.children}
        waiting = [(index, root) for index in range(len(gltf.nodes)) if index not in children]
        while waiting:
            index, parent = waiting.pop()
            self.world[index] = parent @ _local(gltf, index, moved.get(index, {}))
            waiting += [(child, self.world[index]) for child in gltf.nodes[index].children]


def _local(gltf: Gltf, index: int, moved: dict[str, np.ndarray]) -> Pose:
    """parent_from_node. An animated key replaces the node's own; a node with a matrix has no other keys."""
    node = gltf.nodes[index]
    if node.matrix is not None and not moved.keys() & KEYS.keys():
        return np.array(node.matrix).reshape(4, 4).T
    return transform(
        moved.get("translation", node.translation), moved.get("rotation", node.rotation), moved.get("scale", node.scale)
    )


def transform(
    translation: ArrayLike | None = None, rotation: ArrayLike | None = None, scale: ArrayLike | None = None
) -> Pose:
    """(4, 4): scaled, rotated by a quaternion (x, y, z, w), moved. A quaternion without length does not rotate."""
    pose = np.eye(4)
    if rotation is not None:
        x, y, z, w = np.asarray(rotation, float) / max(float(np.linalg.norm(np.asarray(rotation, float))), 1e-300)
        if x or y or z or w:
            pose[:3, :3] = [
                (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
                (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
                (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
            ]
    if scale is not None:
        pose[:3, :3] *= np.asarray(scale, float)
    if translation is not None:
        pose[:3, 3] = translation
    return pose


def moved_at(
    gltf: Gltf, accessors: Accessors, time: float | None, animation: str | int | None
) -> dict[int, dict[str, np.ndarray]]:
    """The animated keys of each node at `time` seconds: {node: {"rotation": (4,), ...}}; none where `time` is None.

    Before the first key of a channel and after its last, the pose is that key's. Raises `ParameterError` for a time
    without an animation and for an unknown animation, `FileError` for broken ones.
    """
    if time is None and animation is None:
        return {}
    chosen = _find(gltf, animation)
    moved: dict[int, dict[str, np.ndarray]] = {}
    for channel in chosen.channels:
        path, node = channel.target.path, channel.target.node
        if node is None or path not in ANIMATED:
            continue
        value = _sampled(accessors, chosen.samplers[channel.sampler], path, time or 0.0)
        if value is not None:
            moved.setdefault(node, {})[path] = value
    return moved


def _find(gltf: Gltf, wanted: str | int | None) -> Animation:
    animations = gltf.animations
    if not animations:
        raise ParameterError("time and animation need an animation, and the file has none")
    if wanted is None:
        return animations[0]
    names = [animation.name or str(index) for index, animation in enumerate(animations)]
    if str(wanted) in names:
        return animations[names.index(str(wanted))]
    if str(wanted).isdecimal() and int(wanted) < len(animations):
        return animations[int(wanted)]
    raise ParameterError(f"animation = {wanted!r:.80} is unknown{suggestion(str(wanted), names)}")


def _sampled(accessors: Accessors, sampler: AnimationSampler, path: str, time: float) -> np.ndarray | None:
    """A channel's value at `time`; None for a channel without keys. glTF 2.0, appendix C."""
    times = accessors.floats(sampler.input, "SCALAR").astype(np.float64)
    cubic = sampler.interpolation == "CUBICSPLINE"
    values = accessors.floats(sampler.output).astype(np.float64)
    if not len(times):
        return None
    width = KEYS.get(path) or values.size // (len(times) * (3 if cubic else 1))
    count = len(times) * (3 if cubic else 1)
    if values.size != count * width or not width:
        raise FileError(
            f"accessors[{sampler.output}]: {values.size} numbers are no {len(times)} keys of a {path} "
            f"({sampler.interpolation})"
        )
    if not np.isfinite(values).all() or not np.isfinite(times).all() or (np.diff(times) < 0).any():
        raise FileError(f"accessors[{sampler.input}] and [{sampler.output}] hold no finite keys in the order of time")
    keys = values.reshape(len(times), -1, width)
    after = int(np.searchsorted(times, time, side="right"))
    if after in (0, len(times)) or sampler.interpolation == "STEP":
        return keys[max(after - 1, 0), 1 if cubic else 0]
    before, span = after - 1, times[after] - times[after - 1]
    share = (time - times[before]) / span
    if cubic:
        value = _hermite(keys[before, 1], keys[before, 2] * span, keys[after, 1], keys[after, 0] * span, share)
        return value / max(float(np.linalg.norm(value)), 1e-300) if path == "rotation" else value
    if path == "rotation":
        return _slerp(keys[before, 0], keys[after, 0], share)
    return (1 - share) * keys[before, 0] + share * keys[after, 0]


def _hermite(a: np.ndarray, a_slope: np.ndarray, b: np.ndarray, b_slope: np.ndarray, t: float) -> np.ndarray:
    t2, t3 = t * t, t * t * t
    return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * a_slope + (3 * t2 - 2 * t3) * b + (t3 - t2) * b_slope


def _slerp(a: np.ndarray, b: np.ndarray, t: float) -> np.ndarray:
    """Between two rotations, the shorter way round."""
    a, b = (q / max(float(np.linalg.norm(q)), 1e-300) for q in (a, b))
    cosine = float(a @ b)
    b, cosine = (-b, -cosine) if cosine < 0 else (b, cosine)
    angle = np.arccos(min(cosine, 1.0))
    if angle < 1e-6:  # so close that the chord is the arc, to float64
        return (1 - t) * a + t * b
    return (np.sin((1 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle)
