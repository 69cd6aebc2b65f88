"""The arrays that two results share, and the regions of their image."""

from collections.abc import Iterable, Mapping

import numpy as np

from ..errors import ParameterError, notice, suggestion
from ..pipeline.frame import Frame
from ..truth.buffers import standard_error
from .quantities import kind_of
from .regions import BORDER_SHARE, border, projected_px, silhouettes, thin_occluders

Buffers = Frame | Mapping[str, np.ndarray]
Pairs = dict[str, tuple[np.ndarray, np.ndarray]]

# equal in a render and its reference: compared on request only
SURFACES = ("viewZ", "viewNormal", "facetNormal", "albedo")
_HARMONICS = ("sh0", "sh1", "sh2", "sh3")  # four coefficients each; together they are `sh`, and its bands
_BAND_OF = np.repeat([0, 1, 2, 3], [1, 3, 5, 7])


def common(a: Buffers, b: Buffers, wanted: Iterable[str] | str | None) -> Pairs:
    """{name: (of a, of b)}, (H, W, C) float32, all of one size; `wanted` as in `compare`. Raises `ParameterError`."""
    pairs = {name: (_array(a, name, "a"), _array(b, name, "b")) for name in _chosen(a, b, wanted)}
    height, width = next(iter(pairs.values()))[0].shape[:2]
    for name, (one, other) in pairs.items():
        if one.shape != other.shape or one.shape[:2] != (height, width):
            raise ParameterError(f"buffer '{name}': sizes differ, a is {_shape(one)}, b is {_shape(other)}")
    return _with_harmonics(pairs)


def errors(reference: Buffers, pairs: Pairs) -> dict[str, np.ndarray]:
    """{name: the reference's standard error (H, W, C)}, of the compared buffers for which the reference holds it."""
    known = _names(reference)
    parts = [*(name for name in pairs if name in known), *(name for name in _HARMONICS if "sh" in pairs)]
    found = {name: _array(reference, standard_error(name), "b") for name in parts if standard_error(name) in known}
    made = _with_harmonics({name: (values, values) for name, values in found.items()})
    return {name: values for name, (values, _) in made.items() if name in pairs}


def size_of(pairs: Pairs) -> tuple[int, int]:
    """(width, height)."""
    height, width = next(iter(pairs.values()))[0].shape[:2]
    return width, height


def label(one: Buffers, otherwise: str) -> str:
    """The name of the module that made it, if it is a frame."""
    return str(one.info.get("module", otherwise)) if isinstance(one, Frame) else otherwise


def regions(a: Buffers, b: Buffers, size: tuple[int, int], border_px: float | None) -> dict[str, np.ndarray]:
    """Masks (H, W) by name, each within `all`, the foreground; depth is the reference's. Raises `ParameterError`."""
    depths = [view_z for view_z in (_view_z(b, "b", size), _view_z(a, "a", size)) if view_z is not None]
    surface = _surface(depths, size)
    if border_px is not None and not border_px >= 0:
        raise ParameterError(f"border = {border_px!r} is not a number of pixels from 0 on")
    reach = _reach_px(a, b, depths, size) if border_px is None else border_px
    found = {"border": surface & border(size, reach)}
    if depths:
        found["silhouettes"] = surface & silhouettes(depths[0])
        found["thin"] = surface & thin_occluders(depths[0])
    interior = surface & ~np.any(list(found.values()), axis=0)
    return {"all": surface, **found, "interior": interior}


def _names(one: Buffers) -> list[str]:
    if isinstance(one, Frame):
        return one.buffers
    if isinstance(one, Mapping):
        return list(one)
    raise ParameterError(f"cannot compare a {type(one).__name__}: give a Frame, or a mapping of names to arrays")


