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
        self.name = f"VTK {pyvista.vtk_version_info.major}.{pyvista.vtk_version_info.minor} ssao"
        self.settings: dict[str, object] = {"directions": 16, "filter": "blur"}
        vertices, faces = geometry(scene)
        mesh = pyvista.PolyData.from_regular_faces(vertices - scene.centre, faces)
        # a window with and one without occlusion: switching it in one window compiles shaders in each frame
        self._plotters = {}
        for occlusion in (True, False):
            plotter = pyvista.Plotter(off_screen=True, window_size=size)
            # a surface that reflects ambient light alone shows the occlusion
            plotter.add_mesh(mesh, color="white", ambient=1.0, diffuse=0.0, specular=0.0)
            plotter.render_window.SetMultiSamples(0)  # as aolab
            plotter.set_background("black")
            plotter.camera.position = np.asarray(camera.eye) - scene.centre
            plotter.camera.focal_point = np.asarray(camera.target) - scene.centre
            plotter.camera.up, plotter.camera.view_angle = camera.up, camera.fov
            if occlusion:  # the ratio of bias to radius is that of VTK's test of the pass
                plotter.enable_ssao(radius=radius, bias=radius / 100, kernel_size=16, blur=True)
            plotter.show(auto_close=False)
            self._plotters[occlusion] = plotter

    def draw(self, occlusion: bool) -> None:
        window = self._plotters[occlusion].render_window
        window.Render()
        window.WaitForCompletion()

    def visibility(self) -> np.ndarray:
        return np.asarray(self._plotters[True].screenshot(return_img=True))[..., 0] / 255
