"""The interface of a filter: the passes that remove an estimate's noise, and the shader that brings it to full size."""

from collections.abc import Iterable, Mapping
from typing import ClassVar

from ..parameters import Choice
from ..passes import Pass

MOST_SOURCES = 4  # textures a pass: with those of the geometry, well below the 16 that a shader may read


class Filter(Choice):
    """A way to remove noise. A subclass states its parameters, and these facts:

    `name` (lower case); `passes`; `upsampling`, the shader that brings an estimate of a lower `scale` to full size;
    `at_full_size`, whether the passes run after the upsampling in place of before it; and `reach`. Each pass reads up
    to four buffers as `source0` to `source3` and writes `results` (lib/sources.glsl), and may read viewZ, viewNormal
    and albedo at its size. The upsampling shader reads besides smallViewZ and smallNormal. The filter's numbers are
    uniforms and constants of all of these shaders by themselves.
    """

    axis: ClassVar[str] = "filter"
    upsampling: ClassVar[str] = "pipeline/upsample.frag"
    at_full_size: ClassVar[bool] = False

    def reach(self) -> int | None:
        """How far the passes read, in pixels in x and in y, if each result is a mean of the values in that window.

        The mean of equal values is known, so that a software renderer may skip it. None: the results are no such means.
        """
        return None

    def passes(self, formats: Mapping[str, str]) -> list[Pass]:
        """The passes over up to four buffers, `formats` (name: format); each reads the results of the one before it."""
        return []

    def all_passes(self) -> list[Pass]:
        """Every pass, that of the upsampling too, over a single buffer."""
        one = {"visibility": "R16F"}
        return [*self.passes(one), over_sources("upsample", self.upsampling, one)]


def over_sources(name: str, shader: str, formats: Mapping[str, str], **constants: bool | int | float) -> Pass:
    """A pass that treats up to four buffers alike: it reads them as sources and writes each as a result."""
    writes = {f"results[{number}]": buffer for number, buffer in enumerate(formats)}
    counts = {"sources": len(formats), "single": [*formats.values()] in (["R8"], ["R16F"], ["R32F"])}
    return Pass(titled(name, formats), shader, formats, {**counts, **constants}, writes=writes)


def titled(what: str, names: Iterable[str]) -> str:
    """The name in timings: 'filter visibility', 'filter occlusion0 to occlusion3'."""
    first, *others = names
    return f"{what} {first}" + (f" to {others[-1]}" if others else "")
