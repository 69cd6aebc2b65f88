"""Open3D's ambient occlusion, Filament's: scalable ambient obscurance (McGuire, Mara and Luebke 2012) at half size."""

import os
from typing import Any

import numpy as np

from ...extras import need
from ...gl.texture import Size
from ...pictures.images import linear_from_srgb
from ...scene.camera import Camera
from ...scene.scene import Scene
from .peer import geometry

RADIUS = 0.3  # of Filament's AmbientOcclusionOptions, metres: Open3D has no parameter for it


class Open3dSAO:
    """Filament's occlusion dims the light of the environment alone, so a white scene is drawn with and without it."""

    def __init__(self, scene: Scene, camera: Camera, size: Size, radius: float) -> None:
        os.environ.setdefault("OPEN3D_CPU_RENDERING", "true")  # where there is no GPU
        open3d = need("open3d")
        rendering = open3d.visualization.rendering
        scale = RADIUS / radius  # the scene is scaled, so that the radius is the asked one

        def place(point: Any) -> np.ndarray:
            return (np.asarray(point, float) - scene.centre) * scale

        vertices, faces = geometry(scene)
        mesh = open3d.geometry.TriangleMesh(
            open3d.utility.Vector3dVector(place(vertices)), open3d.utility.Vector3iVector(faces.astype(np.int32))
        )
        mesh.compute_triangle_normals()
        white = rendering.MaterialRecord()
        white.shader, white.base_roughness, white.base_reflectance = "defaultLit", 1.0, 0.0
        self.name = f"Open3D {open3d.__version__} ambient occlusion"
        self.settings: dict[str, object] = {"filter": "bilateral", "scale": 0.5}
        self._renderer = rendering.OffscreenRenderer(*size)
        world = self._renderer.scene
        world.add_geometry("scene", mesh, white)
        world.set_background([0.0, 0.0, 0.0, 1.0])
        world.scene.enable_sun_light(False)
        world.scene.set_indirect_light_intensity(20000)  # the white scene is then bright, and below the largest level
        self._renderer.setup_camera(camera.fov, place(camera.target), place(camera.eye), np.asarray(camera.up, float))
        grading = rendering.ColorGrading
        world.view.set_color_grading(grading(grading.Quality.HIGH, grading.ToneMapping.LINEAR))
        world.view.set_antialiasing(False)

    def draw(self, occlusion: bool) -> np.ndarray:
        """Reading the image is part of its time: Open3D has no other way to wait for the end of a frame."""
        self._renderer.scene.view.set_ambient_occlusion(occlusion, False)
        return np.asarray(self._renderer.render_to_image())

    def visibility(self) -> np.ndarray:
        dimmed, open = (linear_from_srgb(self.draw(on)[..., 1] / 255) for on in (True, False))
        return dimmed / np.maximum(open, 1e-3)
