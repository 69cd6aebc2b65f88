"""`aolab.compare`: two results, buffer by buffer and region by region."""

import json
import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from os import PathLike
from typing import Any

import numpy as np
from PIL import Image

from ..errors import ParameterError, notice, suggestion
from ..output import replacing
from ..pictures import display, html
from ..table import table
from .agreement import check
from .buffer import BufferComparison
from .metrics import Measures, angles, differences, psnr
from .pairing import Buffers, common, errors, label, regions, size_of
from .perception import flip_map, ssim_map
from .quantities import kind_of, picture

# the others, percentiles and the mean magnitude, are in `measures` and in the JSON
PRINTED = ("pixels", "rmse", "trimmed", "outliers", "noise", "bias", "p99", "maximum", "psnr", "ssim", "flip", "angle",
           "angle_p90")  # fmt: skip


@dataclass(frozen=True, eq=False)
class Comparison:
    """The result of `compare`: it prints as a table, shows itself in notebooks, and goes to JSON.

    `comparison["visibility"].rmse` over the whole foreground, `comparison["visibility"].measures["border"].rmse` in a
    region; `regions` are the masks (H, W).
    """

    names: tuple[str, str]
    buffers: dict[str, BufferComparison]
    regions: dict[str, np.ndarray]

    def __getitem__(self, name: str) -> BufferComparison:
        if name not in self.buffers:
            raise ParameterError(f"buffer '{name}' was not compared{suggestion(name, self.buffers)}")
        return self.buffers[name]

    def picture(self, buffer: str | None = None, *, limit: float | None = None) -> Image.Image:
        """Result, reference and error of `buffer` (by default the first), with a colour bar.

        The scale ends at `limit`, in the buffer's unit, by default at the 99th percentile of the magnitudes.
        """
        from .pictures import comparison_picture

        one = self[buffer] if buffer is not None else next(iter(self.buffers.values()))
        return comparison_picture(one, self.names, limit)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers; a measure that has no meaning is None."""
        return {
            "result": self.names[0],
            "reference": self.names[1],
            "size": list(self.regions["all"].shape[::-1]),
            "buffers": {
                name: {region: _plain(asdict(measures)) for region, measures in one.measures.items()}
                for name, one in self.buffers.items()
            },
        }

    def to_json(self) -> str:
        """`to_dict` as strict JSON: an infinite PSNR is the text "Infinity", which `float` reads."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False)

    def save(self, path: str | PathLike[str]) -> None:
        """Write `to_json`; replaces atomically."""
        with replacing(path) as file:
            file.write((self.to_json() + "\n").encode())

    def __str__(self) -> str:
        height, width = self.regions["all"].shape
        lines = [f"{self.names[0]} against {self.names[1]}, {width}×{height}"]
        for name, one in self.buffers.items():
            lines += ["", _table(name, one.kind.unit, one.measures)]
            if one.is_noisy:
                lines.append(f"  note: {one.about_noise}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        found = ", ".join(f"{name} rmse {one.rmse:.4g}" for name, one in self.buffers.items())
        return f"<Comparison {self.names[0]} against {self.names[1]}: {found}>"

    def _repr_png_(self) -> bytes:
        return html.png(self.picture())

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.buffers)

    def _repr_html_(self) -> str:
        return display.comparison_html(self)


def compare(
    a: Buffers,
    b: Buffers,
    buffers: Iterable[str] | str | None = None,
    *,
    border: float | None = None,
    flip: bool = True,
) -> Comparison:
    """Compare `a`, the result, with `b`, the reference: frames, or mappings of arrays (H, W) or (H, W, C).

    `buffers` defaults to all that both have, except for the surfaces that renders share (viewZ, viewNormal, albedo) and
    standard errors. sh0 .. sh3 become `sh`, all 16 coefficients, and its bands. The foreground is where both have a
    surface (`viewZ`; without it, where not both are NaN). Pixels of the foreground that are not finite are left out,
    and a `Notice` counts them. `Measures` holds the measures, by region:

    - `border`: nearer than `border` pixels to the image's edge; by default, pixels whose sphere of the frames' radius
      leaves the image, or, where no radius is known, 1/20 of the shorter side;
    - `silhouettes` and `thin` occluders, of the reference's depth: `aolab.measures.regions`; they need a `viewZ`;
    - `interior`: none of these.

    `flip=False` leaves out the slowest measure: 2 seconds a megapixel on two cores, for radiance a few times that.
    A `Notice` names a buffer where the reference's own noise is more than a third of the RMSE, and what differs
    between the questions, scenes and lights of two frames.
    Raises `ParameterError` for sizes or cameras that differ, no common buffer, or nothing but background.
    """
    compared = measured(a, b, buffers, border=border, flip=flip)
    for one in compared.buffers.values():
        if one.is_noisy:
            advice = "give the reference more `rays`, or an `error`"
            notice(f"buffer '{one.name}': {one.about_noise}; {advice}")
    return compared


