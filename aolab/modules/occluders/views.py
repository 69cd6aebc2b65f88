"""Occluders: the camera's depth, and the depths of further cameras."""

from dataclasses import replace

import numpy as np

from ...gl.bindings import Bindings
from ...scene.camera import Camera
from ...scene.scene import Scene
from ...scene.view import View, matrix_bytes
from ..parameters import parameter
from .base import Drawing, Hidden, OccluderKind, Occluders, Textures
from .layers import DEPTHS, G_BUFFER, MOST, packed
from .open_meshes import name_open_meshes

# to the right, to the left, above, and from the other side: in the camera's own axes (x right, y up, -z forward)
DISPLACEMENTS = ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.6, -0.8))


class Views(OccluderKind):
    """The surfaces of `views` further cameras, at `view_scale` of the resolution, each with `view_layers` layers.

    The pictures of all views are tiles of one atlas for each quantity, two in a row.
    """

    name = "views"
    shader = "occluders/views.glsl"
    uniforms = ("tile_from_ray", "tile_half", "view_pixel_width", "view_from_camera", "camera_from_view")

    views: int = parameter(4, "Cameras beside the camera.", ge=1, le=len(DISPLACEMENTS))
    view_scale: float = parameter(0.5, "Resolution of the further views, as a share of the image's.", ge=0.125, le=1)
    view_layers: int = parameter(1, "Peeled layers of each further view.", ge=1, le=MOST)

    def draw(self, drawing: Drawing, view: View, surfaces: Textures, sends: bool) -> Occluders:
        if self.view_layers > 1:
            name_open_meshes(drawing.scene)
        cameras = further_cameras(view.camera, drawing.scene)[: self.views]
        tiles = self._tiles(cameras, view)
        seen = drawing.surfaces(tiles, "views", G_BUFFER if sends else DEPTHS)
        textures = {"viewsZ": seen["viewZ"]}
        if self.view_layers > 1:
            behind = drawing.peeled(seen["viewZ"], self.view_layers - 1, tiles, DEPTHS)
            textures["viewsZ"] = packed(drawing, seen["viewZ"], behind)["layersZ"]
        if sends:
            textures |= {"viewsNormal": seen["viewNormal"], "viewsSender": seen["albedo"]}
        # a surface that a further view sees is tested against that view's own depth: other views need a change of space
        own = Bindings("the depth of a further view", includes={"occluders.glsl": "occluders/tile.glsl"})
        hidden = [Hidden("viewsSender", seen, tiles, own)] if sends else []
        return Occluders(self.bindings(textures, _uniforms(tiles, view)), hidden)

    def _tiles(self, cameras: list[Camera], view: View) -> list[View]:
        """The further views, two in a row of an atlas."""
        width, height = view.scaled(self.view_scale).size
        columns, rows = min(2, len(cameras)), (len(cameras) + 1) // 2
        atlas = columns * width, rows * height
        origins = [(number % 2 * width, number // 2 * height) for number in range(len(cameras))]
        pairs = zip(cameras, origins, strict=True)
        return [View(camera, (width, height), view.bounds, origin, atlas) for camera, origin in pairs]


def _uniforms(tiles: list[View], view: View) -> dict[str, object]:
    """The way from the camera's view space to the tiles of the atlas, and back."""
    there_from_here = [tile.camera.view_from_world @ np.linalg.inv(view.camera.view_from_world) for tile in tiles]
    tan_x, tan_y = tiles[0].camera.half_extent(tiles[0].size)
    half = np.array(tiles[0].size) / 2
    return {
        "tile_from_ray": (1 / tan_x, 1 / tan_y, 0.0, 0.0),
        "tile_half": tuple(half / tiles[0].sheet),
        "view_pixel_width": tan_x / half[0],
        "view_from_camera": b"".join(matrix_bytes(matrix) for matrix in there_from_here),
        "camera_from_view": b"".join(matrix_bytes(np.linalg.inv(matrix)) for matrix in there_from_here),
    }


def further_cameras(camera: Camera, scene: Scene) -> list[Camera]:
    """The cameras of SSDO, section 4: displaced by a unit vector times the radius of the scene's bounding sphere.

    They look at the same centre of interest: the point of the view axis beside the scene's centre, or the target if
    that is farther.
    """
    axes = camera.view_from_world[:3, :3]  # rows: right, up, backward
    eye, forward = np.asarray(camera.eye), -axes[2]
    distance = max(np.linalg.norm(np.subtract(camera.target, eye)), (scene.bounds.mean(axis=0) - eye) @ forward)
    interest = eye + distance * forward
    result = []
    for displacement in DISPLACEMENTS:
        there = eye + scene.sphere_radius * (np.asarray(displacement) @ axes)
        looking = interest - there
        # straight down the camera's up there is no up left: then its forward serves
        up = axes[1] if np.linalg.norm(np.cross(looking, axes[1])) > 1e-3 * np.linalg.norm(looking) else forward
        result.append(replace(camera, eye=tuple(there), target=tuple(interest), up=tuple(up)))
    return result