def _chosen(a: Buffers, b: Buffers, wanted: Iterable[str] | str | None) -> list[str]:
    in_a, in_b = _names(a), _names(b)
    shared = [name for name in in_a if name in in_b]
    if not shared:
        raise ParameterError(f"no common buffer: a has {', '.join(in_a) or 'none'}; b has {', '.join(in_b) or 'none'}")
    if wanted is None:
        results = [name for name in shared if name not in (*SURFACES, "rays") and not name.endswith("standard_error")]
        if not results:
            raise ParameterError(f"no common result, only {', '.join(shared)}: name them in `buffers` to compare those")
        return sorted(results, key=lambda name: name != "visibility")
    chosen = [wanted] if isinstance(wanted, str) else list(wanted)
    if not chosen:
        raise ParameterError(f"buffers = [] is empty; both have {', '.join(shared)}")
    chosen = [part for name in chosen for part in (_HARMONICS if name == "sh" and "sh" not in shared else (name,))]
    for name in chosen:
        if name not in shared:
            missing = " and ".join(who for who, known in (("a", in_a), ("b", in_b)) if name not in known)
            raise ParameterError(f"no buffer '{name}' in {missing}{suggestion(name, shared)}")
    return chosen


def _array(one: Buffers, name: str, who: str) -> np.ndarray:
    """(H, W, C) float32; 8-bit values as shares of 255."""
    values = np.asarray(one[name])
    if values.ndim not in (2, 3) or not values.size or values.dtype.kind not in "fiub":
        raise ParameterError(
            f"buffer '{name}' of {who} has shape {values.shape}, type {values.dtype}: not numbers (H, W) or (H, W, C)"
        )
    scaled = values / np.float32(255) if values.dtype == np.uint8 else values.astype(np.float32)
    scaled = scaled[..., None] if values.ndim == 2 else scaled
    kind = kind_of(name)
    wanted = (1, 3) if kind.picture else (3,) if kind.error == "angle" else (scaled.shape[2],)
    if scaled.shape[2] == 4 and 3 in wanted:
        return scaled[..., :3]  # alpha, or a texture's padding
    if scaled.shape[2] not in wanted:
        raise ParameterError(
            f"buffer '{name}' of {who} has shape {values.shape}, not {' or '.join(map(str, wanted))} channels"
        )
    return scaled


def _shape(array: np.ndarray) -> str:
    height, width, channels = array.shape
    return f"{width}×{height} with {channels} channel{'s' if channels > 1 else ''}"


def _with_harmonics(pairs: Pairs) -> Pairs:
    """Pairs where sh0 .. sh3, if all four exist, are replaced by `sh`, the 16 coefficients, and by its bands."""
    parts = [pairs[name] for name in _HARMONICS if name in pairs]
    if len(parts) < len(_HARMONICS) or any(one.shape[2] != 4 for one, _ in parts):
        return pairs
    a, b = (np.concatenate([part[side] for part in parts], axis=2) for side in (0, 1))
    rest = {name: pair for name, pair in pairs.items() if name not in _HARMONICS}
    bands = {f"sh_band{band}": (a[..., band == _BAND_OF], b[..., band == _BAND_OF]) for band in range(4)}
    return {**rest, "sh": (a, b), **bands}


def _view_z(one: Buffers, who: str, size: tuple[int, int]) -> np.ndarray | None:
    if "viewZ" not in _names(one):
        return None
    view_z = _array(one, "viewZ", who)
    if view_z.shape != (*size[::-1], 1):
        raise ParameterError(f"viewZ of {who} is {_shape(view_z)}; its buffers are {size[0]}×{size[1]}")
    return view_z[..., 0]


def _surface(depths: list[np.ndarray], size: tuple[int, int]) -> np.ndarray:
    """(H, W) bool: the pixels where every depth is a surface's."""
    drawn = [np.isfinite(view_z) for view_z in depths] or [np.ones(size[::-1], bool)]
    mask = np.all(drawn, axis=0)
    if not mask.any():
        raise ParameterError(f"nothing to compare: all {size[0]}×{size[1]} pixels are background in viewZ")
    if differing := int((np.any(drawn, axis=0) & ~mask).sum()):
        notice(f"a and b do not show the same surfaces: {differing} pixels, background in one of them, are left out")
    return mask


def _reach_px(a: Buffers, b: Buffers, depths: list[np.ndarray], size: tuple[int, int]) -> np.ndarray | float:
    """The radius of the frames, in pixels at each pixel's distance (H, W); without a radius, one number of pixels."""
    for one in (a, b):
        if isinstance(one, Frame) and depths:
            radius, camera = one.info.get("parameters", {}).get("radius"), one.info.get("camera")
            if isinstance(radius, (int, float)) and camera:
                return projected_px(depths[0], radius, camera["fov"])
    return BORDER_SHARE * min(size)