def measured(
    a: Buffers, b: Buffers, buffers: Iterable[str] | str | None, *, border: float | None = None, flip: bool = True
) -> Comparison:
    """`compare` without its `Notice` about noise, for callers that have their own."""
    pairs = common(a, b, buffers)
    names = label(a, "a"), label(b, "b")
    check(a, b, names, pairs)
    where, noise = regions(a, b, size_of(pairs), border), errors(b, pairs)
    compared = {name: _compare_buffer(name, *pair, noise.get(name), where, flip) for name, pair in pairs.items()}
    return Comparison(names, compared, where)


def _compare_buffer(
    name: str,
    result: np.ndarray,
    reference: np.ndarray,
    noise: np.ndarray | None,
    where: dict[str, np.ndarray],
    flip: bool,
) -> BufferComparison:
    kind = kind_of(name)
    foreground = where["all"] & ~(np.isnan(result).all(axis=2) & np.isnan(reference).all(axis=2))
    finite = np.isfinite(result).all(axis=2) & np.isfinite(reference).all(axis=2)
    if broken := int((foreground & ~finite).sum()):
        y, x = np.argwhere(foreground & ~finite)[0]
        notice(
            f"buffer '{name}': {broken} pixels are left out, their values are not finite; the first is at x={x}, y={y}"
        )
        foreground = foreground & finite
    if not foreground.any():
        raise ParameterError(f"buffer '{name}': nothing to compare, all {foreground.size} pixels are background")

    maps: dict[str, np.ndarray] = {}
    if kind.picture:
        a, b = (_filled(one, reference, foreground) for one in (result, reference))
        seen_a, seen_b = picture(a, kind), picture(b, kind)
        maps["squared"] = ((seen_a - seen_b) ** 2).mean(axis=2)
        maps["ssim"] = ssim_map(seen_a, seen_b)
        if flip:
            hdr = kind.picture == "tone mapped"
            maps["flip"] = flip_map(*((np.maximum(a, 0), np.maximum(b, 0)) if hdr else (seen_a, seen_b)), hdr=hdr)
    if kind.error == "angle":
        maps["angle"] = angles(result, reference)
    if noise is not None:
        maps["noise"] = (np.nan_to_num(noise).astype(np.float64) ** 2).mean(axis=2)
    difference = result.astype(np.float64) - reference
    measures = {region: _measure(difference, maps, mask & foreground) for region, mask in where.items()}
    return BufferComparison(name, kind, result, reference, foreground, measures)


def _measure(difference: np.ndarray, maps: dict[str, np.ndarray], mask: np.ndarray) -> Measures:
    count = int(mask.sum())
    if not count:
        return Measures(0)
    found = differences(difference[mask])
    if "squared" in maps:
        found["psnr"] = psnr(np.sqrt(maps["squared"][mask]))
    found |= {name: float(maps[name][mask].mean()) for name in ("ssim", "flip") if name in maps}
    if "noise" in maps:
        found["noise"] = float(np.sqrt(maps["noise"][mask].mean()))
    if "angle" in maps:
        known = maps["angle"][mask]
        known = known[np.isfinite(known)]
        if known.size:
            found |= {"angle": float(known.mean()), "angle_p90": float(np.percentile(known, 90))}
    return Measures(count, **found)


def _filled(values: np.ndarray, reference: np.ndarray, foreground: np.ndarray) -> np.ndarray:
    """`values` with the reference's mean colour in the background: the same in result and reference."""
    return np.where(foreground[..., None], values, reference[foreground].mean(axis=0, dtype=np.float64))


def _plain(measures: dict[str, float]) -> dict[str, float | str | None]:
    def plain(value: float) -> float | str | None:
        if math.isnan(value):
            return None
        return value if math.isfinite(value) else "Infinity"

    return {name: plain(value) for name, value in measures.items()}


def _table(name: str, unit: str, measures: dict[str, Measures]) -> str:
    """A row for each region, a column for each of the `PRINTED` measures that any region has."""
    columns = [name for name in PRINTED if any(not math.isnan(getattr(one, name)) for one in measures.values())]
    head = f"{name}, {unit}" if unit else name
    rows = [[f"  {region}", *(getattr(one, column) for column in columns)] for region, one in measures.items()]
    formats = {name: "d" if name == "pixels" else ".4g" for name in columns}
    return table({head: "", **formats}, rows)
