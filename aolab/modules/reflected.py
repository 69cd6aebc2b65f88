"""Bounces that the lighting gathers: the last step, the reflection, and the light that they do not send."""

from collections.abc import Sequence

from ..errors import notice
from ..scene.scene import Scene
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


def note_emission(module: str, reflected: str, scene: Scene) -> None:
    """A `Notice` in a scene with emission, of which the module's bounce sends nothing, but what is `reflected`."""
    if scene.emits:
        text = f"{module}: its bounce reflects {reflected}; the emission of surfaces lights no others"
        notice(text)
