"""VTK's SSAO with its blur, as PyVista offers it in `Plotter.enable_ssao`."""

import numpy as np

from ...extras import need
from ...gl.texture import Size
from ...scene.camera import Camera
from ...scene.scene import Scene
from .peer import geometry


class VtkSSAO:
    """`vtkSSAOPass`: samples in the hemisphere of each pixel, then a blur over 4×4 pixels."""

    def __init__(self, scene: Scene, camera: Camera, size: Size, radius: float) -> None:
        pyvista = need("pyvista")
        vertices, faces = geometry(scene)
        self.name = f"VTK {pyvista.vtk_version_info.major}.{pyvista.vtk_version_info.minor} ssao"
        self.settings: dict[str, object] = {"directions": 16, "filter": "blur"}
        self._plotter = pyvista.Plotter(off_screen=True, window_size=size)
        self._plotter.add_mesh(
            pyvista.PolyData.from_regular_faces(vertices - scene.centre, faces),
            color="white",
            ambient=1.0,  # a surface that reflects ambient light alone shows the occlusion
            diffuse=0.0,
            specular=0.0,
        )
        self._plotter.set_background("black")
        view = self._plotter.camera
        view.position = np.asarray(camera.eye) - scene.centre
        view.focal_point = np.asarray(camera.target) - scene.centre
        view.up, view.view_angle = camera.up, camera.fov
        # the ratio of bias to radius, and the samples, are those of VTK's example TestSSAOPass
        self._occlude = {"radius": radius, "bias": radius / 100, "kernel_size": 16, "blur": True}
        self._occluded: bool | None = None
        self._plotter.show(auto_close=False)

    def draw(self, occlusion: bool) -> None:
        if occlusion is not self._occluded:
            if occlusion:
                self._plotter.enable_ssao(**self._occlude)
            else:
                self._plotter.disable_ssao()
            self._occluded = occlusion
        window = self._plotter.render_window
        window.Render()
        window.WaitForCompletion()

    def visibility(self) -> np.ndarray:
        self.draw(True)
        return np.asarray(self._plotter.screenshot(return_img=True))[..., 0] / 255
