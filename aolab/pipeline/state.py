"""The state of a frame: the context of its passes, and the surfaces that are kept to light it again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ..gl.bindings import Bindings
from ..modules import Module
from ..modules.occluders.base import Occluders
from ..scene.scene import Scene
from ..scene.view import View
from .pass_runner import Buffers, PassRunner, Where
from .plan import Plan
from .rasterizer import Rasterizer
from .surfaces import as_bindings, shrink


@dataclass(frozen=True, eq=False)
class FrameContext:
    """The context of all passes of one frame: the means to draw, the module's plan, and the camera's view.

    The sample sets of `seeds` are averaged over.
    """

    rasterizer: Rasterizer
    plan: Plan
    view: View
    seeds: range

    @property
    def runner(self) -> PassRunner:
        return self.rasterizer.runner

    @property
    def scene(self) -> Scene:
        return self.rasterizer.scene

    @property
    def last(self) -> Bindings:
        """The last frame's buffers and view."""
        return self.rasterizer.last

    @property
    def module(self) -> Module:
        """The module, resolved."""
        return self.plan.module

    @property
    def parameters(self) -> Bindings:
        """The module's values."""
        return self.plan.parameters

    def samples(self, seed: int) -> Bindings:
        """The sample set of one seed."""
        return self.plan.samples(seed)


@dataclass(frozen=True, eq=False)
class SurfaceState:
    """The surfaces and the estimate of a frame. They do not depend on light, so that the frame can be lit again.

    `large` are the surfaces at full size, `small` those at the module's scale, with `small_view`. `estimate` holds the
    module's outputs unless the module is `lit`. `where` are the pixels with surfaces, at full size.
    """

    frame: FrameContext
    large: Buffers
    small: Buffers
    small_view: View
    occluders: Occluders
    estimate: Buffers
    where: Where

    @property
    def small_where(self) -> Where | None:
        """The pixels with surfaces at the size of `small`; None where they are not known."""
        return self.where if self.small is self.large else None

    @property
    def known(self) -> Sequence[Bindings]:
        """The buffers at full size, for passes over the whole picture."""
        return as_bindings(self.large), Bindings("the estimate", self.estimate)

    def at_scale(self, scale: float | None) -> "SurfaceState":
        """The same, with small surfaces of another scale; None is the module's own."""
        if scale is None or scale == self.frame.module.scale:
            return self
        small_view = self.frame.view.scaled(scale) if scale < 1 else self.frame.view
        small = shrink(self.frame.runner, self.large, self.frame.view, small_view) if scale < 1 else self.large
        return replace(self, small=small, small_view=small_view)

    def under(self, rasterizer: Rasterizer) -> "SurfaceState":
        """The same, with other means to draw: those of a new frame."""
        return replace(self, frame=replace(self.frame, rasterizer=rasterizer))
