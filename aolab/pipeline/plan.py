"""The plan of a module's frames: its steps, and its values as shaders read them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from ..gl.bindings import Bindings, joined
from ..gl.source import Declared
from ..modules import Module
from ..modules.buffers import REFLECTIVE
from ..modules.estimate import Estimate, passes_of
from ..modules.filters import Filter
from ..modules.measures import Measure
from ..modules.occluders.base import OccluderKind
from ..modules.passes import TERMS, Pass
from ..modules.question import Question
from ..modules.virtual_lights import VirtualLights
from .doubts import is_own
from .reflective import PACKED


@dataclass(frozen=True)
class Asked:
    """All that the passes of a module and its occluder kind read: the `buffers` that they sample, whether some of these
    belong to `reflective` shadow maps, and whether a pass includes "occluders.glsl".
    """

    buffers: frozenset[str]
    occluders: bool
    reflective: bool


@dataclass(frozen=True, eq=False)
class Plan:
    """All that stays the same in the frames of a `module`, which is resolved for its scene.

    Each part is computed at its first use, and kept with the plan. `declared` returns the names in a shader's text.
    """

    module: Module
    declared: Callable[..., Declared]
    _samples: dict[int, Bindings] = field(default_factory=dict, repr=False)

    @cached_property
    def estimate(self) -> Estimate:
        """The module's estimate."""
        return self.module.estimate()

    @cached_property
    def lighting(self) -> Sequence[Pass | Estimate]:
        """The steps that light the surfaces."""
        return self.module.lighting()

    @cached_property
    def bounce(self) -> Estimate | None:
        """The estimate over lit surfaces, if there is one."""
        return self.module.bounce()

    @cached_property
    def filter(self) -> Filter:
        """The filter that the module has chosen."""
        chosen = self.module.chosen("filter")
        assert isinstance(chosen, Filter)
        return chosen

    @cached_property
    def occluders(self) -> OccluderKind:
        """The occluder kind that the module has chosen."""
        chosen = self.module.chosen("occluders")
        assert isinstance(chosen, OccluderKind)
        return chosen

    @cached_property
    def values(self) -> dict[str, Any]:
        """The module's parameters by name."""
        return self.module.values()

    @cached_property
    def question(self) -> Question:
        """The quantity that the module approximates."""
        return self.module.question()

    @cached_property
    def is_own(self) -> bool:
        """Whether the module, its shader, or one of its choices is the user's."""
        choices = (self.module.chosen(axis) for axis in self.module.choices)
        return is_own(self.module) or not all(type(one).__module__.startswith("aolab.") for one in choices)

    @cached_property
    def parameters(self) -> Bindings:
        """The module's numbers, as uniforms and as constants, its vectors, and all that its measure gives."""
        numbers, owner = self.module.numbers(), f"the parameters of {self.module.label()}"
        words = {name: value for name, value in self.values.items() if isinstance(value, str)}
        own = Bindings(owner, uniforms={**numbers, **self.module.vectors()}, constants=numbers, words=words)
        if "measure" not in self.module.choices:
            return own
        measure = self.module.chosen("measure")
        assert isinstance(measure, Measure)
        both = joined([own, measure.bindings()], owner)
        return Bindings(owner, both.textures, both.uniforms, both.constants, both.includes, both.words)

    def samples(self, seed: int) -> Bindings:
        """The sample set of one seed; the last one is kept."""
        if seed not in self._samples:
            self._samples.clear()
            self._samples[seed] = Bindings("the samples", uniforms=self.module.samples(seed))
        return self._samples[seed]

    @cached_property
    def passes(self) -> list[Pass]:
        """Every pass of the estimate, the lighting and the bounce, and of their filters."""
        steps = [self.estimate, *self.lighting, *filter(None, [self.bounce])]
        return passes_of(steps) + [
            of for step in steps if isinstance(step, Estimate) for of in (step.filter or self.filter).all_passes()
        ]

    @cached_property
    def asked(self) -> Asked:
        """All that the passes, and the occluder kind, read."""
        asks_for_occluders = any("occluders.glsl" in read.includes for read in map(self._read, self.passes))
        lights = [step.samples for step in self.lighting if isinstance(step, VirtualLights)]
        names = self.sampled(self.passes).union(*lights)
        return Asked(names, asks_for_occluders, bool(names & {*REFLECTIVE, PACKED}))

    @cached_property
    def sampled_unlit(self) -> frozenset[str]:
        """The buffers that the passes sample, but for the terms of the lighting."""
        return self.sampled(step for step in self.passes if step.shader not in TERMS.values())

    def sampled(self, passes: Iterable[Pass]) -> frozenset[str]:
        """The buffers that these passes sample, those of the occluder kind included."""
        names: set[str] = set()
        for step in passes:
            read = self._read(step)
            samplers = set(read.samplers)
            if "occluders.glsl" in read.includes:
                texts = self.occluders.bindings().includes.values()
                samplers.update(*(self.declared(text).samplers for text in texts))
            names |= {step.reads.get(name, name) for name in samplers}
        return frozenset(names)

    def _read(self, step: Pass) -> Declared:
        """The names in the text of a pass's shader."""
        return self.declared(step.shader, step.includes)
