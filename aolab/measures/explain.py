"""An error split by its causes: noise, filter, steps, layers, screen border, method, and the reach of senders."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from PIL import Image

from ..errors import ParameterError, suggestion
from ..gl.texture import Size
from ..loading import load
from ..modules import MODULES, Module, find
from ..pipeline.frame import Frame
from ..pipeline.lab import Lab
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..table import table

CONVERGED = 64  # frames: noise falls to 1/8 of one frame's
BACKGROUND = 153  # a grey that is no colour of an error
STEPS = 32  # along a direction: as good as a ray, in an image of a few hundred rows
LAYERS = 4  # of depth; deeper ones are left to the method
MARGIN = 0.5  # of the image's height: drawn around the image, it shows what lies off the screen
PERIOD = 4  # pixels: the interleaved pattern of sample sets repeats after so many

# each part is the difference of two neighbours in a chain of results, from the module's frame to the truth
PARTS = ("sampling noise", "filter", "few steps", "hidden layers", "off-screen geometry", "method")
SENDERS = "limited senders"
COARSE = "coarse voxels"
UNBLOCKED = "unblocked bounce"
FINEST = 1024  # voxels along a side
BOUNCED = ("indirect", "radiance", "image")  # the buffers that hold a bounce


@dataclass(frozen=True, eq=False)
class Explanation:
    """A module's signed error and the parts that add up to it, pixel by pixel; all (H, W[, 3]), NaN in the background.

    - `sampling noise`: the frame against the mean of many, both filtered;
    - `filter`: that mean, filtered against unfiltered;
    - `few steps`: the unfiltered mean, against the same with directions marched as densely as a ray;
    - `hidden layers`: the same, with the camera's one layer of depth against four peeled layers;
    - `off-screen geometry`: the same, against a render with a margin drawn around the image;
    - `coarse voxels`, of `occluders="voxels"`: the same, against a grid of twice as many voxels along each side;
    - `method`: the rest, against rays that answer the module's own question. For voxels, these rays meet the exact
      triangles, and there are no hidden layers;
    - `unblocked bounce`, of buffers with the bounce of reflective shadow maps: rays that collect the light of all
      surfaces along them, which is that bounce's own question, against rays that end at the first surface. It stands
      before `limited senders`;
    - `limited senders`, of buffers with a bounce: these rays against rays whose senders receive the environment's light
      from any distance, not only within the module's radius.

    A part for which the module has no parameter is 0, and joins the next one.

    The `share` of a part is its part of the squared error, Σ part · error / Σ error². The shares add up to 1; without a
    part whose share is negative, the error would be larger.
    """

    frame: Frame
    truth: Frame
    buffer: str
    error: np.ndarray
    parts: dict[str, np.ndarray]

    @property
    def residual(self) -> float:
        """The largest difference between the error and the sum of its parts: rounding, or else a fault."""
        return float(np.nanmax(np.abs(self.error - sum(self.parts.values()))))

    def table(self) -> dict[str, dict[str, float]]:
        """{part: rmse, bias, share}, and `error`, the whole."""
        squared = np.nansum(self.error**2)

        def row(values: np.ndarray) -> dict[str, float]:
            share = np.nansum(values * self.error) / squared if squared else 0.0
            return {
                "rmse": float(np.sqrt(np.nanmean(values**2))),
                "bias": float(np.nanmean(values)),
                "share": float(share),
            }

        return {name: row(values) for name, values in {**self.parts, "error": self.error}.items()}

    def picture(self) -> Image.Image:
        """The result, the truth, the error and its parts, side by side; errors on one scale, zero in the middle."""
        from matplotlib import colormaps

        from ..pictures.sheet import contact_sheet, gray
        from .pictures import SIGNED

        limit = max(float(np.nanpercentile(np.abs(self.error), 99)), 1e-6)
        table = self.table()
        pictures = [
            ("result", gray(_scalar(self.frame[self.buffer]))),
            ("truth", gray(_scalar(self.truth[self.buffer]))),
        ]
        for name, values in {"error": self.error, **self.parts}.items():
            caption = f"{name}: rmse {table[name]['rmse']:.4f}, {100 * table[name]['share']:.0f} % (±{limit:.2g})"
            colors = colormaps[SIGNED](_scalar(values) / (2 * limit) + 0.5, bytes=True)[..., :3]
            pictures.append((caption, np.where(_like(self.frame.mask, colors), colors, np.uint8(BACKGROUND))))
        return contact_sheet(pictures)

    def __str__(self) -> str:
        columns = {"part": "", "rmse": ".4f", "bias": "+.4f", "share": ".1%"}
        return table(columns, [(name, *row.values()) for name, row in self.table().items()])


def explain(
    scene: Any,
    module: str | Module | type[Module] = "ssao",
    *,
    buffer: str = "visibility",
    size: Size = (480, 270),
    camera: Camera | None = None,
    rays: int = 256,
    seed: int = 0,
    frames: int = CONVERGED,
    **parameters: object,
) -> Explanation:
    """Split a module's error in `buffer` into parts, each the difference of two results that differ in one cause.

    Where the noise must be gone, `frames` frames are averaged. The truth has `rays` a pixel and the module's own
    question. Raises `ParameterError`, and what `aolab.render` and `aolab.reference` raise.
    """
    from ..truth import reference

    if frames < 2:
        raise ParameterError(f"frames = {frames} is not a whole number from 2 on")
    scene, lab = load(scene), Lab(size)
    module = find(module, MODULES, **parameters).resolved(scene)
    camera = camera or scene.camera
    assert camera is not None  # Scene frames itself
    bare = module.replace(filter="none")
    marched = bare.replace(steps=max(STEPS, bare.steps)) if "steps" in type(module).model_fields else bare  # type: ignore[attr-defined]
    layered = marched.replace(occluders="layers", layers=LAYERS) if module.occluders == "depth" else marched
    fine = layered
    if module.occluders == "voxels":
        fine = layered.replace(voxels=min(2 * layered.values()["voxels"], FINEST))
    converged = {"seed": seed, "accumulate": frames, "camera": camera}

    frame = lab.render(scene, module, camera=camera, seed=seed)
    if buffer not in frame.buffers:
        raise ParameterError(f"{frame.info['module']} gives no '{buffer}'{suggestion(buffer, frame.buffers)}")
    bounced = buffer in BOUNCED
    own = module.question()
    questions = [own, own.replace(limited_senders=False)] if bounced else [own]
    unblocked = bounced and "rsm" in type(module).parts
    if unblocked:
        questions.insert(0, own.replace(blocked_senders=False))
    view = {"size": size, "camera": camera}
    truths = [reference(scene, like=one, rays=rays, seed=seed, buffers=(buffer,), **view) for one in questions]
    chain = [
        frame[buffer],
        lab.render(scene, module, **converged)[buffer],
        lab.render(scene, bare, **converged)[buffer],
        lab.render(scene, marched, **converged)[buffer],
        lab.render(scene, layered, **converged)[buffer],
        with_margin(lab, scene, layered, camera, size, seed, frames)[buffer],
        *([with_margin(lab, scene, fine, camera, size, seed, frames)[buffer]] if fine is not layered else []),
        *(truth[buffer] for truth in truths),
    ]
    chain = [np.where(_like(frame.mask, values), values, np.nan).astype(np.float64) for values in chain]
    names = [
        *PARTS[:-1],
        *([COARSE] if fine is not layered else []),
        PARTS[-1],
        *([UNBLOCKED] if unblocked else []),
        *([SENDERS] if bounced else []),
    ]
    parts = {name: first - second for name, (first, second) in zip(names, pairwise(chain), strict=True)}
    return Explanation(frame, truths[-1], buffer, chain[0] - chain[-1], parts)


def with_margin(
    lab: Lab, scene: Scene, module: Module, camera: Camera, size: Size, seed: int, frames: int
) -> dict[str, np.ndarray]:
    """The buffers of a larger image, cut to `size`: pixel for pixel the same view, but its border has neighbours.

    The margin is a whole number of periods, so that each pixel has the sample set that it has without a margin.
    """
    margin = PERIOD * round(MARGIN * size[1] / PERIOD)
    larger = size[0] + 2 * margin, size[1] + 2 * margin
    frame = lab.render(
        scene, module, camera=camera.with_margin(size, larger), size=larger, seed=seed, accumulate=frames
    )
    cut = slice(margin, margin + size[1]), slice(margin, margin + size[0])
    return {name: frame[name][cut] for name in frame.buffers}


def _like(mask: np.ndarray, values: np.ndarray) -> np.ndarray:
    return mask if values.ndim == 2 else mask[..., None]


def _scalar(values: np.ndarray) -> np.ndarray:
    return values if values.ndim == 2 else values.mean(axis=-1)
