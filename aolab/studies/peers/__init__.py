"""aolab beside other projects' ambient occlusion: the same scene, camera, size, radius and truth, in turns."""

import statistics
from dataclasses import dataclass
from time import perf_counter
from typing import Any

from ...errors import ParameterError, notice
from ...gl import context
from ...gl.texture import Size
from ...loading import load
from ...measures.metrics import differences
from ...modules import S3HO, SSAO, Module
from ...modules.none import Unoccluded
from ...modules.parameters import label
from ...pipeline.frame import Frame
from ...pipeline.lab import Lab
from ...progress import progress_bar
from ...scene.camera import Camera
from ...scene.scene import Scene
from ...table import table
from ...truth import reference
from ..bench import summary
from ..curve import Curve, Point
from ..quality import curve_of, noise_of, visibility_error
from .open3d_sao import Open3dSAO
from .peer import PeerClass
from .process import PeerProcess
from .vtk_ssao import VtkSSAO

PEERS: dict[str, PeerClass] = {"pyvista": VtkSSAO, "open3d": Open3dSAO}
# aolab's own settings: the defaults of two modules, and those between which the others' choices lie
BARE = Unoccluded(filter="none")  # a frame without occlusion
OURS = (SSAO(), SSAO(directions=16, steps=4), SSAO(scale=0.5), S3HO())


@dataclass(frozen=True)
class Race:
    """`curve` has a point for each setting; `frames`: milliseconds of whole frames, median and spread by label."""

    curve: Curve
    frames: dict[str, dict[str, float]]

    def table(self) -> str:
        """Frames and occlusion in milliseconds, and as multiples of the first row's; RMSE and bias of visibility."""
        first = self.curve.points[0]
        rows = [
            (
                point.label,
                self.frames[point.label]["median"],
                self.frames[point.label]["median"] / self.frames[first.label]["median"],
                point.milliseconds,
                point.milliseconds / first.milliseconds,
                point.rmse,
                point.bias,
            )
            for point in self.curve.points
        ]
        columns = {"": "", "frame, ms": ".1f", "×": ".2f", "occlusion, ms": ".1f", "× ": ".2f"}
        return "\n".join([self.curve.title, self.curve.place, table({**columns, "rmse": ".4f", "bias": "+.4f"}, rows)])

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {**self.curve.to_dict(), "frames": self.frames}


def race(
    scene: Any,
    *,
    radius: float | None = None,
    size: Size = (960, 540),
    rays: int = 256,
    frames: int = 15,
    seed: int = 0,
) -> Race:
    """Race the installed `PEERS` and `OURS`, frame by frame in turns. `radius`: scene units, None for SSAO's default.

    The truth counts everything within `radius` fully (`falloff=0`), as the other projects do, and aolab's modules are
    set to the same. The time of occlusion is the difference of a frame with it and a frame without it. A peer draws a
    white scene without shadows; aolab draws the scene with its lights and shadows. Raises `ParameterError` if no peer
    is installed, or for fewer than 3 frames; a peer that cannot draw on this machine is left out with a notice.
    """
    if not isinstance(frames, int) or frames < 3:
        raise ParameterError(f"frames = {frames!r}: a median with its spread needs 3 or more")
    scene, lab = load(scene), Lab(size)
    chosen = float(SSAO().resolved(scene).radius if radius is None else radius)
    ours = [module.replace(radius=chosen, falloff=0.0) for module in OURS]
    camera = lab.render(scene, ours[0]).camera
    peers = _peers(scene, camera, size, chosen)
    truth = reference(scene, size=size, rays=rays, like=ours[0], seed=seed, buffers=("visibility", "standard_error"))

    runners = [_Peer(peer, truth) for peer in peers] + [_Ours(lab, scene, module, truth) for module in ours]
    times: list[list[tuple[float, float]]] = [[] for _ in runners]
    with progress_bar("frames", frames * len(runners), " pairs") as bar:
        for turn in range(frames + 1):
            for runner, known in zip(runners, times, strict=True):
                pair = runner.milliseconds(True), runner.milliseconds(False)
                if turn:  # the first frames compile shaders
                    known.append(pair)
                    bar.update()
    for peer in peers:
        peer.close()

    points = []
    for runner, known in zip(runners, times, strict=True):
        cost = summary([max(with_it - without, 0.0) for with_it, without in known])
        medians = [statistics.median(one) for one in zip(*known, strict=True)]
        points.append(
            Point(
                runner.name,
                runner.settings,
                runner.default,
                cost["median"],
                cost["spread"],
                dict(zip(("frame", "frame without"), medians, strict=True)),
                runner.error["rmse"],
                runner.error["bias"],
            )
        )
    curve = curve_of(points, noise_of(truth), scene, size=size, radius=chosen, rays=rays, seed=seed, frames=frames)
    whole = {
        point.label: summary([pair[0] for pair in known]) for point, known in zip(curve.points, times, strict=True)
    }
    return Race(curve, whole)


def _peers(scene: Scene, camera: Camera, size: Size, radius: float) -> list[PeerProcess]:
    """The peers that are installed and can draw. Raises `ParameterError` if there is none."""
    found, reasons = [], []
    for name, kind in PEERS.items():
        try:
            found.append(PeerProcess(kind, scene, camera, size, radius))
        except ParameterError as reason:
            reasons.append(f"{name} is left out: {reason}")
    if not found:
        raise ParameterError("no other renderer to race: " + "; ".join(reasons))
    for reason in reasons:
        notice(reason)
    return found


class _Peer:
    """Another project's renderer, and its error against the truth."""

    default = True

    def __init__(self, peer: PeerProcess, truth: Frame) -> None:
        self.name, self.settings, self.milliseconds = peer.name, peer.settings, peer.milliseconds
        self.error = differences((peer.visibility - truth["visibility"])[truth.mask])


class _Ours:
    """A module of aolab with its settings, and its error against the truth."""

    def __init__(self, lab: Lab, scene: Scene, module: Module, truth: Frame) -> None:
        self._lab, self._scene, self._module = lab, scene, module
        self.name = label(type(module))
        asked = ("directions", "steps", "scale")
        self.settings: dict[str, object] = {name: getattr(module, name) for name in asked}
        self.default = all(getattr(module, name) == type(module).model_fields[name].default for name in asked)
        self.error = visibility_error(lab.render(scene, module), truth)

    def milliseconds(self, occlusion: bool) -> float:
        """The time of a frame, with or without ambient occlusion."""
        start = perf_counter()
        self._lab.render(self._scene, self._module if occlusion else BARE).complete("image")
        context.get().finish()
        return (perf_counter() - start) * 1e3
