"""Clip planes that cut nothing away, and the reasons of an empty picture."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..errors import shorten
from ..maths.distances import to_boxes, to_triangles
from .camera import Camera, corners
from .mesh import Mesh
from .scene import Scene
from .view import Size, View

MARGIN = 0.9  # of the distance to the nearest surface
LEAST = 1e-6  # of the far plane's distance: nearer surfaces are cut
MOST_NAMES = 4  # of parts, in a message


def unclipped(camera: Camera, scene: Scene, size: Size) -> Camera:
    """The camera, with a nearer near plane than its own choice where a surface stands before that.

    `Camera.clip_planes` takes a thousandth of the far plane's distance, which leaves the depth buffer its precision: in
    a scene of 20 km it would cut away all within 20 m. A near plane that is given stays, unless there is no surface
    between it and a farther one: at 1e-6 of the far plane's distance, surfaces behind each other would mix.
    """
    if camera.ortho is not None:
        return camera
    free = camera if camera.near is None else replace(camera, near=None)
    near, far = free.clip_planes(scene.bounds)
    if camera.near is not None and camera.near >= near:
        return camera
    own, slant, nearest = camera if camera.near is None else replace(camera, near=near), _slant(camera, size), None
    if _distances(camera, scene.bounds).min() <= near:
        nearest = nearest_surface(scene, np.asarray(camera.eye), near * slant / MARGIN)
    if nearest is None:
        return own
    least = far * LEAST if camera.near is None else camera.near
    return replace(camera, near=max(nearest * MARGIN / slant, least))


def nearest_surface(scene: Scene, point: np.ndarray, limit: float) -> float | None:
    """The distance from `point` (3,) to the nearest triangle of the scene; None if it is over `limit`."""
    centres, halves, owners = [], [], []
    for number in np.flatnonzero(to_boxes(point, *scene.instance_boxes) < limit).tolist():
        instance = scene.instances[number]
        boxes = instance.mesh.chunk_bounds  # (c, 2, 3)
        linear = np.abs(instance.world_from_local[:3, :3])
        centres.append(instance.placed(boxes.mean(axis=1)))
        halves.append((boxes[:, 1] - boxes[:, 0]) / 2 @ linear.T)
        owners += [(number, chunk) for chunk in range(len(boxes))]
    if not owners:
        return None
    lower = to_boxes(point, np.concatenate(centres), np.concatenate(halves))
    best = limit
    for place in np.argsort(lower):
        if lower[place] >= best:
            break
        number, chunk = owners[place]
        instance = scene.instances[number]
        points = instance.placed(instance.mesh.vertices[instance.mesh.chunk(chunk)].reshape(-1, 3)).reshape(-1, 3, 3)
        best = min(best, float(to_triangles(point, points).min()))
    return best if best < limit else None


def reason_of_nothing(scene: Scene, view: View) -> str:
    """Why no surface of the scene is in the picture, as far as the scene's boxes and materials tell."""
    near, far = view.camera.clip_planes(scene.bounds)
    boxes = (
        np.array([corners(bounds) for bounds in scene.instance_bounds]) @ view.camera.view_from_world[:3, :3].T
        + view.camera.view_from_world[:3, 3]
    )  # (i, 8, 3)
    distance = -boxes[..., 2]
    if distance.max() <= 0:
        return "all of the scene lies behind the camera"
    if distance.min() > far:
        return f"all of the scene lies beyond the camera's far plane, far = {far:g}; it begins at {distance.min():.3g}"
    if distance.max() < near:
        return f"all of the scene lies before the camera's near plane, near = {near:g}; it ends at {distance.max():.3g}"
    clip = view.camera.clip_from_view(view.size, scene.bounds)
    projected = np.concatenate([boxes, np.ones((*boxes.shape[:2], 1))], axis=2) @ clip.T
    xyz, w = projected[..., :3], projected[..., 3:]
    outside = np.all(xyz > w, axis=1) | np.all(xyz < -w, axis=1)  # (i, 3): all corners on the outer side of a plane
    seen = [instance for instance, out in zip(scene.instances, np.any(outside, axis=1), strict=True) if not out]
    if not seen:
        return "the camera looks past the scene; Camera.framing(scene.bounds) sees it"
    reasons = [*filter(None, [reason_of_cut(scene, view)]), *dict.fromkeys(_hidden_by_material(seen))]
    return "; ".join(reasons) if reasons else "the surfaces in view are smaller than a pixel, or cut by a clip plane"


def _hidden_by_material(instances: list) -> Iterator[str]:
    for material in (instance.mesh.material for instance in instances):
        if material.alpha_cutoff is not None:
            yield f"material '{material.name}' is cut at alpha {material.alpha_cutoff:g}"
        if material.blend:
            yield f"material '{material.name}' is blended"
        if not material.double_sided:
            yield f"material '{material.name}' is not seen from behind"


