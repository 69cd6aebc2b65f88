"""Ambient transfer, figure 7: false shadows of a far foreground, without and with their elimination."""

from ...gl.texture import Size
from ...modules.ambient_transfer import AmbientTransfer
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...scene.camera import Camera
from ...scene.environment import Environment
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ...truth import reference
from ..figure import Figure, Need, figure
from ..pixels import rmse, world_positions

MODULE = AmbientTransfer(radius=0.5, directions=16, steps=4, measure="linear")
FALSE = 0.05  # darker than rays by more than this is a false shadow


def fig7(size: Size = (320, 180), rays: int = 128) -> Figure:
    """A door frame, seen before the far wall of a corridor, without and with the check R > z - z* > 0; beside rays.

    Numbers: the share of the far wall in false shadow, its root mean square error, and that of the whole picture.
    """
    scene, lab = _corridor(), shared_lab()
    switches = {"without elimination": False, "with elimination": True}
    frames = {name: lab.render(scene, MODULE, size=size, silhouette_elimination=on) for name, on in switches.items()}
    truth = reference(scene, like=frames["with elimination"], rays=rays, buffers="obscurance")
    wall = frames["with elimination"].mask & (world_positions(truth)[..., 2] < -7.9)
    numbers, pictures = {}, []
    for name, frame in frames.items():
        numbers[name] = found = {
            "false shadow": float(((truth["obscurance"] - frame["obscurance"])[wall] > FALSE).mean()),
            "rmse on the far wall": rmse(frame["obscurance"], truth["obscurance"], wall),
            "rmse": rmse(frame["obscurance"], truth["obscurance"], frame.mask),
            "occlusion": _occlusion(frame),
        }
        pictures.append(
            (f"{name}: {found['false shadow']:.0%} of the far wall in false shadow", gray(frame["obscurance"]))
        )
    without, eliminated = (numbers[name] for name in switches)
    occlusion = numbers["rays"] = _occlusion(truth)
    needs = (
        Need("the far wall in false shadow, without elimination", without["false shadow"], above=0.1),
        Need("the far wall in false shadow, with elimination", eliminated["false shadow"], below=0.02),
        Need("the error with elimination over that without", eliminated["rmse"] / without["rmse"], below=0.6),
        Need("the occlusion with elimination over rays'", eliminated["occlusion"] / occlusion, 0.75, 1.35),
    )
    pictures.append(("rays", gray(truth["obscurance"])))
    claim = "The check of the distance removes the false shadows of a far foreground, and keeps those of near occluders"
    return figure("Ambient transfer, Fig. 7", claim, needs, numbers, pictures, 3)


def _occlusion(frame: Frame) -> float:
    return float((1 - frame["obscurance"][frame.mask]).mean())


def _corridor() -> Scene:
    plaster, oak = Material((0.75, 0.72, 0.66), name="plaster"), Material((0.45, 0.3, 0.2), name="oak")
    far = Instance(block((4.4, 3.2, 0.2), plaster, "far wall"), placed(0, -0.1, -8.1))
    floor = Instance(block((4.4, 0.2, 9.2), plaster, "floor"), placed(0, -0.2, -4.0))
    sides = [Instance(block((0.2, 3.2, 9.2), plaster, "side"), placed(x, -0.1, -4.0)) for x in (-2.2, 2.2)]
    posts = [Instance(block((0.2, 2.3, 0.2), oak, "post"), placed(x, -0.01, -1.0)) for x in (-0.75, 0.75)]
    lintel = Instance(block((1.7, 0.2, 0.2), oak, "lintel"), placed(0, 2.28, -1.0))
    camera = Camera((0.4, 1.5, 3.6), (0, 1.25, -2), fov=40)
    sky = Environment.sky(zenith=(0.6, 0.65, 0.7), horizon=(0.8, 0.8, 0.8), ground=(0.4, 0.4, 0.4))
    return Scene((far, floor, *sides, *posts, lintel), (), sky, camera, name="corridor")
