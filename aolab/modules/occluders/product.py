"""Two kinds of occluders together: their visibilities are multiplied."""

from typing import Any

from ...gl.bindings import Bindings, joined
from ...scene.view import View
from .base import Drawing, OccluderKind, Occluders, Textures

_FUNCTIONS = ("Occluder", "isBlocked", "occluderNormal", "occluderRadiance")


class Product(OccluderKind):
    """A point is blocked if the kind `first` or the kind `second` blocks it: `Product(first=Depth(), second=Mine())`.

    So the visibility of a direction is the product of the two kinds' visibilities. Where both block, the occluder is
    the first kind's. The two kinds must give different names to their textures and values.
    """

    name = "product"

    first: OccluderKind
    second: OccluderKind

    def values(self) -> dict[str, Any]:
        """{name: value}: the names of the two kinds, and their parameters."""
        return {"first": self.first.name, "second": self.second.name, **self.first.values(), **self.second.values()}

    def draw(self, drawing: Drawing, view: View, surfaces: Textures, sends: bool) -> Occluders:
        drawn = [kind.draw(drawing, view, surfaces, sends) for kind in (self.first, self.second)]
        return Occluders(self._both([one.bindings for one in drawn]), [*drawn[0].hidden, *drawn[1].hidden])

    def bindings(self, textures: Any = None, uniforms: Any = None) -> Bindings:
        return self._both([self.first.bindings(), self.second.bindings()])

    def _both(self, bindings: list[Bindings]) -> Bindings:
        """The bindings of both kinds; each kind's shader has an include of its own."""
        alone = [Bindings(one.owner, one.textures, one.uniforms, one.constants) for one in bindings]
        both = joined(alone, self.label())
        includes = {
            "occluders.glsl": self.glsl(),
            "occluders_first.glsl": self.first.glsl(),
            "occluders_second.glsl": self.second.glsl(),
        }
        return Bindings(self.label(), both.textures, both.uniforms, both.constants, includes)

    def glsl(self) -> str:
        return "\n".join(
            [_renamed("first"), _renamed("second"), '#include "occluders/product.glsl"', ""],
        )


def _renamed(which: str) -> str:
    """The include of one kind, with its struct and functions under names of their own: firstIsBlocked, ..."""
    names = {name: which + name[0].upper() + name[1:] for name in _FUNCTIONS}
    before = [f"#define {name} {renamed}" for name, renamed in names.items()]
    after = [f"#undef {name}" for name in names]
    return "\n".join([*before, f'#include "occluders_{which}.glsl"', *after])
