"""The kinds of buffers: the unit, and the picture on which PSNR, SSIM and FLIP are defined."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

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


SHARE = Kind("", "direct")
DISPLAYED = Kind("sRGB, 0 to 1", "direct")
RADIANCE = Kind("radiance", "tone mapped")
DIRECTION = Kind("degrees", error="angle")
HARMONICS = Kind("", error="norm")
LENGTH = Kind("scene units")
NUMBERS = Kind("")

KINDS = {
    **dict.fromkeys(("visibility", "obscurance", "transfer", "transfer_multibounce", "albedo"), SHARE),
    **dict.fromkeys(("direct", "ambient", "indirect", "radiance"), RADIANCE),
    **dict.fromkeys(("viewNormal", "bent_normal"), DIRECTION),
    **dict.fromkeys(("sh", *(f"sh{i}" for i in range(4)), *(f"sh_band{i}" for i in range(4))), HARMONICS),
    "viewZ": LENGTH,
    "image": DISPLAYED,
}


def kind_of(name: str) -> Kind:
    """The kind of the buffer `name`, also of an unfiltered estimate, `NAME_raw`; NUMBERS for an unknown name."""
    return KINDS.get(name.removesuffix("_raw"), NUMBERS)


def picture(values: np.ndarray, kind: Kind) -> np.ndarray:
    """(H, W, C) float64 in [0, 1]: the picture for PSNR and SSIM of `values` (H, W, C), of a kind with a picture."""
    if kind.picture == "tone mapped":
        return shown(np.maximum(values, 0)) / 255.0
    return np.clip(values, 0, 1).astype(np.float64)
