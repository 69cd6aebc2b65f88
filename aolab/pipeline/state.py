"""The state of a frame: the context of its passes, and the surfaces that are kept to light it again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ..gl.bindings import Bindings, joined
from ..modules import Module
from ..modules.filters import Filter
from ..modules.measures import Measure
from ..modules.occluders.base import OccluderKind, Occluders
from ..scene.scene import Scene
from ..scene.view import View
from .pass_runner import Buffers, PassRunner, Where
from .rasterizer import Rasterizer
from .surfaces import as_bindings, shrink


@dataclass(frozen=True, eq=False)
class FrameContext:
    """The context of all passes of one frame: the means to draw, the module, the camera's view and the sample sets.

    `seeds` are averaged over.
    """

    rasterizer: Rasterizer
    module: Module
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
    def filter(self) -> Filter:
        """The filter that the module has chosen."""
        chosen = self.module.chosen("filter")
        assert isinstance(chosen, Filter)
        return chosen

    @property
    def occluders(self) -> OccluderKind:
        """The occluder kind that the module has chosen."""
        chosen = self.module.chosen("occluders")
        assert isinstance(chosen, OccluderKind)
        return chosen

    @property
    def parameters(self) -> Bindings:
        """The module's numbers, as uniforms and as constants, its vectors, and all that its measure gives."""
        numbers, owner = self.module.numbers(), f"the parameters of {self.module.label()}"
        words = {name: value for name, value in self.module.values().items() if isinstance(value, str)}
        own = Bindings(owner, uniforms={**numbers, **self.module.vectors()}, constants=numbers, words=words)
        if "measure" not in self.module.choices:
            return own
        measure = self.module.chosen("measure")
        assert isinstance(measure, Measure)
        both = joined([own, measure.bindings()], owner)
        return Bindings(owner, both.textures, both.uniforms, both.constants, both.includes, both.words)

    def samples(self, seed: int) -> Bindings:
        """The sample set of one seed."""
        return Bindings("the samples", uniforms=self.module.samples(seed))


@dataclass(frozen=True)
class Asked:
    """All that the passes of a module and its occluder kind read: the `buffers` that they sample, whether some of these
    belong to `reflective` shadow maps, and whether a pass includes "occluders.glsl".
    """

    buffers: frozenset[str]
    occluders: bool
    reflective: bool


@dataclass(frozen=True, eq=False)
class SurfaceState:
    """The surfaces and the estimate of a frame. They do not depend on light, so that the frame can be lit again.

    `large` are the surfaces at full size, `small` those at the module's scale, with `small_view`. `estimate` holds the
    module's outputs unless the module is `lit`. `where` are the pixels with surfaces, at full size.
    """

    frame: FrameContext
    asked: Asked
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
