"""The last step of bounces that the lighting gathers: the reflection, dimmed by the module's visibility."""

from collections.abc import Sequence

from .buffers import LIT
from .estimate import Estimate
from .passes import Pass


def bounce_of(irradiance: str, before: Sequence[Pass | Estimate], *, shaded: bool) -> Pass:
    """The pass that reflects the buffer `irradiance`, and adds the `indirect` light of the lighting steps `before`.

    If `shaded`, the visibility of the module dims the reflected light.
    """
    adds = any("indirect" in step.outputs for step in before)
    constants = {"adds": adds, "dimmed": shaded}
    reads = {"irradiance": irradiance, "other": "indirect" if adds else irradiance}
    return Pass("indirect", "shaded_bounce.frag", {"indirect": LIT["indirect"].format}, constants, reads)
