"""`aolab.microscope`: every sample of one pixel."""

from dataclasses import dataclass

import numpy as np
from PIL import Image

from ...errors import ParameterError
from ...modules import MODULES
from ...pictures.html import png
from ...pipeline.frame import Frame, check_frame
from ...pipeline.state import SurfaceState
from ..reading import inside
from .inputs import inputs
from .receiver import texel_of
from .sampled import Sampled
from .twins import Taking, taking


@dataclass(frozen=True, eq=False)
class Microscope:
    """The samples of one pixel (column, row). A notebook shows `picture()`; `str` gives a line for each sample.

    `passes`: the passes that took samples, in the order of the frame: the estimate, and that of a bounce.
    """

    frame: Frame
    pixel: tuple[int, int]
    passes: tuple[Sampled, ...]

    @property
    def difference(self) -> float:
        """The largest difference between a replayed and a rendered value, relative to values above 1."""
        return max(one.difference for one in self.passes)

    def __str__(self) -> str:
        return "\n".join([f"pixel {self.pixel} of {self.frame.info['module']}", *map(str, self.passes)])

    def __repr__(self) -> str:
        return f"<Microscope of pixel {self.pixel}: {', '.join(f'{one.name} {one.summary}' for one in self.passes)}>"

    def picture(self) -> Image.Image:
        """The samples over the image, and in three dimensions. Blue: open; orange: blocked; black: the blockers."""
        from .picture import draw

        return draw(self.frame, self.pixel, self.passes)

    def _repr_png_(self) -> bytes:
        return png(self.picture())


def microscope(frame: Frame, pixel: tuple[int, int]) -> Microscope:
    """Every sample that a frame's module took for `pixel` (column, row), counted from the top left.

    The samples are computed again in NumPy from the textures that the shader read: directions, points or lights,
    whether and by which mesh each is blocked, and the contribution of each to the value. `Microscope.difference`
    compares the replayed values with the shader's. Works for all modules that take samples, with any occluders, and for
    your own modules that derive from `aolab.modules.marched.Marched` and write `visibility`.
    Raises `ParameterError` for another module, a frame that no lab rendered, and a pixel outside or in the background.
    """
    check_frame(frame, "microscope")
    column, row = inside(pixel, frame.size, "microscope")
    state = frame.kept
    if not isinstance(state, SurfaceState):
        raise ParameterError(
            f"microscope: this frame, of {frame.info.get('module')}, was not rendered by a lab; there are no samples"
        )
    if not frame.mask[row, column]:
        raise ParameterError(
            f"microscope: pixel ({column}, {row}) is in the background; frame.mask is True at surfaces"
        )
    passes = taking(state.frame.module)
    if not passes:
        covered = ", ".join(name for name, module in MODULES.items() if taking(module()))
        raise ParameterError(
            f"microscope: the module {frame.info.get('module')} takes no samples that can be computed again; modules "
            f"that do: {covered}, and your own that derive from aolab.modules.marched.Marched"
        )
    found = tuple(filter(None, (_sampled(frame, (column, row), one) for one in passes)))
    if not found:
        raise ParameterError(
            f"microscope: pixel ({column}, {row}) is in the background at the lower resolution of the estimate, "
            "{}x{}".format(*state.small_view.size)
        )
    return Microscope(frame, (column, row), found)


def _sampled(frame: Frame, pixel: tuple[int, int], taken: Taking) -> Sampled | None:
    """The samples of one pass at a pixel; None if it took none there."""
    step, twin = taken.step, taken.twin
    names = {name: f"{name}_raw" if taken.estimate else name for name in (taken.estimate or step).outputs}
    raw = {name: frame.channels(found) for name, found in names.items() if found in frame.buffers}
    seen = inputs(frame, step, taken.estimate, taken.bounces)
    column, row = texel = texel_of(pixel, frame.size, seen.size)
    if seen["viewZ"][row, column] == -np.inf:
        return None
    sets = tuple(filter(None, (twin(seen, texel, seed) for seed in seen.seeds)))
    if not sets:
        return None
    values = {name: np.mean([one.values[name] for one in sets], axis=0) for name in sets[0].values}
    rendered = {
        name: np.atleast_1d(raw[name][row, column])[: len(value)].astype(np.float64) for name, value in values.items()
    }
    return Sampled(frame, step.name, texel, sets, values, rendered)
