"""RSM and SSAO, the last row of figures: the rotated kernel raw and filtered, for indirect light and for occlusion."""

import numpy as np

from ...gl.texture import Size
from ...modules import MODULES, find
from ...pictures.sheet import gray
from ...pipeline.api import shared_lab
from ...pipeline.frame import Frame
from ...truth.picture import shown
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .stage import stage

PERIOD = 4  # pixels: the angles repeat
CONVERGED = 64  # frames, so that the angles are many


def fig9(size: Size = (320, 240), frames: int = CONVERGED) -> Figure:
    """The bounce and the occlusion by the rotated kernel, before and after the mean of 4×4 pixels.

    Numbers: the RMSE against the mean of many frames without a filter, as a share of the mean; and the power of the
    error's spectrum at the period of four pixels, filtered over raw.
    """
    scene = stage(daylight=0.0)
    module = find("rotated_ssao+rsm?shaded=false&radius=1", MODULES)
    frame = shared_lab().render(scene, module, size=size)
    many = shared_lab().render(scene, module.replace(filter="none"), size=size, accumulate=frames)
    errors, patterns, pictures = {}, {}, []
    effects = {"indirect light": _bounce, "occlusion": _occlusion}
    for name, values_of in effects.items():
        exact = values_of(many, "")
        mean = float(exact[many.mask].mean())
        drawn = {"raw": values_of(frame, "_raw"), "filtered": values_of(frame, "")}
        errors[name] = {kind: rmse(values, exact, many.mask) / mean for kind, values in drawn.items()}
        patterns[name] = _pattern(drawn["filtered"] - exact) / _pattern(drawn["raw"] - exact)
        for kind, values in drawn.items():
            pixels = shown(8 * values) if values.ndim == 3 else gray(1 - values)
            pictures.append((f"{name}, {kind}: rmse {100 * errors[name][kind]:.0f} % of the mean", pixels))
    needs = []
    for name in effects:
        ratio = errors[name]["filtered"] / errors[name]["raw"]
        needs += [
            Need(f"{name}: filtered rmse over raw", ratio, below=0.7),
            Need(f"{name}: power at the period of 4 pixels, filtered over raw", patterns[name], below=0.15),
        ]
    claim = "The rotated kernel makes a pattern, and the mean of 4 x 4 pixels removes it"
    return figure(
        "RSM and SSAO, Fig. 9",
        claim,
        needs,
        {"rmse_over_mean": errors, "pattern": patterns, "frames": frames},
        pictures,
        2,
    )


def _bounce(frame: Frame, raw: str) -> np.ndarray:
    return frame["albedo"] / np.pi * frame[f"rsm_irradiance{raw}"]


def _occlusion(frame: Frame, raw: str) -> np.ndarray:
    return np.where(frame.mask, 1 - frame[f"visibility{raw}"], 0)


def _pattern(values: np.ndarray) -> float:
    """The power of the spectrum where both periods, across and down, are four pixels, their halves, or none."""
    height, width = (side // PERIOD * PERIOD for side in values.shape[:2])
    plane = (values if values.ndim == 2 else values.mean(axis=-1))[:height, :width]
    power = np.abs(np.fft.fft2(plane)) ** 2
    rows, columns = (np.arange(PERIOD) * (side // PERIOD) for side in (height, width))
    return float(power[np.ix_(rows, columns)].sum() - power[0, 0])
