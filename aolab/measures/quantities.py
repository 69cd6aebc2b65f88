"""The kinds of buffers: the unit, and the picture on which PSNR, SSIM and FLIP are defined."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..modules import known_buffers
from ..truth.picture import shown


@dataclass(frozen=True)
class Kind:
    """A kind of quantity: its `unit`, the picture made of it, and the definition of a pixel's error.

    PSNR, SSIM and FLIP compare the `picture`, values in [0, 1]: "direct", the values themselves; "tone mapped", linear
    radiance as a render displays it (filmic, exposure 1, sRGB), for which FLIP is HDR-FLIP of the linear values; None,
    for which PSNR, SSIM and FLIP have no meaning.
    `error` is a pixel's error: "signed", the mean difference of its channels; "angle" between directions; "norm" of the
    difference, which for coefficients is the root of the integral of the squared difference (Parseval).
    """

    unit: str
    picture: Literal["direct", "tone mapped"] | None = None
    error: Literal["signed", "angle", "norm"] = "signed"


KINDS: dict[str, Kind] = {
    "share": Kind("", "direct"),
    "displayed": Kind("sRGB, 0 to 1", "direct"),
    "radiance": Kind("radiance", "tone mapped"),
    "direction": Kind("degrees", error="angle"),
    "harmonics": Kind("", error="norm"),
    "length": Kind("scene units"),
    "numbers": Kind(""),
}


def kind_of(name: str) -> Kind:
    """The kind of the buffer `name`, filtered or not, by the table of buffers; plain numbers if the table lacks it."""
    name = name.removesuffix("_raw")
    if name == "sh" or name.startswith("sh_band"):  # all coefficients together, and bands of them (`pairing`)
        name = "sh0"
    buffers = known_buffers()
    return KINDS[buffers[name].kind if name in buffers else "numbers"]


def picture(values: np.ndarray, kind: Kind) -> np.ndarray:
    """(H, W, C) float64 in [0, 1]: the picture for PSNR and SSIM of `values` (H, W, C), of a kind with a picture."""
    if kind.picture == "tone mapped":
        return shown(np.maximum(values, 0)) / 255.0
    return np.clip(values, 0, 1).astype(np.float64)
