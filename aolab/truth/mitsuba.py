"""A second opinion: whole images of the same scene by path tracing, with Mitsuba 3 in a process of its own."""

import importlib.util
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Error, ParameterError, suggestion
from ..extras import install_command
from ..loading import load
from ..modules.question import Question
from ..pipeline.frame import Frame
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..scene.view import Size, View
from .mitsuba_scene import SURFACES, Description, Image, describe
from .picture import shown
from .shot import Shot

BUFFERS = ("direct", "ambient", "indirect", "radiance", "image")
WORKER = Path(__file__).with_name("mitsuba_worker.py")
LAST_LINES = 6  # of the output of a failing Mitsuba


def path_traced(
    scene: Any,
    *,
    size: Size = (640, 360),
    camera: Camera | None = None,
    max_depth: int = 2,
    samples: int = 64,
    seed: int = 0,
    buffers: Iterable[str] = ("radiance", "image"),
    cache: bool = True,
    timeout: float = 3600.0,
) -> Frame:
    """`scene` (anything that `aolab.load` takes) by path tracing. Each pixel is the mean over its area, box filtered.

    `buffers` chooses what is computed, all (H, W, 3) float32 linear radiance, top row first, but for `image`:

    - `radiance`: everything, over the environment; paths of at most `max_depth` edges: 2 is direct light (of the
      environment too), 3 adds one bounce, -1 is all of them. Light that surfaces emit counts as light that they
      reflect: its paths have one edge less; `image`: the same, tone mapped as a render, sRGB uint8;
    - `direct`, `ambient`, `indirect`, as of `aolab.reference(radius=None)`: direct light of the lights, direct light of
      the environment, and one bounce of both and of emission, whatever `max_depth` is. 0 in the background.

    Further buffers are viewZ, viewNormal and albedo: aolab's own G-buffer, at the pixels' centres. `samples` a
    pixel (rounded up to a full grid) are taken for each light and for the environment, which are rendered one by one
    and added up, so that no noise comes from a choice among them. Mitsuba is ended after `timeout` seconds. Results are
    kept on disk, as the reference's are, unless `cache` is False.

    Differences from a render and the reference, besides noise and antialiasing: the environment's irradiance is exact,
    not from 9 coefficients; textures have one level; holes of cut-out textures have edges between texels; a surface
    whose shading normal points away from the viewer is lit from behind; the backs of single-sided surfaces are there;
    normal maps and height maps are not used. Parts without counterpart in Mitsuba are a `SceneError`: a light without
    shadow, vertex colours together with a texture, the emission of a surface with holes, a texture of two wraps.

    Raises `ParameterError`, also if Mitsuba is not installed, and `Error` with Mitsuba's last lines if it fails.
    """
    scene = load(scene)
    wanted = _checked(buffers, max_depth, samples, seed, timeout)
    shot = Shot.take(scene, size, camera)

    def make(missing: list[str]) -> dict[str, np.ndarray]:
        return _render(scene, shot.view, missing, max_depth, samples, seed, timeout)

    settings = {"engine": "mitsuba", "max_depth": max_depth, "samples": samples}
    return shot.frame("mitsuba scalar_rgb", settings, Question(), seed, wanted, make, cache)


def _checked(buffers: Iterable[str], max_depth: int, samples: int, seed: int, timeout: float) -> list[str]:
    """The wanted buffers in the table's order, after all arguments have been checked."""
    wanted = [buffers] if isinstance(buffers, str) else list(buffers)
    for name in wanted:
        if name not in BUFFERS:
            raise ParameterError(f"engine = 'mitsuba' has no buffer '{name}'{suggestion(name, BUFFERS)}")
    if not isinstance(max_depth, int) or (max_depth < 2 and max_depth != -1):
        raise ParameterError(f"max_depth = {max_depth!r} is none of: 2 (direct light), 3 (one bounce), ..., -1 (all)")
    if not isinstance(samples, int) or samples < 1:
        raise ParameterError(f"samples = {samples!r} is not a whole number from 1 on")
    if not isinstance(seed, int) or seed < 0:
        raise ParameterError(f"seed = {seed!r} is not a whole number from 0 on")
    if not timeout > 0:
        raise ParameterError(f"timeout = {timeout!r} is not a number of seconds above 0")
    if importlib.util.find_spec("mitsuba") is None:
        raise ParameterError("engine = 'mitsuba' needs Mitsuba 3: " + install_command("mitsuba"))
    return [name for name in BUFFERS if name in wanted]


