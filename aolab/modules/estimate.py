"""Estimates: passes over sample sets whose outputs are averaged, filtered and brought to full size."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from .filters import Filter
from .passes import Pass


@dataclass(frozen=True)
class Estimate:
    """`passes` run once for each sample set, at the module's scale; they fill the noisy `outputs` (name: format).

    The outputs are averaged over the sample sets, filtered, and brought to full size. `once` are passes before the
    others, at full size, that no sample set changes: voxels, or a light's G-buffer. `filter` replaces the module's own
    choice, and `scale` the module's scale. Of several outputs whose passes state their `background`, `decides` names an
    output that has its background's value only where all of them have theirs.
    """

    passes: Sequence[Pass]
    outputs: Mapping[str, str]
    once: Sequence[Pass] = ()
    filter: Filter | None = None
    scale: float | None = None
    decides: str = ""


def passes_of(steps: Iterable[Pass | Estimate]) -> list[Pass]:
    """Every pass of the steps, in order."""
    found: list[Pass] = []
    for step in steps:
        found += [*step.once, *step.passes] if isinstance(step, Estimate) else [step]
    return found
