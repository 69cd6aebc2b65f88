"""The subject of a truth: a scene, as aolab's own G-buffer shows it to a camera."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from time import perf_counter
from typing import Any

import numpy as np

from ..modules.question import Question
from ..pipeline.api import shared_lab
from ..pipeline.frame import Frame
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..scene.view import Size, View
from ..version import __version__
from . import cache as disk

SURFACES = ("viewZ", "viewNormal", "facetNormal", "albedo", "emission", "geometricNormal")


@dataclass(frozen=True)
class Shot:
    """`scene` through a camera: the `surfaces` (a frame with the G-buffer) and the `view` that drew them."""

    scene: Scene
    view: View
    surfaces: Frame
    begun: float  # seconds, of `perf_counter`

    @classmethod
    def take(cls, scene: Scene, size: Size, camera: Camera | None) -> "Shot":
        """Draw the G-buffer. Raises what `aolab.render` raises."""
        begun = perf_counter()
        surfaces = shared_lab().render(scene, "none", size=size, camera=camera)
        return cls(scene, View(surfaces.camera, surfaces.size, scene.bounds), surfaces, begun)

    def frame(
        self,
        renderer: str,
        settings: Mapping[str, Any],
        question: Question,
        seed: int,
        wanted: list[str],
        make: Callable[[list[str]], Mapping[str, np.ndarray]],
        cache: bool,
    ) -> Frame:
        """The frame with the `wanted` buffers: those that are stored are read, and `make` computes the others.

        `renderer`, `settings` and `seed` are all that the buffers depend on besides the scene, the view and the
        package's code. `info` repeats them, and holds the `question` that the buffers answer.
        """
        camera = asdict(self.view.camera)
        made_of = {"renderer": renderer, "camera": camera, "size": self.view.size, "seed": seed, **settings}
        name = disk.key(self.scene, **made_of) if cache else ""
        arrays = disk.load(name, wanted) if cache else {}
        missing = [one for one in wanted if one not in arrays]
        if missing:
            made = make(missing)
            arrays = {**arrays, **made}
            if cache:
                disk.store(name, made)
        info = {
            "aolab": __version__,
            "renderer": renderer,
            "scene": self.scene.source,
            "module": "reference",
            "parameters": dict(settings),
            "question": asdict(question),
            "camera": camera,
            "size": list(self.view.size),
            "seed": seed,
            "triangles": self.scene.triangles,
            "cached": not missing,
        }
        milliseconds = (perf_counter() - self.begun) * 1e3
        surfaces = {one: self.surfaces[one] for one in SURFACES if one in self.surfaces.buffers}
        timings = {"reference": milliseconds}
        return Frame({**surfaces, **arrays}, timings, info, milliseconds, list(self.surfaces.notes), scene=self.scene)