def _parts(buffer: str, scene: Scene, max_depth: int) -> list[tuple[int, Image]]:
    """The images whose sum is `buffer`, each with its sign. The environment is the emitter after the lights."""
    assert scene.environment is not None  # Scene fills it in
    lights = range(len(scene.lights))
    sky = [len(scene.lights)] if scene.environment.radiance.any() else []
    direct = [(1, Image(i, 2, background=False)) for i in lights]
    glow = [SURFACES] if scene.emits else []
    if buffer == "direct":
        return direct
    if buffer == "ambient":
        return [(1, Image(i, 2, background=False)) for i in sky]
    if buffer == "indirect":
        everywhere = (*lights, *sky)
        added = [(sign, Image(i, depth, background=False)) for i in everywhere for sign, depth in ((1, 3), (-1, 2))]
        return added + [(sign, Image(i, depth, background=False)) for i in glow for sign, depth in ((1, 2), (-1, 1))]
    everything = [(1, Image(i, max_depth, background=False)) for i in lights]
    everything += [(1, Image(i, max_depth if max_depth < 0 else max_depth - 1, background=False)) for i in glow]
    return everything + [(1, Image(i, max_depth, background=True)) for i in sky]


def _render(
    scene: Scene, view: View, wanted: list[str], max_depth: int, samples: int, seed: int, timeout: float
) -> dict[str, np.ndarray]:
    needed = dict.fromkeys("radiance" if name == "image" else name for name in wanted)
    parts = {name: _parts(name, scene, max_depth) for name in needed}
    images = list(dict.fromkeys(image for each in parts.values() for _, image in each))
    rendered = _run(describe(scene, view, images, samples, seed), timeout) if images else {}
    made = {name: np.zeros((view.size[1], view.size[0], 3), np.float32) for name in needed}
    for name, each in parts.items():
        for sign, image in each:
            made[name] += np.float32(sign) * rendered[image.name]
    if "image" in wanted:
        made["image"] = shown(made["radiance"])
    return {name: made[name] for name in wanted}


def _run(description: Description, timeout: float) -> dict[str, np.ndarray]:
    """The images, by name, from a worker process. Raises `Error`."""
    with tempfile.TemporaryDirectory(prefix="aolab-mitsuba-") as name:
        folder = Path(name)
        (folder / "scene.json").write_text(json.dumps(description.scene))
        np.savez(folder / "arrays.npz", **description.arrays)  # type: ignore[arg-type]
        run_worker(folder, timeout)
        with np.load(folder / "images.npz") as file:
            return {name: file[name] for name in file.files}


def run_worker(folder: Path, timeout: float) -> None:
    """Let Mitsuba render the scene in `folder`. Raises `Error` with its last lines, or after `timeout` seconds."""
    # -P: this folder's modules (cache, lighting, mitsuba, ...) must not hide installed ones
    command = [sys.executable, "-P", str(WORKER), str(folder)]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=timeout)
    except subprocess.TimeoutExpired:
        raise Error(
            f"Mitsuba did not finish within {timeout:g} s: fewer samples, a smaller size, or a larger timeout"
        ) from None
    if done.returncode:
        words = (done.stderr.strip() or done.stdout.strip() or "no output").splitlines()[-LAST_LINES:]
        raise Error(f"Mitsuba failed (exit status {done.returncode}): " + "\n".join(words))