def reason_of_cut(scene: Scene, view: View) -> str:
    """The parts of the scene that the camera's clip planes cut out of the picture, as a sentence; "" if there are none.

    Only planes that the camera gives are looked at: its own choice cuts nothing (see `unclipped`), or is told.
    """
    camera, told = view.camera, []
    near, far = camera.clip_planes(scene.bounds)
    in_reach = camera.near is not None and (camera.ortho is not None or _is_near(scene, view))  # quick for most frames
    if in_reach and (names := _parts(scene, view, [(0, 0, 1, near), (0, 0, -1, 0)])):
        told.append(f"the camera's near plane, near = {near:g}, cuts away parts of {', '.join(names)}")
    if camera.far is not None and (names := _parts(scene, view, [(0, 0, -1, -far)])):
        told.append(f"the camera's far plane, far = {far:g}, cuts away parts of {', '.join(names)}")
    return "; ".join(told)


def with_hidden_backs(scene: Scene, view: View) -> list[Mesh]:
    """The meshes whose backs the view cannot see: opaque solids that hold neither its eye nor a part of its near plane.

    A solid's bounds stand for the solid.
    """
    near = view.camera.clip_planes(view.bounds)[0]
    if view.camera.ortho is None:
        centres, halves = scene.instance_boxes
        beyond = to_boxes(np.asarray(view.camera.eye), centres, halves) > near * _slant(view.camera, view.size)
    else:
        beyond = np.array([_distances(view.camera, bounds).min() > near for bounds in scene.instance_bounds])
    return [mesh for mesh, numbers in scene.opaque_solids.items() if beyond[numbers].all()]


def _is_near(scene: Scene, view: View) -> bool:
    """Whether a surface is as near to the eye as the corners of the near plane."""
    assert view.camera.near is not None
    reach = view.camera.near * _slant(view.camera, view.size)
    return nearest_surface(scene, np.asarray(view.camera.eye), reach) is not None


def _slant(camera: Camera, size: Size) -> float:
    """The length of the ray through a corner of the picture, of a perspective camera, at distance 1."""
    return float(np.sqrt(1 + np.square(camera.half_extent(size)).sum()))


def _parts(scene: Scene, view: View, planes: list[tuple[float, float, float, float]]) -> list[str]:
    """The names of instances with a point in the picture's pyramid and on the positive side of all view-space `planes`.

    A plane (x, y, z, w) has the value x p.x + y p.y + z p.z + w at a point p.
    """
    half_x, half_y = view.camera.half_extent(view.size)
    if view.camera.ortho is None:
        sides = [(1, 0, -half_x, 0), (-1, 0, -half_x, 0), (0, 1, -half_y, 0), (0, -1, -half_y, 0)]
    else:
        sides = [(1, 0, 0, half_x), (-1, 0, 0, half_x), (0, 1, 0, half_y), (0, -1, 0, half_y)]
    within = np.array([*planes, *sides], float) @ view.camera.view_from_world  # the planes, in world space
    names = []
    for number in _reached(scene.instance_bounds, within):
        instance = scene.instances[number]
        if _reaches(instance.mesh, within @ instance.world_from_local):
            names.append(f"'{shorten(instance.name or instance.mesh.name)}'")
            if len(names) == MOST_NAMES:
                return [*names[:-1], "others"]
    return names


def _reaches(mesh: Mesh, planes: np.ndarray) -> bool:
    """Has a triangle a point on the positive side of all `planes` (p, 4), of local space?"""

    for number in _reached(mesh.chunk_bounds, planes):
        points = mesh.vertices[mesh.chunk(number)].astype(np.float64)  # (n, 3, 3)
        at_corners = points @ planes[:, :3].T + planes[:, 3]
        if (at_corners > 0).all(axis=2).any():
            return True
        straddling = (at_corners.max(axis=1) > 0).all(axis=1)
        if any(clipped(triangle, planes) for triangle in points[straddling]):
            return True
    return False


def _reached(boxes: np.ndarray, planes: np.ndarray) -> list[int]:
    """The numbers of the boxes (n, 2, 3) that have, of each of the `planes` (p, 4), a point on the positive side."""
    low, high = boxes[:, 0, None], boxes[:, 1, None]  # (n, 1, 3) each
    highest = np.maximum(low * planes[:, :3], high * planes[:, :3]).sum(axis=2) + planes[:, 3]  # (n, p)
    return np.flatnonzero((highest > 0).all(axis=1)).tolist()


def clipped(polygon: np.ndarray, planes: np.ndarray) -> list[np.ndarray]:
    """The part of a convex polygon (n, 3) on the positive side of `planes` (p, 4); Sutherland and Hodgman 1974."""
    points = list(polygon)
    for plane in planes:
        heights = [float(point @ plane[:3] + plane[3]) for point in points]
        kept = []
        for i, point in enumerate(points):
            before, height = heights[i - 1], heights[i]
            if (before > 0) != (height > 0):
                kept.append(points[i - 1] + (point - points[i - 1]) * (before / (before - height)))
            if height > 0:
                kept.append(point)
        points = kept
    return points


def _distances(camera: Camera, bounds: np.ndarray) -> np.ndarray:
    """(8,): of the corners of a box (2, 3) from the camera, along its view."""
    return -(corners(bounds) @ camera.view_from_world[2, :3] + camera.view_from_world[2, 3])
