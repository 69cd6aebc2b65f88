"""Colours and the alpha of materials, alike for every format."""

from typing import TypedDict

import numpy as np

from ..pictures.images import linear_from_srgb
from .parts import Notes

MASK_CUTOFF = 0.5  # glTF's default alphaCutoff


class Alpha(TypedDict):
    """How a material's alpha is drawn: arguments of `Material`."""

    alpha_cutoff: float | None
    blend: bool


def alpha_drawn(mode: str | None, cutoff: float | None, material: str, notes: Notes) -> Alpha:
    """For glTF's alphaMode: OPAQUE, MASK with its cutoff, or BLEND, with a note, as there is no blending."""
    if mode == "BLEND":
        notes.add("material ", material, " is blended: drawn in as many of the pixels as its alpha states")
    if mode != "MASK":
        return {"alpha_cutoff": None, "blend": mode == "BLEND"}
    return {"alpha_cutoff": MASK_CUTOFF if cutoff is None else cutoff, "blend": False}


def linear_colors(colors: np.ndarray, srgb: bool) -> np.ndarray:
    """(n, 3 or 4) colours, integers over their type's range or floats in [0, 1], as linear RGBA (n, 4) float32."""
    colors = np.asarray(colors)
    scale = np.iinfo(colors.dtype).max if colors.dtype.kind in "ui" else 1
    values = np.ones((len(colors), 4), np.float32)
    values[:, : colors.shape[1]] = colors / scale
    if srgb:
        values[:, :3] = linear_from_srgb(values[:, :3])
    return values
