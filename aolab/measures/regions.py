"""Regions of the image where screen-space methods lack knowledge: the border, silhouettes, thin occluders.

All depth tests use nearness, 1 / distance: it is linear over the image of a plane, and 0 in the background. The
functions import scipy.ndimage, since that takes 0.3 s.
"""

import numpy as np

# The share of the distance by which depth jumps at a gap. Twice as much finds 4 to 33 % fewer silhouettes on the six
# scenes at 320×180; with 0.02, `thin` holds 8 % of `colonnade`, mostly the relief of its columns, instead of 0.4 %.
GAP = 0.05
SILHOUETTE_PX = 2  # half the width of a 4×4 filter
THIN_PX = 8  # at 640×360 the width of a railing, a leaf or a chair's leg in a room
BORDER_SHARE = 1 / 20  # of the shorter side, where no radius is known


def nearness(view_z: np.ndarray) -> np.ndarray:
    """(H, W) float64: 1 / distance along the view axis, 0 in the background (viewZ = -inf)."""
    return np.where(np.isfinite(view_z), -1 / np.asarray(view_z, np.float64), 0)


def border(size: tuple[int, int], reach: np.ndarray | float) -> np.ndarray:
    """(H, W) bool: pixels whose centre is less than `reach` pixels, (H, W) or a number, from the image's edge."""
    width, height = size
    x, y = np.arange(width) + 0.5, np.arange(height)[:, None] + 0.5
    return np.minimum(np.minimum(x, width - x), np.minimum(y, height - y)) < reach


def projected_px(view_z: np.ndarray, radius: float, fov: float) -> np.ndarray:
    """(H, W): `radius` (scene units) in pixels at each pixel's distance; `fov` is vertical, in degrees."""
    return radius * nearness(view_z) * view_z.shape[0] / (2 * np.tan(np.radians(fov) / 2))


def silhouettes(view_z: np.ndarray, width: int = SILHOUETTE_PX) -> np.ndarray:
    """(H, W) bool: pixels within `width` of a depth gap, on both of its sides.

    Two neighbours have a gap between them if each misses the plane that continues the other's side, by more than `GAP`
    of the distance. So a floor at a grazing angle has no gaps, and a crease has none.
    """
    from scipy.ndimage import binary_dilation

    near = nearness(view_z)
    beside = _beside_gap(near) | _beside_gap(near.T).T
    return binary_dilation(beside, np.ones((3, 3)), iterations=width - 1) if width > 1 else beside


def _beside_gap(near: np.ndarray) -> np.ndarray:
    """Pixels next to a gap between neighbours in a row."""
    left, right = near[:, :-1], near[:, 1:]
    beyond = np.pad(near, ((0, 0), (1, 1)), constant_values=np.nan)  # outside of the image nothing is predicted
    from_left = np.abs(right - (2 * left - beyond[:, :-3]))
    from_right = np.abs(left - (2 * right - beyond[:, 3:]))
    off = np.fmin(from_left, from_right)
    off = np.where(np.isnan(off), np.abs(right - left), off)
    gap = off > GAP * np.maximum(left, right)
    return np.pad(gap, ((0, 0), (0, 1))) | np.pad(gap, ((0, 0), (1, 0)))


def thin_occluders(view_z: np.ndarray, width: int = THIN_PX) -> np.ndarray:
    """(H, W) bool: surfaces narrower than `width` pixels before a surface farther by `GAP`, and pixels close to them.

    A grey-value opening of nearness with a disc of that diameter removes them (Serra's white top-hat). Pieces shorter
    than `width` are corners of wider things, and do not count. All pixels within `width` of a thin surface belong to
    the region, since a wrong guess at its thickness shows there.
    """
    from scipy.ndimage import binary_dilation, find_objects, grey_opening, label

    near = nearness(view_z)
    steps = np.arange(width) - (width - 1) / 2
    disc = steps**2 + steps[:, None] ** 2 <= (width / 2) ** 2
    # continued by its slope beyond the image's edge, a plane has no ridge there
    opened = grey_opening(np.pad(near, width, mode="reflect", reflect_type="odd"), footprint=disc)
    pieces = np.zeros(near.shape, np.int32)
    label(near - opened[width:-width, width:-width] > GAP * near, np.ones((3, 3)), pieces)
    long = [max(side.stop - side.start for side in box) >= width for box in find_objects(pieces)]
    thin = np.array([False, *long])[pieces]
    return binary_dilation(thin, np.ones((3, 3)), iterations=width) & np.isfinite(view_z)
